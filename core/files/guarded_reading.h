// SPDX-License-Identifier: BSD-3-Clause
// Reading by libraries that a damaged file can kill: a child process reads first, and where it does not live
// to the end, the file is refused. HDF5 1.10 follows addresses that a file states (a group's heap of names,
// say), and stands below netCDF and GDAL too.
//
// The child is a fork: it reads as the caller would, from the same state, and leaves nothing behind. It may
// use the memory that is available and some processor time (seconds, more for large files), prints nothing
// and leaves no core. The cost is that of reading twice, and of a fork: 1 ms, and 0.15 ms for each megabyte
// that the process has by then.
//
// Files are read while a configuration is loaded, mostly before there are threads; where a thread loads one
// (the monitor's, of a log), the child has that thread alone, and glibc keeps its memory and loader usable.
// No lock that the reading takes may be held by another thread: readers say whether calls may overlap.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace halocline {

// Throws InvalidArgument where a child that calls `reading` is ended by a signal or runs out of processor
// time ("<paths> is damaged: ...") or of memory. What `reading` throws is no damage: the caller meets it
// again.
void require_survivable(const std::vector<std::string>& paths, const std::function<void()>& reading);

// What `reading` returns; a child calls it first.
template <class Reading>
auto guarded_reading(const std::vector<std::string>& paths, const Reading& reading) {
  require_survivable(paths, [&] { reading(); });
  return reading();
}

// Whether HDF5 would take the file for one of its own: its signature stands at 0, 512, 1024, 2048 ... bytes
// (HDF5 File Format Specification 3.0, section II.A). No file: false.
bool is_hdf5(const std::string& path);

}  // namespace halocline

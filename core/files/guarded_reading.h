// SPDX-License-Identifier: BSD-3-Clause
// Guarded reading with libraries that a damaged file can crash: a child process reads first, and if it does
// not finish, the file is refused. HDF5 1.10, on which netCDF and GDAL are based too, follows addresses that
// a file states (that of a group's heap of names, for instance).
//
// The child is a fork: it reads from the same state as the caller would, and leaves nothing behind. It may
// use the available memory and some processor time (seconds, more for large files), prints nothing and leaves
// no core. The cost is that of reading twice plus that of a fork: 1 ms, and 0.15 ms for each megabyte of the
// process.
//
// Files are read while a configuration is loaded, mostly before there are threads. If a thread loads one (the
// monitor, from a log), the child has only that thread, and glibc keeps its memory and loader usable. No
// other thread may hold a lock that the reading takes: readers state whether calls may overlap.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace halocline {

// Throws InvalidArgument if a child that calls `reading` is ended by a signal or runs out of processor time
// ("<paths> is damaged: ...") or of memory. An exception that `reading` throws is not a sign of damage: it is
// thrown again when the caller itself reads.
void require_survivable(const std::vector<std::string>& paths, const std::function<void()>& reading);

// Returns the result of `reading`, which a child has called first.
template <class Reading>
auto guarded_reading(const std::vector<std::string>& paths, const Reading& reading) {
  require_survivable(paths, [&] { reading(); });
  return reading();
}

// True if HDF5 would accept the file as its own: the signature is at 0, 512, 1024, 2048 ... bytes (HDF5 File
// Format Specification 3.0, section II.A). False if there is no such file.
bool is_hdf5(const std::string& path);

}  // namespace halocline

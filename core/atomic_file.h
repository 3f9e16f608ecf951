// SPDX-License-Identifier: BSD-3-Clause
// File that is replaced as a whole: written next to its final name, forced to disk, then renamed.
//
// A reader finds the old or the new content, never a part of one, even after a crash of the program or the
// machine. The file is forced to disk (fsync) before the rename and its folder after it; a POSIX rename
// replaces the file in one step. One writer at a time: two writers of one path share the name of the
// temporary file.
//
// An existing path that is not a regular file, such as a device or a pipe, is written to directly and stays
// what it is. A symbolic link is kept: the file to which it points is replaced.
//
//   replace_file("result.json", text);
//
//   AtomicFile file("sweep.nc");
//   write_netcdf(results, file.temporary_path());
//   file.commit();
#pragma once

#include <string>
#include <string_view>

namespace halocline {

class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  // Removes the temporary file, unless it was committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Path for writing the new content: in the same folder as the file.
  const std::string& temporary_path() const { return temporary_path_; }
  // Moves the temporary file into place. Descriptors open on it stay valid. Throws std::runtime_error.
  void commit();

 private:
  bool is_direct() const { return temporary_path_ == path_; }

  std::string path_, temporary_path_;
  bool committed_ = false;
};

// Replaces the file at `path` by `content`. Throws std::runtime_error.
void replace_file(const std::string& path, std::string_view content);

}  // namespace halocline

// SPDX-License-Identifier: BSD-3-Clause
// A file that is replaced as a whole: written beside its final name, forced to disk, then renamed.
//
// A reader finds the old content or the new one, never a part, also after a crash of the program or the machine
// (fsync of the file before the rename and of its folder after it; POSIX rename replaces in one step). One writer at a
// time: two writers of one path share the name of the temporary file.
//
//   replace_file("result.json", text);
//
//   AtomicFile file("sweep.nc");
//   write_netcdf(results, file.temporary_path());
//   file.commit();
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace halocline {

class AtomicFile {
 public:
  explicit AtomicFile(std::string path) : path_(std::move(path)) {}
  // Removes the temporary file, unless it was committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Where the new content is to be written: in the same folder as the file.
  std::string temporary_path() const { return path_ + ".unfinished"; }
  // Moves the temporary file into place. Descriptors open on it stay valid. Throws std::runtime_error.
  void commit();

 private:
  std::string path_;
  bool committed_ = false;
};

// Replaces the file at `path` by `content`. Throws std::runtime_error.
void replace_file(const std::string& path, std::string_view content);

}  // namespace halocline

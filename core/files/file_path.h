// SPDX-License-Identifier: BSD-3-Clause
// File that a configuration names. It is a separate type, so that visitors of a configuration recognise keys
// that name files. Its place is determined once, when the key is read (bus/config/config.h).
//
//   FilePath cast("casts/may.csv");  // a path given in code is used unchanged
//   std::ifstream in(cast.place());
#pragma once

#include <memory>
#include <string>
#include <utility>

namespace halocline {

class FilePath {
 public:
  FilePath() = default;
  // Makes the path of a file at `place`. Implicit, because a place represents its file.
  // NOLINTBEGIN(google-explicit-constructor)
  FilePath(std::string place) : given_(std::move(place)), place_(given_) {}
  FilePath(const char* place) : FilePath(std::string(place)) {}
  // NOLINTEND(google-explicit-constructor)

  // `given` is the text in the configuration; `origin` belongs to the reader and lives as long as the path.
  FilePath(std::string given, std::string place, std::shared_ptr<void> origin)
      : given_(std::move(given)), place_(std::move(place)), origin_(std::move(origin)) {}

  // Text in the configuration; empty for no file.
  [[nodiscard]] const std::string& given() const { return given_; }
  // Path for opening the file: absolute, or relative to the working directory.
  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] const std::shared_ptr<void>& origin() const { return origin_; }
  [[nodiscard]] bool empty() const { return place_.empty(); }

  bool operator==(const FilePath& other) const { return place_ == other.place_; }

 private:
  std::string given_, place_;
  std::shared_ptr<void> origin_;
};

}  // namespace halocline

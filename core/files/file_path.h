// SPDX-License-Identifier: BSD-3-Clause
// A file that a configuration names: a type of its own, so that whoever visits a configuration knows which
// keys name files. Where the file lies is settled once, where the key is read (bus/config/config.h).
//
//   FilePath cast("casts/may.csv");  // of code: as it is
//   std::ifstream in(cast.place());
#pragma once

#include <concepts>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace halocline {

class FilePath {
 public:
  FilePath() = default;
  // A file by its place.
  template <class Text>
  requires std::convertible_to<Text, std::string> FilePath(Text&& place)
      : given_(std::forward<Text>(place)), place_(given_) {}
  // `given` is the text of the configuration; `origin` belongs to the reader and is kept as long as the path
  // is.
  FilePath(std::string given, std::string place, std::shared_ptr<void> origin)
      : given_(std::move(given)), place_(std::move(place)), origin_(std::move(origin)) {}

  // As the configuration has it; empty for no file.
  [[nodiscard]] const std::string& given() const { return given_; }
  // To open it: absolute, or relative to the working directory.
  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] const std::shared_ptr<void>& origin() const { return origin_; }
  [[nodiscard]] bool empty() const { return place_.empty(); }

  bool operator==(const FilePath& other) const { return place_ == other.place_; }
  template <class Text>
  requires std::convertible_to<const Text&, std::string_view>
  bool operator==(const Text& text) const { return place_ == std::string_view(text); }

 private:
  std::string given_, place_;
  std::shared_ptr<void> origin_;
};

}  // namespace halocline

// SPDX-License-Identifier: BSD-3-Clause
// Lines out of bytes that come in any pieces: a line ends at a carriage return, a line feed, or both.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace halocline::modem_gateway {

class LineReader {
 public:
  // A longer line is none: it is discarded up to its end.
  static constexpr std::size_t kMaxLine = 8192;
  // The same of lines of JSON, which hold data.
  static constexpr std::size_t kMaxJson = 1024 * 1024;
  // Bytes that are kept of the end of a line that is too long.
  static constexpr std::size_t kEndBytes = 4096;

  using OnLine = std::function<void(std::string_view line)>;
  // `beginning`: as much as the longest line has; `end`: its last bytes, which may belong to the beginning.
  using OnLongLine = std::function<void(std::string_view beginning, std::string_view end)>;

  explicit LineReader(std::size_t max_line = kMaxLine) : max_line_(max_line) {}

  // Calls `on_line` for each complete line that is not empty, without its end. Of a line that is too long
  // calls `on_too_long` once it is, and `on_long_line` at its end.
  void take(
      std::string_view bytes, const OnLine& on_line, const std::function<void()>& on_too_long,
      const OnLongLine& on_long_line = [](std::string_view, std::string_view) {});

 private:
  void append(std::string_view bytes, const std::function<void()>& on_too_long);

  std::size_t max_line_;
  std::string line_, end_;  // the latter of a line that is too long
  bool is_too_long_ = false;
};

}  // namespace halocline::modem_gateway

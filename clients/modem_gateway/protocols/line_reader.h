// SPDX-License-Identifier: BSD-3-Clause
// Reader of lines from a byte stream in arbitrary pieces; a line ends at a carriage return, a line feed, or
// both.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace halocline::modem_gateway {

class LineReader {
 public:
  // Longest line, bytes; a longer one is discarded up to its end.
  static constexpr std::size_t kMaxLine = 8192;
  // Longest line of protocols in JSON, whose lines carry data.
  static constexpr std::size_t kMaxJson = 1024 * 1024;
  // Number of bytes that are kept from the end of a line that is too long.
  static constexpr std::size_t kEndBytes = 4096;

  using OnLine = std::function<void(std::string_view line)>;
  // Receives a line that is too long: its first max_line bytes (`beginning`) and, of the bytes after them, at
  // least the last kEndBytes or all (`end`).
  using OnLongLine = std::function<void(std::string_view beginning, std::string_view end)>;

  explicit LineReader(std::size_t max_line = kMaxLine) : max_line_(max_line) {}

  // Calls `on_line` for each complete line that is not empty, without its line end. For a line that is too
  // long it calls `on_too_long` as soon as the limit is exceeded, and `on_long_line` when the line ends.
  void take(
      std::string_view bytes, const OnLine& on_line, const std::function<void()>& on_too_long,
      const OnLongLine& on_long_line = [](std::string_view, std::string_view) {});

 private:
  void append(std::string_view bytes, const std::function<void()>& on_too_long);

  std::size_t max_line_;
  std::string line_, end_;  // end_: last bytes of a line that is too long
  bool is_too_long_ = false;
};

}  // namespace halocline::modem_gateway

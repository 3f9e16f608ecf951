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

  explicit LineReader(std::size_t max_line = kMaxLine) : max_line_(max_line) {}

  // Calls `on_line` for each complete line that is not empty, without its end, and `on_too_long` once for one that is too long.
  void take(std::string_view bytes, const std::function<void(std::string_view line)>& on_line,
            const std::function<void()>& on_too_long);

 private:
  std::size_t max_line_;
  std::string line_;
  bool is_too_long_ = false;
};

}  // namespace halocline::modem_gateway

// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/line_reader.h"

#include <algorithm>
#include <utility>

namespace halocline::modem_gateway {

void LineReader::append(std::string_view bytes, const std::function<void()>& on_too_long) {
  const std::size_t fits = std::min(bytes.size(), max_line_ - line_.size());
  line_.append(bytes.substr(0, fits));
  if (fits < bytes.size() && !std::exchange(is_too_long_, true)) on_too_long();
  if (!is_too_long_) return;
  end_.append(bytes.substr(fits));
  if (end_.size() > 2 * kEndBytes) end_.erase(0, end_.size() - kEndBytes);
}

void LineReader::take(std::string_view bytes, const OnLine& on_line, const std::function<void()>& on_too_long,
                      const OnLongLine& on_long_line) {
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find_first_of("\r\n"), bytes.size());
    const bool ends = end < bytes.size();
    append(bytes.substr(0, end), on_too_long);
    bytes.remove_prefix(ends ? end + 1 : end);
    if (!ends) return;
    const std::string line = std::exchange(line_, ""), last = std::exchange(end_, "");
    if (std::exchange(is_too_long_, false))
      on_long_line(line, last);
    else if (!line.empty())
      on_line(line);
  }
}

}  // namespace halocline::modem_gateway

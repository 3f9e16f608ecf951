// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/line_reader.h"

#include <algorithm>
#include <utility>

namespace halocline::modem_gateway {

void LineReader::take(std::string_view bytes, const std::function<void(std::string_view line)>& on_line,
                      const std::function<void()>& on_too_long) {
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find_first_of("\r\n"), bytes.size());
    const bool ends = end < bytes.size();
    if (!is_too_long_ && line_.size() + end > max_line_) {
      is_too_long_ = true;
      line_.clear();
      on_too_long();
    }
    if (!is_too_long_) line_.append(bytes.substr(0, end));
    bytes.remove_prefix(ends ? end + 1 : end);
    if (!ends) return;
    is_too_long_ = false;
    if (const std::string line = std::exchange(line_, ""); !line.empty()) on_line(line);
  }
}

}  // namespace halocline::modem_gateway

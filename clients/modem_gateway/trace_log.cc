// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/trace_log.h"

#include <iostream>
#include <ostream>

#include <fmt/format.h>

#include "core/check.h"

namespace halocline::modem_gateway {

std::string printable(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\r')
      text += "\\r";
    else if (c == '\n')
      text += "\\n";
    else if (byte < 0x20 || byte > 0x7e)
      text += fmt::format("\\x{:02X}", byte);
    else
      text += c;
  }
  return text;
}

TraceLog::TraceLog(const std::string& path) {
  if (path == "-") return;
  file_.open(path, std::ios::binary);
  require(file_.is_open(), "--trace " + path + " cannot be written; allowed is a file, or - for stderr");
}

void TraceLog::write(SimTime now, std::string_view interface, char direction, std::string_view bytes) {
  std::ostream& out = file_.is_open() ? static_cast<std::ostream&>(file_) : std::cerr;
  out << fmt::format("{:.6f} {} {} {}\n", now.seconds(), interface, direction, printable(bytes))
      << std::flush;
}

}  // namespace halocline::modem_gateway

// Sentences as NMEA 0183 frames them: $ body * HH, HH the exclusive or of the body's bytes in two hexadecimal digits.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::modem_gateway {

struct NmeaSentence {
  enum class Problem { kNone, kNoSentence, kChecksum };
  Problem problem = Problem::kNone;
  std::string_view id;                   // what stands before the first comma: CCCFG
  std::vector<std::string_view> fields;  // what stands between commas after that, empty ones included

  // "" beyond the last field.
  std::string_view field(std::size_t i) const { return i < fields.size() ? fields[i] : std::string_view(); }
};

std::uint8_t nmea_checksum(std::string_view body);
// With $, checksum, carriage return and line feed.
std::string nmea_line(std::string_view body);
// A line without its end; the checksum may be missing, and in either case. Refers to `line`.
NmeaSentence nmea_sentence(std::string_view line);

}  // namespace halocline::modem_gateway

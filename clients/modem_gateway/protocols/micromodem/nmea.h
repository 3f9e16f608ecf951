// SPDX-License-Identifier: BSD-3-Clause
// Sentences as NMEA 0183 frames them: $ body * HH, HH the exclusive or of the body's bytes in two hexadecimal
// digits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/modem_gateway/protocols/fields.h"

namespace halocline::modem_gateway {

struct NmeaSentence {
  enum class Problem { kNone, kNoSentence, kChecksum };
  Problem problem = Problem::kNone;
  std::string id;                        // what stands before the first comma, in capitals: CCCFG
  std::vector<std::string_view> fields;  // what stands between commas after that, empty ones included

  // "" beyond the last field.
  std::string_view field(std::size_t i) const { return i < fields.size() ? fields[i] : std::string_view(); }
  // The fields as they came, a comma before each.
  std::string all_fields() const;
  // The whole numbers in `count` fields from `first` on; none where one is no number from 0 to 100000.
  template <std::size_t count>
  std::optional<std::array<std::int64_t, count>> numbers(std::size_t first = 0) const {
    std::array<std::int64_t, count> values{};
    for (std::size_t i = 0; i < count; ++i) {
      const auto number = integer_in(field(first + i), 0, 100'000);
      if (!number) return std::nullopt;
      values[i] = *number;
    }
    return values;
  }
};

std::uint8_t nmea_checksum(std::string_view body);
// With $, checksum, carriage return and line feed.
std::string nmea_line(std::string_view body);
// A line without its end; the checksum may be missing, and in either case; blanks may follow. Refers to
// `line`.
NmeaSentence nmea_sentence(std::string_view line);

}  // namespace halocline::modem_gateway

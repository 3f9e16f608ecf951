// SPDX-License-Identifier: BSD-3-Clause
// Sentences framed as in NMEA 0183: $ body * HH, where HH is the exclusive or of the body's bytes in two
// hexadecimal digits.
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
  std::string id;                        // text before the first comma, in capitals: CCCFG
  std::vector<std::string_view> fields;  // texts between the later commas, including empty ones

  // Returns the i-th field; "" beyond the last.
  std::string_view field(std::size_t i) const { return i < fields.size() ? fields[i] : std::string_view(); }
  // Returns the fields as received, with a comma before each.
  std::string all_fields() const;
  // Returns the whole numbers in `count` fields from `first` on; nothing when one of them is not a number
  // from 0 to 100000.
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
// Frames a body with $, checksum, carriage return and line feed.
std::string nmea_line(std::string_view body);
// Parses a line without its line end. The checksum may be missing and may be in either case; blanks may
// follow. The result refers to `line`.
NmeaSentence nmea_sentence(std::string_view line);

}  // namespace halocline::modem_gateway

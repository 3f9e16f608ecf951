// SPDX-License-Identifier: BSD-3-Clause
// Channels that share a prefix: STATE.<vehicle> of each vehicle.
//
// Names are checked by is_valid_name (core/names.h) when they come from outside, so a member's name never
// means anything to a regular expression but its dot.
#pragma once

#include <string>
#include <string_view>

namespace halocline::bus {

struct Family {
  std::string_view prefix;  // ends in a dot
  std::string of(std::string_view name) const { return std::string(prefix) + std::string(name); }
};

}  // namespace halocline::bus

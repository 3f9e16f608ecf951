// SPDX-License-Identifier: BSD-3-Clause
// Family of channels that share a prefix, for instance STATE.<vehicle>, one channel for each vehicle.
//
// Names from outside are checked by is_valid_name (core/names.h), so the dot is the only character of a
// member's channel that a regular expression interprets.
#pragma once

#include <string>
#include <string_view>

namespace halocline::bus {

struct Family {
  std::string_view prefix;  // ends in a dot
  std::string of(std::string_view name) const { return std::string(prefix) + std::string(name); }
};

}  // namespace halocline::bus

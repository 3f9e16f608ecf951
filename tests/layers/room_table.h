// SPDX-License-Identifier: BSD-3-Clause
// The rooms of the tree and what each may include, with the reason: the table that room_rules.h applies.
#pragma once

#include <string_view>
#include <vector>

namespace halocline::layers {

using Words = std::vector<std::string_view>;

// A folder with sources; a sub-folder is a room of its own.
struct Room {
  std::string_view path;
  Words stands_on;          // rooms besides itself; an entry with a dot is a single header
  Words libraries;          // prefixes of others' headers
  std::string_view reason;  // why no more
};

const std::vector<Room>& rooms();

// Single files that wrap a library, or take one thing from elsewhere, and why.
struct Exemption {
  std::string_view file;    // prefix
  std::string_view header;  // prefix
  std::string_view reason;
};

const std::vector<Exemption>& exemptions();

}  // namespace halocline::layers

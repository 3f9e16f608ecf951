// SPDX-License-Identifier: BSD-3-Clause
// Checks, before anything is allocated, that the bytes of a message can be decoded.
//
// The decoders that lcm-gen writes trust the counts they read: a corrupt count makes them allocate gigabytes,
// or throw. A layout lists the fields of a type in order; misfit() walks the bytes along it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bus/messages.h"

namespace halocline::bus {

struct WireField;
using WireLayout = std::vector<WireField>;

struct WireField {
  enum class Kind {
    kFixed,   // `bytes` bytes
    kString,  // int32 length with the terminating 0, then that many bytes
    kCount,   // int32, the number of elements of the kArray fields that follow
    kArray,   // that many elements of `element`
  };
  Kind kind = Kind::kFixed;
  std::size_t bytes = 0;
  WireLayout element = {};
};

// An empty string when `size` bytes at `data` (with the 8-byte fingerprint in front) fit `layout` exactly;
// otherwise what is wrong with them.
[[nodiscard]] std::string misfit(const WireLayout& layout, const void* data, std::size_t size);

// The layout of each type of the bus, from its fields (bus/message_fields.h).
template <class Message>
const WireLayout& wire_layout();

}  // namespace halocline::bus

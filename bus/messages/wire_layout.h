// SPDX-License-Identifier: BSD-3-Clause
// Layout of encoded messages, with a check that bytes can be decoded before anything is allocated.
//
// The decoders that lcm-gen generates trust the counts that they read: a corrupt count makes them allocate
// gigabytes, or throw. A layout lists the fields of a type in order; misfit() walks the bytes along it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bus/messages/messages.h"

namespace halocline::bus {

struct WireField;
using WireLayout = std::vector<WireField>;

struct WireField {
  enum class Kind {
    kFixed,   // `bytes` bytes
    kString,  // int32 length with the terminating 0, then that many bytes
    kCount,   // int32, the number of elements of the kArray fields that follow
    kArray,   // elements of type `element`; their number is the last kCount
  };
  Kind kind = Kind::kFixed;
  std::size_t bytes = 0;
  WireLayout element = {};
};

// Returns an empty string when `size` bytes at `data` (starting with the 8-byte fingerprint) fit `layout`
// exactly; otherwise a description of the fault.
[[nodiscard]] std::string misfit(const WireLayout& layout, const void* data, std::size_t size);

// Returns the layout of a message type, made from its fields (bus/messages/message_fields.h).
template <class Message>
const WireLayout& wire_layout();

}  // namespace halocline::bus

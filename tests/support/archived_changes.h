// SPDX-License-Identifier: BSD-3-Clause
// Whether what is saved by parts counts its changes: bytes that differ from those of the last look have
// another number.
#pragma once

#include <cstdint>
#include <vector>

#include "core/archive.h"

namespace halocline::testing {

template <class T>
class ArchivedChanges {
 public:
  explicit ArchivedChanges(T& value) : value_(value) { note(); }

  // Since the last look: false where the bytes changed and the number did not.
  bool are_counted() {
    const auto bytes = bytes_;
    const std::uint64_t changes = changes_;
    note();
    return bytes == bytes_ || changes != changes_;
  }

 private:
  void note() {
    Archive saved;
    saved(value_);
    bytes_ = saved.bytes();
    changes_ = value_.changes();
  }

  T& value_;
  std::vector<std::uint8_t> bytes_;
  std::uint64_t changes_ = 0;
};

}  // namespace halocline::testing

// SPDX-License-Identifier: BSD-3-Clause
// What a fuzz target is, and the bytes of a fuzzer taken as values.
//
// The same bytes give the same values: a finding is a file. Behind the end every number is 0 and every block
// empty.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

// Each target defines it, for libFuzzer and for corpus_main.cc: takes any bytes, returns 0, and ends the
// process for a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace halocline::fuzz {

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : left_(data, size) {}

  bool is_empty() const { return left_.empty(); }
  // The highest byte first, as LCM has it.
  template <class Integer = std::uint8_t>
  Integer number() {
    std::make_unsigned_t<Integer> value = 0;
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
      value = static_cast<decltype(value)>(value << (sizeof(Integer) > 1 ? 8 : 0)) | next();
    }
    return static_cast<Integer>(value);
  }
  // From 0 to count - 1; `count` 1 to 256.
  std::size_t below(std::size_t count) { return next() % count; }
  // Its length in two bytes, then so many, or as many as there are.
  std::span<const std::uint8_t> block() { return take(number<std::uint16_t>()); }
  std::span<const std::uint8_t> rest() { return take(left_.size()); }
  std::string_view text_block() { return as_text(block()); }
  std::string_view rest_as_text() { return as_text(rest()); }

 private:
  static std::string_view as_text(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  std::uint8_t next() {
    const auto byte = take(1);
    return byte.empty() ? std::uint8_t{0} : byte[0];
  }
  std::span<const std::uint8_t> take(std::size_t size) {
    const auto taken = left_.first(std::min(size, left_.size()));
    left_ = left_.subspan(taken.size());
    return taken;
  }

  std::span<const std::uint8_t> left_;
};

}  // namespace halocline::fuzz

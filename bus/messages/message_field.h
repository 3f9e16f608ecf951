// SPDX-License-Identifier: BSD-3-Clause
// Description of a message field as lcmtypes/*.lcm states it. The generated visit_fields
// (bus/messages/message_fields.h) passes it together with the field's value.
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace halocline {

struct MessageField {
  std::string_view name;
  // Inclusive limits of each number of the field; for a text, limits of its length.
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  std::span<const char* const> enumeration = {};  // names of the values from min on; empty: no enumeration
  std::size_t inner = 1;                          // numbers in one element of a list of lists (points)
  bool is_count = false;                          // holds the length of the lists that follow
  bool is_name = false;                           // obeys is_valid_name (core/names.h)
  bool is_ascending = false;                      // each element is larger than the previous one
  bool is_unchecked = false;                      // may hold any value, NaN too
};

// Matches Message, const or not, by value or by reference.
template <class T, class Message>
concept IsMessage = std::same_as<std::remove_cvref_t<T>, Message>;

template <class T>
inline constexpr bool kIsList = false;
template <class Element>
inline constexpr bool kIsList<std::vector<Element>> = true;

}  // namespace halocline

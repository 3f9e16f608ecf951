// SPDX-License-Identifier: BSD-3-Clause
#include "bus/messages/wire_layout.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "bus/messages/message_field.h"
#include "bus/messages/message_fields.h"

namespace halocline::bus {
namespace {

constexpr std::size_t kFingerprintBytes = 8;

class Walk {
 public:
  Walk(const void* data, std::size_t size) : bytes_(static_cast<const std::uint8_t*>(data)), left_(size) {}

  std::string over(const WireLayout& layout) {
    std::int64_t elements = 0;
    for (const WireField& field : layout) {
      const std::string problem = step(field, elements);
      if (!problem.empty()) return problem;
    }
    return "";
  }

  bool skip(std::size_t bytes) {
    if (bytes > left_) return false;
    bytes_ += bytes;
    left_ -= bytes;
    return true;
  }

  std::size_t left() const { return left_; }

 private:
  std::string step(const WireField& field, std::int64_t& elements) {
    switch (field.kind) {
      case WireField::Kind::kFixed:
        return skip(field.bytes) ? "" : "too short";
      case WireField::Kind::kString:
        return over_string();
      case WireField::Kind::kCount:
        return read_int32(elements) && elements >= 0 ? "" : "impossible array length";
      case WireField::Kind::kArray:
        return over_array(field.element, elements);
    }
    return "";
  }

  std::string over_string() {
    std::int64_t length = 0;
    if (!read_int32(length) || length < 1) return "impossible string length";
    if (static_cast<std::size_t>(length) > left_) return "string longer than the message";
    if (bytes_[length - 1] != 0) return "string without its end";
    if (std::find(bytes_, bytes_ + length - 1, 0) != bytes_ + length - 1) return "string with a zero in it";
    skip(static_cast<std::size_t>(length));
    return "";
  }

  std::string over_array(const WireLayout& element, std::int64_t elements) {
    if (static_cast<std::uint64_t>(elements) > left_) return "array longer than the message";
    if (element.size() == 1 && element[0].kind == WireField::Kind::kFixed) {
      return skip(element[0].bytes * static_cast<std::size_t>(elements)) ? ""
                                                                         : "array longer than the message";
    }
    for (std::int64_t i = 0; i < elements; ++i) {
      const std::string problem = over(element);
      if (!problem.empty()) return problem;
    }
    return "";
  }

  bool read_int32(std::int64_t& value) {
    if (left_ < 4) return false;
    const std::uint32_t raw = std::uint32_t{bytes_[0]} << 24 | std::uint32_t{bytes_[1]} << 16 |
                              std::uint32_t{bytes_[2]} << 8 | std::uint32_t{bytes_[3]};
    value = static_cast<std::int32_t>(raw);
    return skip(4);
  }

  const std::uint8_t* bytes_;
  std::size_t left_;
};

// Builds the layout of a type; adjacent fields of fixed length are merged.
class LayoutBuilder {
 public:
  template <class T>
  void operator()(const MessageField& field, const T&) {
    if (field.is_count) {
      layout.push_back({WireField::Kind::kCount, 0, {}});
    } else {
      append<T>(field, layout);
    }
  }

  WireLayout layout;

 private:
  template <class T>
  static void append(const MessageField& field, WireLayout& to) {
    if constexpr (std::is_arithmetic_v<T>) {
      append_fixed(sizeof(T), to);
    } else if constexpr (std::is_same_v<T, std::string>) {
      to.push_back({WireField::Kind::kString, 0, {}});
    } else if constexpr (std::is_array_v<T>) {
      for (std::size_t i = 0; i < std::extent_v<T>; ++i) append<std::remove_extent_t<T>>(field, to);
    } else if constexpr (kIsList<T>) {
      to.push_back({WireField::Kind::kArray, 0, element_of<typename T::value_type>(field)});
    } else {
      for (const WireField& nested : wire_layout<T>()) append_field(nested, to);
    }
  }

  template <class Element>
  static WireLayout element_of(const MessageField& field) {
    WireLayout element;
    if constexpr (kIsList<Element>) {
      for (std::size_t i = 0; i < field.inner; ++i) append<typename Element::value_type>(field, element);
    } else {
      append<Element>(field, element);
    }
    return element;
  }

  static void append_fixed(std::size_t bytes, WireLayout& to) {
    if (to.empty() || to.back().kind != WireField::Kind::kFixed)
      to.push_back({WireField::Kind::kFixed, 0, {}});
    to.back().bytes += bytes;
  }

  static void append_field(const WireField& field, WireLayout& to) {
    if (field.kind == WireField::Kind::kFixed) {
      append_fixed(field.bytes, to);
    } else {
      to.push_back(field);
    }
  }
};

}  // namespace

std::string misfit(const WireLayout& layout, const void* data, std::size_t size) {
  Walk walk(data, size);
  if (!walk.skip(kFingerprintBytes)) return "too short";
  std::string problem = walk.over(layout);
  if (problem.empty() && walk.left() != 0) problem = "longer than its fields";
  return problem;
}

template <class Message>
const WireLayout& wire_layout() {
  static const WireLayout layout = [] {
    LayoutBuilder builder;
    visit_fields(builder, Message());
    return builder.layout;
  }();
  return layout;
}

#define HALOCLINE_WIRE_LAYOUT(type) template const WireLayout& wire_layout<type>();
HALOCLINE_EACH_MESSAGE(HALOCLINE_WIRE_LAYOUT)
#undef HALOCLINE_WIRE_LAYOUT

}  // namespace halocline::bus

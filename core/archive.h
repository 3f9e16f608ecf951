// SPDX-License-Identifier: BSD-3-Clause
// Archive: converts values to bytes and back, for the state that a node keeps on disk
// (bus/recovery/state_journal.h).
//
// A type states its members once, for both directions:
//
//   void archive(Archive& a) { a(position_, velocity_, waiting_); }
//
//   Archive saved;
//   saved(navigator);
//   Archive(saved.bytes())(another);  // loads
//
// Parts of a large state that seldom change can be saved separately, and only after a change: archive()
// passes them to part(), with a number that changes with them.
//
// Other supported types are trivially copyable types (copied as they lie in memory; no pointers in them),
// strings, vectors, deques, maps, sets, optional, pairs and tuples, Eigen's matrices and quaternions of fixed
// size, and messages of lcm-gen. It is no exchange format: only the same build of the same program can read
// the bytes.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/check.h"

namespace halocline {

class Archive {
 public:
  // Makes an archive that saves the values passed to it.
  Archive() = default;
  // Makes an archive that loads from `bytes`, which must outlive it. If they end too early, it throws
  // InvalidArgument here or when called.
  explicit Archive(std::span<const std::uint8_t> bytes) : source_(bytes), is_loading_(true) {}
  // Makes an archive that loads a state saved with separate parts.
  Archive(std::span<const std::uint8_t> bytes, std::span<const std::vector<std::uint8_t>> parts)
      : source_(bytes), source_parts_(parts), is_loading_(true), has_parts_apart_(true) {}

  template <class... T>
  void operator()(T&... values) {
    (pass(values), ...);
  }

  // Passes a part of the state. `changes` must differ from its value in every earlier call for this part
  // after which the part has changed. A state always has the same parts, in the same order, and no part
  // contains another.
  template <class T>
  void part(std::uint64_t changes, T& value) {
    if (has_parts_apart_ && !begin_part(changes)) return;
    pass(value);
    if (has_parts_apart_) end_part();
  }

  bool is_loading() const { return is_loading_; }
  // True when all of `bytes` was loaded.
  bool is_at_end() const { return source_.empty(); }
  // Starts saving again, with separate parts: all of them, or only those changed since the previous time.
  // Keeps the memory of the previous state.
  void begin_with_parts(bool all_parts);
  // Returns the bytes saved so far, without those of separate parts.
  const std::vector<std::uint8_t>& bytes() const { return saved_; }
  // A part that was saved separately; bytes_of_parts() holds the parts one after the other.
  struct Part {
    std::uint64_t index = 0, size = 0;
  };
  const std::vector<Part>& parts() const { return changed_; }
  const std::vector<std::uint8_t>& bytes_of_parts() const { return saved_parts_; }
  // Throws InvalidArgument when bytes are left to be loaded.
  void require_end() const;

 private:
  template <class T>
  static constexpr bool kIsPlain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

  template <class T>
  void pass(T& value) {
    if constexpr (requires { value.archive(*this); }) {
      value.archive(*this);
    } else if constexpr (requires { value.getEncodedSize(); }) {
      pass_message(value);
    } else if constexpr (requires {
                           value.coeffs();
                           typename T::Vector3;
                         }) {
      pass_bytes(value.coeffs().data(), 4 * sizeof(typename T::Scalar));
    } else if constexpr (requires { T::SizeAtCompileTime; }) {
      static_assert(T::SizeAtCompileTime > 0, "a matrix of fixed size");
      pass_bytes(value.data(), T::SizeAtCompileTime * sizeof(typename T::Scalar));
    } else if constexpr (kIsPlain<T>) {
      pass_bytes(&value, sizeof value);
    } else if constexpr (requires { value.has_value(); }) {
      pass_optional(value);
    } else if constexpr (requires { std::tuple_size<T>::value; }) {
      std::apply(*this, value);
    } else if constexpr (requires { typename T::key_type; }) {
      pass_keyed(value);
    } else {
      pass_sequence(value);
    }
  }

  bool begin_part(std::uint64_t changes);  // false if it is left out
  void end_part();
  void require_end_of_bytes() const;

  void pass_bytes(void* value, std::size_t size) {
    if (!is_loading_) {
      const auto* from = static_cast<const std::uint8_t*>(value);
      saved_.insert(saved_.end(), from, from + size);
      return;
    }
    require(size <= source_.size(), "the saved state is cut short");
    if (size > 0) std::memcpy(value, source_.data(), size);
    source_ = source_.subspan(size);
  }

  std::size_t pass_size(std::size_t size) {
    pass_bytes(&size, sizeof size);
    require(!is_loading_ || size <= source_.size(), "the saved state is cut short");
    return size;
  }

  template <class Message>
  void pass_message(Message& message) {
    const std::size_t size = pass_size(is_loading_ ? 0 : static_cast<std::size_t>(message.getEncodedSize()));
    if (is_loading_) {
      require(message.decode(source_.data(), 0, static_cast<int>(size)) == static_cast<int>(size),
              "the saved state holds another message");
      source_ = source_.subspan(size);
    } else {
      saved_.resize(saved_.size() + size);
      message.encode(saved_.data() + saved_.size() - size, 0, static_cast<int>(size));
    }
  }

  template <class Optional>
  void pass_optional(Optional& optional) {
    bool has_value = optional.has_value();
    pass_bytes(&has_value, sizeof has_value);
    if (!has_value) return optional.reset();
    if (is_loading_) optional.emplace();
    pass(*optional);
  }

  template <class Container>
  void pass_keyed(Container& container) {
    constexpr bool is_map = requires { typename Container::mapped_type; };
    using Key = typename Container::key_type;
    const std::size_t size = pass_size(container.size());
    if (is_loading_) {
      container.clear();
      for (std::size_t i = 0; i < size; ++i) {
        Key key;
        pass(key);
        if constexpr (is_map) {
          pass(container[std::move(key)]);
        } else {
          container.insert(std::move(key));
        }
      }
      return;
    }
    for (auto& element : container) {
      if constexpr (is_map) {
        pass(const_cast<Key&>(element.first));
        pass(element.second);
      } else {
        pass(const_cast<Key&>(element));
      }
    }
  }

  template <class Container>
  void pass_sequence(Container& container) {
    using Element = typename Container::value_type;
    const std::size_t size = pass_size(container.size());
    container.resize(size);
    if constexpr (kIsPlain<Element> && requires { container.data(); }) {
      pass_bytes(container.data(), size * sizeof(Element));
    } else {
      for (Element& element : container) pass(element);
    }
  }

  std::vector<std::uint8_t> saved_, saved_parts_;
  std::vector<Part> changed_;
  std::vector<std::uint64_t> changes_;  // value of `changes` of each part when it was last saved
  std::size_t next_part_ = 0;
  std::span<const std::uint8_t> source_, rest_of_source_;
  std::span<const std::vector<std::uint8_t>> source_parts_;
  bool is_loading_ = false, has_parts_apart_ = false;
};

}  // namespace halocline

// SPDX-License-Identifier: BSD-3-Clause
// Map of bounded size: when it is full, the least recently used entry is dropped. forget_unused() drops all
// entries that have not been used for a period.
//
//   LruCache<std::string, Spectrum> spectra(/*capacity=*/32);
//   const Spectrum& spectrum = spectra.find_or_make(name, [&] { return compute_spectrum(name); });
//
// An entry is used when it is inserted and when it is found. The entries that are kept depend only on the
// sequence of calls, never on addresses. Both operations take O(log size), with keys ordered by operator<;
// with a Hash (keys then need operator==) they take O(1). The cache owns keys and values; a value that must
// outlive its entry belongs in a shared_ptr. Not thread-safe: finding an entry moves it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "core/check.h"

namespace halocline {

template <class Key, class Value, class Hash = void>
class LruCache {
 public:
  // `capacity` is the maximum number of entries. Throws InvalidArgument when it is 0.
  explicit LruCache(std::size_t capacity) : capacity_(capacity) {
    require(capacity > 0, "a cache has room for at least one entry");
  }
  LruCache(LruCache&&) noexcept = default;
  LruCache& operator=(LruCache&&) noexcept = default;

  // Returns the value of `key`, null when there is none. The pointer is valid until the entry is replaced or
  // evicted.
  Value* find(const Key& key) {
    const auto entry = entries_.find(key);
    if (entry == entries_.end()) return nullptr;
    by_use_.splice(by_use_.begin(), by_use_, entry->second.place);
    entry->second.used_in = period_;
    return &entry->second.value;
  }

  // Inserts a value, or replaces that of an existing `key`. The reference is valid as long as a pointer from
  // find().
  Value& insert(Key key, Value value) {
    if (Value* known = find(key)) return *known = std::move(value);
    if (entries_.size() == capacity_) evict_least_recently_used();
    const auto entry = entries_.try_emplace(std::move(key), Entry{std::move(value), {}, period_}).first;
    by_use_.push_front(&entry->first);
    entry->second.place = by_use_.begin();
    return entry->second.value;
  }

  // Returns the value of `key`, inserting make() when there is none. The cache is unchanged when make()
  // throws.
  template <class Make>
  Value& find_or_make(const Key& key, Make&& make) {
    if (Value* known = find(key)) return *known;
    return insert(key, std::forward<Make>(make)());
  }

  // Drops the entries that were neither found nor inserted since the previous call.
  void forget_unused() {
    while (!entries_.empty() && entries_.find(*by_use_.back())->second.used_in != period_)
      evict_least_recently_used();
    ++period_;
  }

  std::size_t size() const { return entries_.size(); }
  std::size_t capacity() const { return capacity_; }

 private:
  using Order = std::list<const Key*>;  // keys in `entries_`, most recently used first
  struct Entry {
    Value value;
    typename Order::iterator place;
    std::uint64_t used_in;  // number of the period between two calls of forget_unused()
  };

  void evict_least_recently_used() {
    entries_.erase(entries_.find(*by_use_.back()));
    by_use_.pop_back();
  }

  std::size_t capacity_;
  std::conditional_t<std::is_void_v<Hash>, std::map<Key, Entry>, std::unordered_map<Key, Entry, Hash>>
      entries_;
  Order by_use_;
  std::uint64_t period_ = 0;
};

}  // namespace halocline

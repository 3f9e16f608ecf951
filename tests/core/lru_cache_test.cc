// SPDX-License-Identifier: BSD-3-Clause
#include "core/lru_cache.h"

#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"

namespace halocline {
namespace {

using Cache = LruCache<int, std::string>;

// Which of 0..9 are kept, without using them: finding moves an entry, so a cache is emptied to look.
std::vector<int> kept(Cache cache) {
  std::vector<int> keys;
  for (int key = 0; key < 10; ++key) {
    if (cache.find(key)) keys.push_back(key);
  }
  return keys;
}

TEST(LruCache, FindsWhatWasInsertedAndNothingElse) {
  Cache cache(2);
  cache.insert(1, "one");
  ASSERT_NE(cache.find(1), nullptr);
  EXPECT_EQ(*cache.find(1), "one");
  EXPECT_EQ(cache.find(2), nullptr);
}

TEST(LruCache, EvictsTheEntryInsertedFirstWhenNoneIsUsed) {
  Cache cache(3);
  for (int key = 0; key < 5; ++key) cache.insert(key, "");
  EXPECT_EQ(cache.size(), 3U);
  EXPECT_EQ(kept(std::move(cache)), (std::vector<int>{2, 3, 4}));
}

TEST(LruCache, FindingAnEntryKeepsItLonger) {
  Cache cache(3);
  for (int key = 0; key < 3; ++key) cache.insert(key, "");
  cache.find(0);
  cache.insert(3, "");
  EXPECT_EQ(kept(std::move(cache)), (std::vector<int>{0, 2, 3}));
}

TEST(LruCache, InsertingAKnownKeyReplacesItsValueAndCountsAsUse) {
  Cache cache(2);
  cache.insert(0, "old");
  cache.insert(1, "");
  EXPECT_EQ(cache.insert(0, "new"), "new");
  EXPECT_EQ(cache.size(), 2U);
  cache.insert(2, "");
  EXPECT_EQ(*cache.find(0), "new");
  EXPECT_EQ(cache.find(1), nullptr);
}

TEST(LruCache, LookingForAnUnknownKeyChangesNothing) {
  Cache cache(2);
  cache.insert(0, "");
  cache.insert(1, "");
  EXPECT_EQ(cache.find(7), nullptr);
  cache.insert(2, "");
  EXPECT_EQ(kept(std::move(cache)), (std::vector<int>{1, 2}));
}

TEST(LruCache, MakesAValueOnceAsLongAsItIsKept) {
  LruCache<int, int> cache(1);
  int made = 0;
  const auto make = [&] { return ++made; };
  EXPECT_EQ(cache.find_or_make(5, make), 1);
  EXPECT_EQ(cache.find_or_make(5, make), 1);
  EXPECT_EQ(cache.find_or_make(6, make), 2);
  EXPECT_EQ(cache.find_or_make(5, make), 3);
}

TEST(LruCache, IsAsBeforeWhenAValueCannotBeMade) {
  Cache cache(1);
  cache.insert(0, "zero");
  const auto fail = []() -> std::string { throw std::runtime_error("no"); };
  EXPECT_THROW(cache.find_or_make(1, fail), std::runtime_error);
  EXPECT_EQ(kept(std::move(cache)), (std::vector<int>{0}));
}

TEST(LruCache, ValuesStayWhereTheyAreUntilEvicted) {
  Cache cache(100);
  const std::string* first = &cache.insert(0, "zero");
  for (int key = 1; key < 100; ++key) cache.insert(key, "");
  EXPECT_EQ(cache.find(0), first);
  EXPECT_EQ(*first, "zero");
}

TEST(LruCache, ReleasesTheValueItEvicts) {
  LruCache<int, std::shared_ptr<int>> cache(1);
  const auto value = std::make_shared<int>(3);
  cache.insert(0, value);
  EXPECT_EQ(value.use_count(), 2);
  cache.insert(1, nullptr);
  EXPECT_EQ(value.use_count(), 1);
}

TEST(LruCache, ForgetsWhatWasNotUsedBetweenTwoCalls) {
  Cache cache(4);
  for (int key = 0; key < 3; ++key) cache.insert(key, "");
  cache.forget_unused();
  EXPECT_EQ(cache.size(), 3U);
  cache.find(1);
  cache.insert(3, "");
  cache.forget_unused();
  EXPECT_EQ(cache.size(), 2U);
  EXPECT_NE(cache.find(1), nullptr);
  EXPECT_NE(cache.find(3), nullptr);
  cache.forget_unused();
  cache.forget_unused();
  EXPECT_EQ(cache.size(), 0U);
}

TEST(LruCache, KeysNeedOnlyAnOrderAndValuesMayBeMoveOnly) {
  LruCache<std::tuple<int, std::string>, std::unique_ptr<int>> cache(2);
  cache.insert({1, "a"}, std::make_unique<int>(10));
  cache.find_or_make({1, "b"}, [] { return std::make_unique<int>(11); });
  EXPECT_EQ(**cache.find({1, "a"}), 10);
  EXPECT_EQ(**cache.find({1, "b"}), 11);
}

TEST(LruCache, RefusesToHaveNoRoom) { EXPECT_THROW(Cache(0), InvalidArgument); }

}  // namespace
}  // namespace halocline

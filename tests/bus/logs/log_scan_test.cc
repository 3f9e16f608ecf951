// SPDX-License-Identifier: BSD-3-Clause
// Every event that does not overlap damaged bytes is found, wherever the damage is.
#include "bus/logs/log_scan.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"

namespace halocline::clients {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append_number(Bytes& log, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) log.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void append_event(Bytes& log, std::int64_t number, const std::string& channel, const Bytes& data) {
  append_number(log, 0xEDA1DA01u, 4);
  append_number(log, static_cast<std::uint64_t>(number), 8);
  append_number(log, static_cast<std::uint64_t>(number) * 1000, 8);
  append_number(log, channel.size(), 4);
  append_number(log, data.size(), 4);
  log.insert(log.end(), channel.begin(), channel.end());
  log.insert(log.end(), data.begin(), data.end());
}

struct Extent {
  std::size_t begin, end;
  bool operator==(const Extent&) const = default;
};

struct WholeLog {
  Bytes bytes;
  std::vector<Extent> events;
};

std::uint64_t draw(std::uint64_t which, std::uint64_t below) {
  return bits_at({.seed = 4711, .purpose = purpose_of("log-scan-test"), .who = 0, .which = which}) % below;
}

// Events of equal sizes by runs (a skipped event must not hide behind equal strides), others of any size.
WholeLog log_of(int events, std::uint64_t salt) {
  WholeLog log;
  for (int i = 0; i < events; ++i) {
    const std::uint64_t address = salt * 1000 + static_cast<std::uint64_t>(i);
    Bytes data(i % 3 == 0 ? draw(address, 300) : 64);
    for (std::size_t b = 0; b < data.size(); ++b)
      data[b] = static_cast<std::uint8_t>(draw(address * 7919 + b, 256));
    const std::size_t begin = log.bytes.size();
    append_event(log.bytes, i, i % 2 == 0 ? "STATE.auv-1" : "LINKS.auv-22", data);
    log.events.push_back({begin, log.bytes.size()});
  }
  return log;
}

struct Scan {
  std::vector<Extent> events, damages;
  bool cut_short = false;
};

Scan scan(const Bytes& log) {
  Scan found;
  for (std::size_t at = 0;;) {
    const LogStep step = next_event(log, at);
    if (step.damage.size > 0)
      found.damages.push_back({step.damage.offset, step.damage.offset + step.damage.size});
    found.cut_short = step.damage.cut_short;
    if (step.at_end) return found;
    found.events.push_back({step.event.offset, step.event.offset + step.event.size});
    at = step.event.offset + step.event.size;
  }
}

TEST(LogScan, AWholeLogIsAllEventsAndNoDamage) {
  const WholeLog log = log_of(50, 1);
  const Scan found = scan(log.bytes);
  EXPECT_EQ(found.events, log.events);
  EXPECT_TRUE(found.damages.empty());
}

class LogScanDamage : public ::testing::TestWithParam<int> {};

// 2000 logs, each with bursts of changed bytes at seeded places.
TEST_P(LogScanDamage, EveryEventThatDoesNotOverlapItIsFound) {
  const int bursts = GetParam();
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    WholeLog log = log_of(24, trial % 20);
    std::vector<Extent> damaged;
    for (int burst = 0; burst < bursts; ++burst) {
      const std::uint64_t address = (trial * 10 + static_cast<std::uint64_t>(burst)) * 1000 + 500'000'000;
      const std::size_t begin = draw(address, log.bytes.size());
      const std::size_t end = std::min(log.bytes.size(), begin + 1 + draw(address + 1, 8));
      for (std::size_t i = begin; i < end; ++i)
        log.bytes[i] = static_cast<std::uint8_t>(log.bytes[i] ^ (1 + draw(address + 2 + i, 255)));
      damaged.push_back({begin, end});
    }
    const Scan found = scan(log.bytes);
    for (const Extent& event : log.events) {
      const bool whole = std::none_of(damaged.begin(), damaged.end(), [&](const Extent& d) {
        return d.begin < event.end && event.begin < d.end;
      });
      const bool is_found = std::find(found.events.begin(), found.events.end(), event) != found.events.end();
      ASSERT_TRUE(is_found || !whole) << "trial " << trial << ", event at byte " << event.begin;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Bursts, LogScanDamage, ::testing::Values(1, 2, 5));

TEST(LogScan, EveryByteBelongsToAnEventOrIsReportedAsDamage) {
  for (std::uint64_t trial = 0; trial < 500; ++trial) {
    WholeLog log = log_of(12, trial % 10);
    const std::size_t at = draw(trial + 900'000'000, log.bytes.size());
    log.bytes[at] = static_cast<std::uint8_t>(~log.bytes[at]);
    Scan found = scan(log.bytes);
    std::vector<Extent> all = found.events;
    all.insert(all.end(), found.damages.begin(), found.damages.end());
    std::sort(all.begin(), all.end(), [](const Extent& a, const Extent& b) { return a.begin < b.begin; });
    std::size_t end = 0;
    for (const Extent& extent : all) {
      ASSERT_EQ(extent.begin, end) << "trial " << trial;
      end = extent.end;
    }
    ASSERT_EQ(end, log.bytes.size()) << "trial " << trial;
  }
}

TEST(LogScan, ALengthThatSwallowsWholeEventsIsSeenThrough) {
  Bytes log;
  for (int i = 0; i < 4; ++i) append_event(log, i, "X", Bytes(64));
  constexpr std::size_t kEventBytes = 28 + 1 + 64;
  log[kEventBytes + 27] = 64 + 2 * kEventBytes;  // the second event claims the third and fourth
  const Scan found = scan(log);
  ASSERT_EQ(found.events.size(), 3u);
  EXPECT_EQ(found.damages, (std::vector<Extent>{{kEventBytes, 2 * kEventBytes}}));
}

TEST(LogScan, AMessageThatCarriesALogIsOneEvent) {
  Bytes inner, log;
  append_event(inner, 900, "INNER", {1, 2, 3});
  append_event(log, 0, "FILE", inner);
  append_event(log, 1, "AFTER", {4});
  EXPECT_EQ(scan(log).events.size(), 2u);
  EXPECT_TRUE(scan(log).damages.empty());
}

TEST(LogScan, DamageHasItsPlaceAndSize) {
  Bytes log;
  append_event(log, 0, "A", {1});
  const std::size_t first = log.size();
  log.insert(log.end(), {'r', 'u', 'b', 'b', 'i', 's', 'h'});
  append_event(log, 1, "B", {2});
  EXPECT_EQ(scan(log).damages, (std::vector<Extent>{{first, first + 7}}));
}

TEST(LogScan, AnEventCutByTheEndOfTheFileIsDistinguishedFromGarbage) {
  Bytes log;
  append_event(log, 0, "A", Bytes(20));
  const Bytes cut(log.begin(), log.end() - 5);
  EXPECT_TRUE(scan(cut).cut_short);
  log.insert(log.end(), {1, 2, 3, 4, 5});
  EXPECT_FALSE(scan(log).cut_short);
}

// Differences of such times overflow.
TEST(LogScan, AnEventOfNoTimeIsDamage) {
  Bytes log;
  append_event(log, 0, "A", {1});
  const std::size_t damaged_at = log.size();
  append_event(log, 1, "B", {2});
  log[damaged_at + 12] = 0x80;  // its stamp: INT64_MIN and a little
  const std::size_t next_at = log.size();
  append_event(log, 2, "C", {3});
  const LogStep step = next_event(log, damaged_at);
  EXPECT_EQ(step.damage.size, next_at - damaged_at);
  EXPECT_EQ(step.event.channel, "C");
}

TEST(LogScan, OtherFilesDoNotLookLikeALog) {
  const std::string text = "[scenario]\nname = \"seamount\"\n";
  EXPECT_FALSE(looks_like_a_log({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
  EXPECT_TRUE(looks_like_a_log({}));
  const Bytes beginning{0xED, 0xA1};
  EXPECT_TRUE(looks_like_a_log(beginning));
}

}  // namespace
}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
#include "core/archive.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline {
namespace {

struct Leg {
  Vec3 from = Vec3::Zero();
  std::string name;

  void archive(Archive& a) { a(from, name); }
  bool operator==(const Leg&) const = default;
};

struct Everything {
  double number = 0;
  SimTime at;
  Quaternion orientation = Quaternion::Identity();
  std::vector<int> counts;
  std::vector<Leg> legs;
  std::deque<Leg> waiting;
  std::map<std::string, Leg> by_name;
  std::set<std::tuple<int, std::string>> known;
  std::optional<Leg> latest, none;
  std::optional<double> angle;

  void archive(Archive& a) {
    a(number, at, orientation, counts, legs, waiting, by_name, known, latest, none, angle);
  }
  bool operator==(const Everything& o) const {
    return std::tie(number, at, counts, legs, waiting, by_name, known, latest, none, angle) ==
               std::tie(o.number, o.at, o.counts, o.legs, o.waiting, o.by_name, o.known, o.latest, o.none,
                        o.angle) &&
           orientation.coeffs() == o.orientation.coeffs();
  }
};

Everything example() {
  const Leg a{{1, 2, 3}, "a"}, b{{4, 5, 6}, "bb"};
  return {1.5, SimTime::from_utime(7), Quaternion(0.5, 0.5, -0.5, 0.5), {1, 2, 3}, {a, b},
          {b}, {{"x", a}, {"y", b}},   {{1, "one"}, {2, "two"}},        b,         {},
          0.25};
}

TEST(Archive, LoadsWhatWasSaved) {
  Everything saved = example();
  Archive to;
  to(saved);
  Everything loaded;
  loaded.none = Leg{};
  loaded.known = {{3, "three"}};
  Archive from(to.bytes());
  from(loaded);
  EXPECT_TRUE(loaded == saved);
  EXPECT_NO_THROW(from.require_end());
}

TEST(Archive, StateThatWasCutShortIsRefusedWhereverTheCutIs) {
  Everything saved = example();
  Archive to;
  to(saved);
  for (std::size_t size = 0; size < to.bytes().size(); ++size) {
    Archive from(std::span(to.bytes()).first(size));
    Everything loaded;
    EXPECT_THROW(from(loaded), InvalidArgument) << size;
  }
}

TEST(Archive, BytesLeftOverAreRefused) {
  const std::vector<std::uint8_t> bytes(9);
  Archive from(bytes);
  double number = 0;
  from(number);
  EXPECT_THROW(from.require_end(), InvalidArgument);
}

struct Fleet {
  int time = 0;
  std::vector<Leg> legs{{{1, 2, 3}, "a"}, {{4, 5, 6}, "b"}};
  std::vector<std::uint64_t> changes{0, 0};

  void archive(Archive& a) {
    a(time);
    for (std::size_t i = 0; i < legs.size(); ++i) a.part(changes[i], legs[i]);
  }
};

std::vector<std::uint8_t> bytes_of_part(const Archive& a, std::size_t which) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < which; ++i) begin += a.parts()[i].size;
  const auto first = a.bytes_of_parts().begin() + static_cast<std::ptrdiff_t>(begin);
  return {first, first + static_cast<std::ptrdiff_t>(a.parts()[which].size)};
}

TEST(Archive, APartIsSavedAgainOnceItHasChanged) {
  Fleet fleet, loaded;
  Archive to;
  to.begin_with_parts(true);
  to(fleet);
  ASSERT_EQ(to.parts().size(), 2u);
  std::vector<std::vector<std::uint8_t>> parts{bytes_of_part(to, 0), bytes_of_part(to, 1)};
  fleet.time = 5;
  fleet.legs[1].name = "c";
  ++fleet.changes[1];
  to.begin_with_parts(false);
  to(fleet);
  ASSERT_EQ(to.parts().size(), 1u);
  EXPECT_EQ(to.parts()[0].index, 1u);
  parts[1] = bytes_of_part(to, 0);
  Archive from(to.bytes(), parts);
  from(loaded);
  EXPECT_NO_THROW(from.require_end());
  EXPECT_EQ(loaded.time, 5);
  EXPECT_EQ(loaded.legs, fleet.legs);
}

TEST(Archive, AnotherNumberOfPartsIsRefused) {
  Fleet fleet;
  Archive to;
  to.begin_with_parts(true);
  to(fleet);
  std::vector<std::vector<std::uint8_t>> parts{bytes_of_part(to, 0)};
  EXPECT_THROW(Archive(to.bytes(), parts)(fleet), InvalidArgument);
  parts = {bytes_of_part(to, 0), bytes_of_part(to, 1), {}};
  Archive from(to.bytes(), parts);
  from(fleet);
  EXPECT_THROW(from.require_end(), InvalidArgument);
}

TEST(Archive, WithoutPartsApartAPartLiesInItsPlace) {
  Fleet fleet, loaded;
  fleet.legs[0].name = "x";
  Archive to;
  to(fleet);
  Archive(to.bytes())(loaded);
  EXPECT_EQ(loaded.legs, fleet.legs);
}

}  // namespace
}  // namespace halocline

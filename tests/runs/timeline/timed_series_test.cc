// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/timed_series.h"

#include <cmath>

#include <gmock/gmock.h>

namespace halocline::clients {
namespace {

using ::testing::ElementsAre;

SimTime at(double seconds) { return SimTime::from_seconds(seconds); }

std::vector<double> values(std::span<const Timed<double>> entries) {
  std::vector<double> found;
  for (const auto& entry : entries) found.push_back(entry.value);
  return found;
}

TimedSeries<double> ramp(int size) {
  TimedSeries<double> series;
  for (int i = 0; i < size; ++i) series.add(at(i), i);
  return series;
}

TEST(TimedSeries, KeepsTheOrderOfTimeWhateverTheOrderOfArrival) {
  TimedSeries<double> series;
  for (const double s : {3.0, 1.0, 2.0, 0.0}) EXPECT_TRUE(series.add(at(s), s));
  EXPECT_THAT(values(series.all()), ElementsAre(0, 1, 2, 3));
}

TEST(TimedSeries, ARepetitionReplacesWhatIsThere) {
  TimedSeries<double> series = ramp(3);
  EXPECT_FALSE(series.add(at(1), 10));
  EXPECT_FALSE(series.add(at(2), 20));
  EXPECT_THAT(values(series.all()), ElementsAre(0, 10, 20));
}

TEST(TimedSeries, FindsTheLastOneOfATimeOrBefore) {
  const TimedSeries<double> series = ramp(3);
  EXPECT_EQ(series.at_or_before(at(-0.1)), nullptr);
  EXPECT_EQ(series.at_or_before(at(1))->value, 1);
  EXPECT_EQ(series.at_or_before(at(1.9))->value, 1);
  EXPECT_EQ(series.at_or_before(at(99))->value, 2);
}

TEST(TimedSeries, AStretchOfTimeHoldsItsEnds) {
  const TimedSeries<double> series = ramp(5);
  EXPECT_THAT(values(series.between(at(1), at(3))), ElementsAre(1, 2, 3));
  EXPECT_TRUE(series.between(at(3), at(1)).empty());
  EXPECT_TRUE(series.between(at(1.2), at(1.8)).empty());
}

TEST(TimedSeries, ThinningHalvesItAndWhatComesLaterStandsAsFarApart) {
  TimedSeries<double> series = ramp(101);
  EXPECT_EQ(series.thin(), 50u);
  for (int i = 101; i < 201; ++i) series.add(at(i), i);
  ASSERT_EQ(series.size(), 101u);
  for (std::size_t i = 0; i < series.size(); ++i)
    EXPECT_EQ(series.all()[i].value, 2.0 * static_cast<double>(i));
}

TEST(TimedSeries, TheNewestIsThereThoughItIsTooNear) {
  TimedSeries<double> series = ramp(101);
  series.thin();
  series.add(at(100.5), 100.5);
  EXPECT_EQ(series.back().value, 100.5);
  series.add(at(101), 101);
  EXPECT_EQ(series.back().value, 101);
  EXPECT_EQ(series.size(), 52u);
}

TEST(TimedSeries, DroppingKeepsWhatHoldsAtTheFirstInstant) {
  TimedSeries<double> series = ramp(10);
  EXPECT_EQ(series.drop_before(at(4.5)), 4u);
  EXPECT_EQ(series.front().value, 4);
  EXPECT_EQ(series.at_or_before(at(4.5))->value, 4);
}

TEST(Decimated, KeepsTheExtremesOfEveryQuantityAndTheEnds) {
  TimedSeries<double> series;
  for (int i = 0; i < 10'000; ++i)
    series.add(at(i), std::sin(i * 0.01) + (i == 4321 ? 50 : 0) - (i == 77 ? 60 : 0));
  const auto chosen = decimated(series.all(), 100, [](double value) { return value; });
  EXPECT_LE(chosen.size(), 100u);
  EXPECT_GE(chosen.size(), 50u);
  EXPECT_EQ(chosen.front().at, at(0));
  EXPECT_EQ(chosen.back().at, at(9999));
  const auto less = [](const auto& a, const auto& b) { return a.value < b.value; };
  const auto [least, greatest] = std::minmax_element(chosen.begin(), chosen.end(), less);
  EXPECT_EQ(least->at, at(77));
  EXPECT_EQ(greatest->at, at(4321));
  EXPECT_TRUE(
      std::is_sorted(chosen.begin(), chosen.end(), [](const auto& a, const auto& b) { return a.at < b.at; }));
}

TEST(Decimated, TwoQuantitiesShareThePoints) {
  TimedSeries<double> series = ramp(10'000);
  const auto chosen = decimated(
      series.all(), 30, [](double v) { return v; }, [](double v) { return -v; });
  EXPECT_LE(chosen.size(), 30u);
}

TEST(Decimated, FewEntriesStayAsTheyAre) {
  EXPECT_EQ(decimated(ramp(50).all(), 50, [](double v) { return v; }).size(), 50u);
}

}  // namespace
}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/coverage/sampling.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace halocline::clients {
namespace {

std::vector<double> even_places(int count) {
  std::vector<double> places;
  for (int i = 0; i < count; ++i) places.push_back(0.1 * i);
  return places;
}

// A quartic is its own interpolation.
TEST(Sampling, SmoothFunctionIsComputedAtFewPlacesAndRightAtAll) {
  const auto places = even_places(1001);
  int calls = 0;
  const auto function = [](double x) -> Sample { return {x * x, std::pow(0.1 * x, 4), 3 - x}; };
  const auto samples = sampled(places, 10, {0.5, 0.5, 0.5}, [&](double x) {
    ++calls;
    return function(x);
  });
  EXPECT_LT(calls, 80);
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t q = 0; q < 3; ++q)
      ASSERT_NEAR(samples[i][q], function(places[i])[q], 1e-9 * (1 + std::abs(function(places[i])[q])))
          << places[i];
  }
}

TEST(Sampling, JumpIsWhereItIs) {
  const auto places = even_places(1001);
  const auto function = [](double x) -> Sample { return {x > 31.45 ? 1.0 : 0.0, 0, 0}; };
  int calls = 0;
  const auto samples = sampled(places, 5, {0.01, 0.01, 0.01}, [&](double x) {
    ++calls;
    return function(x);
  });
  EXPECT_LT(calls, 200);
  for (std::size_t i = 0; i < places.size(); ++i)
    ASSERT_NEAR(samples[i][0], function(places[i])[0], 1e-12) << places[i];
}

// Nothing can be said of values that nobody asks for.
TEST(Sampling, WhatHasAnInfiniteToleranceCostsNothing) {
  const auto places = even_places(201);
  int calls = 0;
  sampled(places, 20, {0.01, INFINITY, 0.01}, [&](double x) -> Sample {
    ++calls;
    return {1, std::sin(1000 * x), 1};
  });
  EXPECT_EQ(calls, 5);
}

TEST(Sampling, FewPlacesAreComputedOneByOne) {
  const auto function = [](double x) -> Sample { return {std::sin(9 * x), 0, 0}; };
  for (const int count : {1, 2, 3, 7}) {
    const auto places = even_places(count);
    const auto samples = sampled(places, 100, {1e-9, 1, 1}, function);
    for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(samples[i], function(places[i]));
  }
}

}  // namespace
}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of channel_server/, compiled and run
// (tests/docs/check_examples).
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "channel_server/links/echo_survey.h"
#include "channel_server/links/link_table.h"
#include "channel_server/propagation/straight_propagation.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

TEST(HeaderExamples, EchoSurvey) {
  const Vec3 a(0, 0, 40), b(900, 0, 70);
  const SimTime now;
  const acoustics::Modem transmitter, receiver;
  StraightPropagation propagation(testing::even_water());
  const auto answers_to = [](const std::vector<TerrainRay>& rays) {
    return std::vector<RayAnswer>(rays.size(), {RayAnswer::Kind::kHit, 200});
  };
  EchoSurvey survey(a, b, 9);
  survey.take_depths(answers_to(survey.depth_rays()));
  survey.take_ways(answers_to(survey.way_rays()));
  const Multipath echoes = multipath_of(survey, /*reversed=*/false, now, propagation, transmitter, receiver);
  EXPECT_TRUE(survey.complete());
  EXPECT_EQ(echoes, Multipath::kUnlikely);  // the bottom cuts every way
}

}  // namespace
}  // namespace halocline::channel_server

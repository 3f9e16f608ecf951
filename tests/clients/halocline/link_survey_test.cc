#include "clients/halocline/link_survey.h"

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using ::halocline::testing::tolerance;

ScenarioConfig two_vehicles() {
  ScenarioConfig config;
  config.scenario.vehicles.resize(1);
  config.scenario.vehicles[0].name = "auv-1";
  config.scenario.vehicles[0].id = 1;
  config.scenario.vehicles[0].start_ned_m = {-500, 0, 0};
  config.terrain.flat.depth_m = 1000;
  return config;
}

TEST(LinkSurvey, EndIsAVehicleOrAPosition) {
  const ScenarioConfig config = two_vehicles();
  EXPECT_EQ(link_end(config, "auv-1").position_ned_m, Vec3(-500, 0, 0));
  EXPECT_EQ(link_end(config, "1.5,-2,30").position_ned_m, Vec3(1.5, -2, 30));
}

TEST(LinkSurvey, ImpossibleEndsAreRefused) {
  const ScenarioConfig config = two_vehicles();
  for (const char* text : {"auv-9", "1,2", "1,2,3,4", "1,2,x", "1,2,-5", "nan,0,0", ""}) {
    EXPECT_THROW(link_end(config, text), InvalidArgument) << text;
  }
}

// model.md section 8: 1 km at the surface in the global mean profile; 1e-6 is the precision it is stated with.
TEST(LinkSurvey, DelayOfTheStraightPathIsThatOfThePapersFigure4) {
  ScenarioConfig config = two_vehicles();
  config.channel_server.propagation.model = channel_server::PropagationModel::kStraight;
  const LinkAnswer answer = survey_link(config, link_end(config, "auv-1"), link_end(config, "500,0,0"));
  EXPECT_NEAR(answer.reception.budget.delay_s, 0.660724, tolerance(1e-6));
}

TEST(LinkSurvey, EchoIsLikelyOverAShallowBottomAndUnknownBeyondTheTerrain) {
  ScenarioConfig config = two_vehicles();
  config.terrain.flat.depth_m = 50;
  const LinkEnd from = link_end(config, "auv-1");
  EXPECT_EQ(survey_link(config, from, link_end(config, "500,0,0")).multipath,
            channel_server::Multipath::kLikely);
  const LinkEnd outside = link_end(config, "90000,0,10"), farther = link_end(config, "91000,0,10");
  EXPECT_EQ(survey_link(config, outside, farther).multipath, channel_server::Multipath::kUnknown);
}

}  // namespace
}  // namespace halocline::clients

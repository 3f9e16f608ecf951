// SPDX-License-Identifier: BSD-3-Clause
// What is left out of weak sound depends on no source level: a link loses the same however loud it is.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "channel_server/detail.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "core/frames.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

// A harbour of 13 m with some decimetres of relief.
double harbour_z_m(const Vec3& place) {
  return 13 + 0.4 * std::sin(place.x() / 17) + 0.2 * std::sin(place.x() / 7 + place.y() / 31);
}

TEST(SourceLevel, MovesNoLossOfALinkAcrossAHarbour) {
  acoustics::Environment water = testing::even_water();
  water.profile = acoustics::SoundSpeedProfile::from_speeds({{0, 1518}, {4, 1516}, {20, 1510}}, {18, 34});
  RayModel rays;
  rays.options.min_boundary_factor = std::pow(10.0, -30 / 20.0);
  rays.options.diffuse_below_flux_db = kExactLevel.diffuse_below_flux_db;
  rays.diffuse_below_noise = kExactLevel.diffuse_below_noise;
  rays.weak_below_diffuse = kExactLevel.weak_below_diffuse;
  rays.fading.enabled = true;
  const auto map = std::make_shared<SeabedMap>(SeabedRule{});
  RayPropagation propagation(std::make_shared<EnvironmentTimeline>(water), map, rays);
  const Vec3 from(0, 0, 6), to(900, 0, 5);
  testing::survey(*map, from, to, harbour_z_m);
  double first_db = 0;
  for (double level_db = 100; level_db <= 190; level_db += 10) {
    acoustics::Modem modem;
    modem.source_level = Decibels{level_db};
    const Reception reception =
        propagation.reception(at_s(0), {1, from, Vec3::Zero(), &modem}, {2, to, Vec3::Zero(), &modem});
    ASSERT_EQ(reception.state, PathState::kOpen) << level_db;
    const double loss_db = level_db - reception.budget.received_level.value;
    if (level_db == 100) first_db = loss_db;
    EXPECT_NEAR(loss_db, first_db, 0.1) << level_db;
  }
}

}  // namespace
}  // namespace halocline::channel_server

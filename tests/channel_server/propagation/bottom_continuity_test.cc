// SPDX-License-Identifier: BSD-3-Clause
// While a vehicle moves, the level of its links changes as little as the vehicle moves: the bottom under a
// link is a continuous function of its ends. What may step is the number of paths.
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "core/frames.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

// A hill of 30 m in 100 m of water. Narrower ones focus sound on caustics, which a vehicle crosses within 0.1
// m.
double hill(const Vec3& place, double width_m) {
  const double north = place.x() - 700, east = place.y() + 40;
  return 100 - 30 * std::exp(-(north * north + east * east) / (2 * width_m * width_m));
}
double wide_hill(const Vec3& place) { return hill(place, 300); }
double narrow_hill(const Vec3& place) { return hill(place, 200); }
double slope(const Vec3& place) { return 100 - 0.03 * place.x() + 0.02 * place.y(); }

struct Course {
  double (*seabed_z_m)(const Vec3&);
  Vec3 from, way;  // way: a step of it is a tenth
};

class BottomContinuity : public ::testing::TestWithParam<Course> {
 protected:
  static RayModel model() {
    RayModel model;
    model.options.max_bounces = 60;
    model.options.min_boundary_factor = std::pow(10.0, -30 / 20.0);
    return model;
  }
  std::shared_ptr<SeabedMap> map_ = std::make_shared<SeabedMap>(SeabedRule{});
  RayPropagation rays_{std::make_shared<EnvironmentTimeline>(testing::even_water()), map_, model()};
  acoustics::Modem modem_;
};

TEST_P(BottomContinuity, TheLevelMovesByNoMoreThanAFifthOfADecibelInATenthOfAMetre) {
  const Vec3 still(1400, 60, 55);
  for (const bool moving_is_first : {true, false}) {
    double last_db = 0, lowest_db = 1000, highest_db = 0;
    std::size_t last_count = 0;
    int compared = 0;
    for (int step = 0; step < 800; ++step) {
      const Vec3 place = GetParam().from + 0.1 * step * GetParam().way;
      const Vec3 &first = moving_is_first ? place : still, &last = moving_is_first ? still : place;
      testing::survey(*map_, first, last, GetParam().seabed_z_m);
      const Reception reception =
          rays_.reception(at_s(0), {1, first, Vec3::Zero(), &modem_}, {2, last, Vec3::Zero(), &modem_});
      const double level_db = reception.budget.received_level.value;
      if (step > 0 && reception.paths.size() == last_count) {
        ++compared;
        EXPECT_NEAR(level_db, last_db, 0.2)
            << "step " << step << (moving_is_first ? " of the first end" : "");
      }
      last_db = level_db;
      last_count = reception.paths.size();
      lowest_db = std::min(lowest_db, level_db);
      highest_db = std::max(highest_db, level_db);
    }
    EXPECT_GT(compared, 780);
    EXPECT_GT(highest_db - lowest_db, 0.1) << "nothing changed: not much of a test";
  }
}

INSTANTIATE_TEST_SUITE_P(Channel, BottomContinuity,
                         ::testing::Values(Course{wide_hill, {0, 0, 30}, {1, 0, 0}},
                                           Course{wide_hill, {0, -400, 30}, {0.2, 0.98, 0}},
                                           Course{wide_hill, {-300, -200, 20}, {0.7, 0.7, 0.05}},
                                           Course{narrow_hill, {0, -400, 30}, {0.2, 0.98, 0}},
                                           Course{narrow_hill, {600, 300, 30}, {-0.7, -0.7, 0}},
                                           Course{slope, {0, 0, 30}, {1, 0, 0}},
                                           Course{slope, {0, -400, 30}, {0.2, 0.98, 0}}));

}  // namespace
}  // namespace halocline::channel_server

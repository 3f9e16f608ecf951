// While a vehicle moves, the level of its links changes as little as the vehicle moves: the bottom under a link is a
// continuous function of its ends.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/modem/modem.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "core/frames.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

// A hill of 30 m in 100 m of water, 300 m wide.
double hill(const Vec3& place) {
  const double north = place.x() - 700, east = place.y() + 40;
  return 100 - 30 * std::exp(-(north * north + east * east) / (2 * 300.0 * 300.0));
}
double slope(const Vec3& place) { return 100 - 0.03 * place.x() + 0.02 * place.y(); }
double level(const Vec3&) { return 100; }

TEST(BottomContinuity, Experiment) {
  const char* steps_text = std::getenv("SCAN_STEPS");
  const int steps = steps_text ? std::atoi(steps_text) : 2000;
  const char* spacing = std::getenv("SCAN_SPACING");
  const acoustics::Modem modem;
  struct Case { const char* name; double (*seabed)(const Vec3&); Vec3 from, way; };
  for (const Case& c : {Case{"hill along", hill, {0, 0, 30}, {1, 0, 0}}, Case{"hill across", hill, {0, -400, 30}, {0.2, 0.98, 0}},
                        Case{"hill oblique down", hill, {-300, -200, 20}, {0.7, 0.7, 0.05}},
                        Case{"slope along", slope, {0, 0, 30}, {1, 0, 0}}, Case{"slope across", slope, {0, -400, 30}, {0.2, 0.98, 0}},
                        Case{"level", level, {0, -400, 30}, {0.2, 0.98, 0}}}) {
    for (const bool moving_is_low : {true, false}) {
      auto map = std::make_shared<SeabedMap>(SeabedRule{.spacing_m = spacing ? std::atof(spacing) : 25});
      RayModel model;
      model.options.max_bounces = 60;
      model.options.min_boundary_factor = std::pow(10.0, -30 / 20.0);
      RayPropagation rays(std::make_shared<EnvironmentTimeline>(testing::even_water()), map, model);
      const Vec3 fixed(1400, 60, 55);
      std::vector<double> jumps;
      double last_db = 0, worst = 0; std::size_t last_count = 0; int at = 0;
      for (int i = 0; i < steps; ++i) {
        const Vec3 place = c.from + 0.1 * i * c.way;
        const Vec3 &low = moving_is_low ? place : fixed, &high = moving_is_low ? fixed : place;
        testing::survey(*map, low, high, c.seabed);
        const Reception r = rays.reception(at_s(0), {1, low, Vec3::Zero(), &modem}, {2, high, Vec3::Zero(), &modem});
        const double db = r.budget.received_level.value;
        if (i > 0 && r.paths.size() == last_count) {
          jumps.push_back(std::abs(db - last_db));
          if (jumps.back() > worst) { worst = jumps.back(); at = i; }
        }
        last_db = db; last_count = r.paths.size();
      }
      std::sort(jumps.begin(), jumps.end());
      std::printf("%-18s %s: %zu of %d steps, median %.5f, 99%% %.4f, max %.4f at %d dB; above 0.2: %ld, tiles %zu\n", c.name, moving_is_low ? "low " : "high",
                  jumps.size(), steps, jumps[jumps.size() / 2], jumps[jumps.size() * 99 / 100], jumps.back(), at,
                  jumps.end() - std::upper_bound(jumps.begin(), jumps.end(), 0.2), map->tiles_kept());
    }
  }
}

}  // namespace
}  // namespace halocline::channel_server

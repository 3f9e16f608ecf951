#include "channel_server/propagation/ray_limits.h"

#include <algorithm>
#include <cmath>

namespace halocline::channel_server {

int bounces_for(double range_m, double depth_m) {
  constexpr double kLeast = 60, kMost = 10'000, kSlope = 0.6;
  const double bounces = std::ceil(kSlope * range_m / depth_m);
  return static_cast<int>(std::clamp(bounces, kLeast, kMost));
}

double mean_depth_m(const acoustics::BottomProfile& bottom, double range_m) {
  constexpr int kPlaces = 16;
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) sum += bottom.depth_at(range_m * (i + 0.5) / kPlaces);
  return sum / kPlaces;
}

std::optional<acoustics::RaySolver> usable_solver(std::optional<acoustics::RaySolver> wanted,
                                                  const acoustics::RaySea& sea,
                                                  const acoustics::RayLink& link) {
  using Solver = acoustics::RaySolver;
  const Solver simplest = choose_solver(sea, link);
  if (!wanted || *wanted == Solver::kArcs || simplest == Solver::kImages) return wanted;
  return *wanted == Solver::kSnell && simplest == Solver::kSnell ? wanted : simplest;
}

Decibels gain_beyond_powers(const RayModel& model, const acoustics::Environment& environment) {
  double gain_db = 0;
  if (model.coherent) {
    gain_db += 10;
  } else if (model.fading.enabled) {
    gain_db += 3;
  }
  if (model.reverberation.enabled) gain_db += 10;
  if (environment.spreading_exponent < 1.5) gain_db += 6;
  return Decibels{gain_db};
}

// Each count takes its low bits.
std::uint64_t number_of(const acoustics::PathIdentity& identity) {
  std::uint64_t number = identity.launched_up ? 1 : 0;
  for (const int count :
       {identity.surface_bounces, identity.bottom_bounces, identity.upper_turns, identity.lower_turns}) {
    number = number << 14 | (static_cast<std::uint64_t>(count) & 0x3FFF);
  }
  return number << 7 | (static_cast<std::uint64_t>(identity.branch) & 0x7F);
}

}  // namespace halocline::channel_server

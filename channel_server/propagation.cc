#include "channel_server/propagation.h"

#include <algorithm>
#include <cmath>

#include "acoustics/ray_doppler.h"

namespace halocline::channel_server {
namespace {

// Positive down, from one point to another; 0 between equal points.
double angle_down(const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  return std::atan2(way.z(), std::hypot(way.x(), way.y()));
}

}  // namespace

std::size_t first_significant(const std::vector<SoundPath>& paths) {
  const auto strongest = std::max_element(
      paths.begin(), paths.end(), [](const SoundPath& a, const SoundPath& b) { return a.level < b.level; });
  const Decibels least = strongest->level - kSignificantBelowStrongest;
  const auto first =
      std::find_if(paths.begin(), strongest, [&](const SoundPath& path) { return path.level >= least; });
  return static_cast<std::size_t>(first - paths.begin());
}

double delay_spread_s(const std::vector<SoundPath>& paths) {
  if (paths.size() < 2) return 0;
  const SoundPath& first = paths[first_significant(paths)];
  Decibels strongest = first.level;
  for (const SoundPath& path : paths) strongest = std::max(strongest, path.level);
  const auto last = std::find_if(paths.rbegin(), paths.rend(), [&](const SoundPath& path) {
    return path.level >= strongest - kSignificantBelowStrongest;
  });
  return last->delay_s - first.delay_s;
}

Decibels total_level(const std::vector<SoundPath>& paths) {
  PowerRatio sum;
  for (const SoundPath& path : paths) sum = sum + to_power_ratio(path.level);
  return sum.value > 0 ? std::max(to_decibels(sum), kSilence) : kSilence;
}

StraightPropagation::StraightPropagation(acoustics::Environment environment, std::size_t most_models)
    : environment_(std::move(environment)), most_models_(most_models) {
  validate(environment_);
}

// The same integral of ds / c as LinkModel's: it knows no modem, so none is needed.
double StraightPropagation::delay_s(SimTime, const LinkEnd& from, const LinkEnd& to) {
  const double surface_m = environment_.sea_surface_z_m;
  return environment_.profile.travel_time_s(depth_below_surface_m(from.position_ned_m, surface_m),
                                            depth_below_surface_m(to.position_ned_m, surface_m),
                                            (to.position_ned_m - from.position_ned_m).norm());
}

Reception StraightPropagation::reception(SimTime, const LinkEnd& from, const LinkEnd& to) {
  Reception reception;
  reception.budget = model_of(*from.modem, *to.modem).budget(from.position_ned_m, to.position_ned_m);
  reception.paths = {straight_path(reception.budget, from, to)};
  return reception;
}

SoundPath StraightPropagation::straight_path(const acoustics::LinkBudget& budget, const LinkEnd& from,
                                             const LinkEnd& to) const {
  const double angle = angle_down(from.position_ned_m, to.position_ned_m);
  const Vec3 along = acoustics::ray_direction(from.position_ned_m, to.position_ned_m, angle);
  SoundPath path;
  path.delay_s = budget.delay_s;
  path.level = budget.received_level;
  path.doppler_factor =
      acoustics::doppler_factor(from.velocity_ned_mps.dot(along), sound_speed_mps(from.position_ned_m),
                                to.velocity_ned_mps.dot(along), sound_speed_mps(to.position_ned_m));
  path.launch_angle_rad = path.arrival_angle_rad = angle;
  return path;
}

// Above the surface and below the deepest water, the speed of these.
double StraightPropagation::sound_speed_mps(const Vec3& position_ned_m) const {
  const double depth_m = depth_below_surface_m(position_ned_m, environment_.sea_surface_z_m);
  return environment_.profile.sound_speed_mps(std::clamp(depth_m, 0.0, acoustics::kDeepestWater));
}

bool StraightPropagation::echo_is_receivable(const acoustics::Modem& transmitter,
                                             const acoustics::Modem& receiver, const Vec3& from_ned_m,
                                             const Vec3& to_ned_m,
                                             const std::vector<acoustics::BottomPoint>& points) {
  return assess_echoes(model_of(transmitter, receiver), from_ned_m, to_ned_m, points).likelihood ==
         acoustics::EchoLikelihood::kLikely;
}

StraightPropagation::ModemKey StraightPropagation::key_of(const acoustics::Modem& modem) {
  return {modem.source_level.value,       modem.least_receivable_level.value,
          modem.centre_frequency_hz,      modem.bandwidth_hz,
          modem.directivity_index.value,  modem.bit_rate_bps,
          modem.packet_overhead.seconds()};
}

const acoustics::LinkModel& StraightPropagation::model_of(const acoustics::Modem& transmitter,
                                                          const acoustics::Modem& receiver) {
  const PairKey key{key_of(transmitter), key_of(receiver)};
  auto kept = models_.find(key);
  if (kept == models_.end()) {
    auto model = std::make_unique<acoustics::LinkModel>(environment_, transmitter, receiver);
    if (models_.size() >= most_models_) make_room();
    kept = models_.emplace(key, KeptModel{std::move(model)}).first;
  }
  kept->second.asked_last = ++questions_;
  return *kept->second.model;
}

void StraightPropagation::make_room() {
  models_.erase(std::min_element(models_.begin(), models_.end(), [](const auto& a, const auto& b) {
    return a.second.asked_last < b.second.asked_last;
  }));
}

}  // namespace halocline::channel_server

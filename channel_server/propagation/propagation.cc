#include "channel_server/propagation/propagation.h"

#include <algorithm>
#include <utility>

#include "acoustics/link/ray_doppler.h"
#include "acoustics/modem/beam_pattern.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

SoundPath straight_path(const acoustics::Environment& water, const acoustics::LinkBudget& budget,
                        const LinkEnd& from, const LinkEnd& to) {
  const double angle = acoustics::angle_down_rad(from.position_ned_m, to.position_ned_m);
  const Vec3 along = acoustics::ray_direction(from.position_ned_m, to.position_ned_m, angle);
  SoundPath path;
  path.delay_s = budget.delay_s;
  path.level = budget.received_level;
  path.doppler_factor =
      acoustics::doppler_factor(from.velocity_ned_mps.dot(along), sound_speed_at(water, from.position_ned_m),
                                to.velocity_ned_mps.dot(along), sound_speed_at(water, to.position_ned_m));
  path.launch_angle_rad = path.arrival_angle_rad = angle;
  return path;
}

template <class Counts>
Decibels summed_level(const std::vector<SoundPath>& paths, const Counts& counts) {
  PowerRatio sum;
  for (const SoundPath& path : paths) {
    if (counts(path)) sum = sum + to_power_ratio(path.level);
  }
  return sum.value > 0 ? std::max(to_decibels(sum), kSilence) : kSilence;
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
  return summed_level(paths, [](const SoundPath&) { return true; });
}

std::size_t number_of_paths(const std::vector<SoundPath>& paths) {
  return static_cast<std::size_t>(
      std::count_if(paths.begin(), paths.end(), [](const SoundPath& path) { return !path.diffuse; }));
}

Decibels diffuse_level(const std::vector<SoundPath>& paths) {
  return summed_level(paths, [](const SoundPath& path) { return path.diffuse; });
}

double sound_speed_at(const acoustics::Environment& environment, const Vec3& position_ned_m) {
  const double depth_m = depth_below_surface_m(position_ned_m, environment.sea_surface_z_m);
  return environment.profile.sound_speed_mps(std::clamp(depth_m, 0.0, acoustics::kDeepestWater));
}

LinkTracks Propagation::tracks(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  const Reception reception = this->reception(at, from, to);
  const acoustics::LinkBudget& budget = reception.budget;
  const double surface_z_m = environment(at).sea_surface_z_m;
  const Vec3 way = to.position_ned_m - from.position_ned_m;
  LinkTracks tracks{.link = {depth_below_surface_m(from.position_ned_m, surface_z_m),
                             depth_below_surface_m(to.position_ned_m, surface_z_m),
                             elementary::hypot(way.x(), way.y())}};
  for (const SoundPath& path : reception.paths) {
    PathTrack track{.path = path, .length_m = budget.range_m};
    track.absorption_db = budget.absorption_db_per_km * budget.range_m / 1000;
    track.beam_db =
        (from.modem->beam.loss(path.launch_angle_rad) + to.modem->beam.loss(-path.arrival_angle_rad)).value;
    track.spreading_db = (from.modem->source_level - path.level).value - track.absorption_db - track.beam_db;
    if (!reception.measured)
      track.points = {{0, tracks.link.source_depth_m}, {tracks.link.range_m, tracks.link.receiver_depth_m}};
    tracks.paths.push_back(std::move(track));
  }
  tracks.paths_left_out = keep_strongest(tracks.paths);
  weigh(reception.paths, *to.modem, tracks);
  return tracks;
}

std::vector<Reception> Propagation::receptions(SimTime at, const std::vector<EndPair>& links,
                                               const ForEach&) {
  std::vector<Reception> receptions;
  for (const EndPair& link : links) receptions.push_back(reception(at, link.from, link.to));
  return receptions;
}

Reception Propagation::reception_over(SimTime, const LinkEnd&, const LinkEnd&,
                                      const std::shared_ptr<const SeabedProfile>&) {
  ensure(false, "reception_over() of a propagation without a bottom");
  return {};
}

StraightPropagation::StraightPropagation(acoustics::Environment environment, std::size_t max_kernels)
    : StraightPropagation(std::make_shared<const EnvironmentTimeline>(std::move(environment)),
                          acoustics::FadingModel(), max_kernels) {}

StraightPropagation::StraightPropagation(std::shared_ptr<const EnvironmentTimeline> waters,
                                         const acoustics::FadingModel& fading, std::size_t max_kernels)
    : waters_(std::move(waters)), fading_(fading), kernels_(max_kernels) {}

Reception StraightPropagation::along_line(const acoustics::LinkKernel& kernel,
                                          const acoustics::Environment& water, const EndPair& ends,
                                          acoustics::Capacity capacity) const {
  const auto& [from, to] = ends;
  Reception reception;
  reception.budget = kernel.budget(from.position_ned_m, to.position_ned_m, capacity);
  SoundPath path = straight_path(water, reception.budget, from, to);
  path.fading = path_fading(fading_, water.noise.wind_mps, from.modem->centre_frequency_hz, 0, 0);
  reception.paths = {path};
  return reception;
}

// The cache of kernels is read in turn; links are shared out.
std::vector<Reception> StraightPropagation::receptions(SimTime at, const std::vector<EndPair>& links,
                                                       const ForEach& for_each) {
  std::vector<std::shared_ptr<const acoustics::LinkKernel>> kernels;
  for (const auto& [from, to] : links) kernels.push_back(kernel_of(at, *from.modem, *to.modem));
  const acoustics::Environment& water = waters_->at(at);
  std::vector<Reception> receptions(links.size());
  for_each(links.size(), [&](std::size_t i) {
    receptions[i] = along_line(*kernels[i], water, links[i], acoustics::Capacity::kComputed);
  });
  return receptions;
}

Reception StraightPropagation::blocked(SimTime at, const LinkEnd& from, const LinkEnd& to) {
  Reception reception;
  reception.state = PathState::kBlocked;
  const double distance_m = (to.position_ned_m - from.position_ned_m).norm();
  reception.budget =
      kernel_of(at, *from.modem, *to.modem)
          ->budget_of_path(from.position_ned_m, to.position_ned_m, from.modem->source_level - kSilence,
                           distance_m, acoustics::Capacity::kComputed);
  reception.budget.receivable = false;
  return reception;
}

bool StraightPropagation::echo_is_receivable(SimTime at, const acoustics::Modem& transmitter,
                                             const acoustics::Modem& receiver, const Vec3& from_ned_m,
                                             const Vec3& to_ned_m,
                                             const std::vector<acoustics::BottomPoint>& points) {
  return assess_echoes(*kernel_of(at, transmitter, receiver), from_ned_m, to_ned_m, points).likelihood ==
         acoustics::EchoLikelihood::kLikely;
}

StraightPropagation::ModemKey StraightPropagation::key_of(const acoustics::Modem& modem) {
  std::vector<double> beam;
  for (const acoustics::BeamRow& row : modem.beam.rows()) {
    beam.insert(beam.end(), {row.elevation_rad, row.loss_db});
  }
  const std::array<double, 5> numbers{modem.source_level.value, modem.min_receivable_level.value,
                                      modem.centre_frequency_hz, modem.bandwidth_hz,
                                      modem.directivity_index.value};
  return {numbers, std::move(beam), modem.family};
}

std::shared_ptr<const acoustics::LinkKernel> StraightPropagation::kernel_of(
    SimTime at, const acoustics::Modem& transmitter, const acoustics::Modem& receiver) {
  const EnvironmentTimeline::WaterId water = waters_->water_at(at);
  if (last_ && water == last_water_ && last_->transmitter() == transmitter && last_->receiver() == receiver)
    return last_;
  last_ = kernels_.find_or_make({water, key_of(transmitter), key_of(receiver)}, [&] {
    return std::make_shared<const acoustics::LinkKernel>(waters_->at(at), transmitter, receiver);
  });
  last_water_ = water;
  return last_;
}

}  // namespace halocline::channel_server

#include "acoustics/rays/profile_path.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "acoustics/math/fold_field.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kFarOff = 1e-2;         // m of unfolded depth: a ray further off did not converge
constexpr double kBesideGrazing = 1e-9;  // rad

constexpr double kMinTube = 1e-9;  // m, of |q|: a ray on a caustic to rounding

constexpr double kLeastFoldShare = 0.5;  // of the way from a fold to its rays, as foreseen
constexpr double kFoldStep = 1e-4;       // rad: to the rays that show how a fold bends

bool is_kept(const ArcTracer& tracer, const TracedRay& ray) {
  const RayOptions& options = tracer.sea().options;
  return ray.arrived && ray.factor >= options.min_boundary_factor &&
         ray.surface_bounces + ray.bottom_bounces <= options.max_bounces;
}

double cosine_of(const TracedRay& ray) { return std::sqrt(1 - ray.sine * ray.sine); }

// `tube`: |q|, m.
Arrival arrival_of(const ArcTracer& tracer, const TracedRay& ray, const TracedDetails& details, double target,
                   double tube) {
  // A^2 = c_r cos_s / (c_s r |q|) (Jensen and others 2011, section 3.3).
  const double speed = cosine_of(ray) / ray.xi;
  Arrival path;
  // The receiver is not quite where the ray is: a front of slowness sin / c moves over the difference.
  const double down = (ray.surface_bounces + ray.bottom_bounces) % 2 == 0 ? 1 : -1;
  path.delay_s = details.delay_s + ray.sine / speed * down * (target - ray.zeta);
  path.amplitude = ray.factor * std::sqrt(speed * std::cos(ray.theta) /
                                          (tracer.source_speed_mps() * tracer.range_m() * tube));
  const double phase = pi * (ray.surface_bounces % 2) + details.bottom_phase_rad + ray.caustics * pi / 2;
  path.phase_rad = phase - 2 * pi * std::floor(phase / (2 * pi));
  path.launch_angle_rad = ray.theta;
  path.launch_slowness_spm = std::cos(ray.theta) / tracer.source_speed_mps();
  path.range_slowness_spm = details.slowness_over_range / tracer.range_m();
  path.arrival_angle_rad = std::asin(ray.sine);
  path.path_length_m = details.length_m;
  path.absorption_db = details.absorption_db;
  path.surface_loss_db = details.surface_loss_db;
  path.bottom_loss_db = details.bottom_loss_db;
  path.surface_sine_squares = details.surface_sine_squares;
  path.bottom_sine_squares = details.bottom_sine_squares;
  path.surface_bounces = ray.surface_bounces;
  path.bottom_bounces = ray.bottom_bounces;
  path.caustics = ray.caustics;
  path.identity = {ray.theta < 0,   ray.surface_bounces, ray.bottom_bounces,
                   ray.upper_turns, ray.lower_turns,     0};
  return path;
}

}  // namespace

std::optional<ProfilePath> profile_path(const ArcTracer& tracer, double theta, double target) {
  TracedRay ray;
  TracedDetails details;
  tracer.trace(theta, ray, &details);
  if (!is_kept(tracer, ray) || std::abs(ray.zeta - target) > kFarOff) return std::nullopt;
  return ProfilePath{arrival_of(tracer, ray, details, target, std::max(std::abs(ray.q), kMinTube)), target};
}

void ProfileFolds::note(double theta) {
  TracedRay before, ray, after;
  TracedDetails details;
  tracer_.trace(theta, ray, &details);
  if (!is_kept(tracer_, ray)) return;
  tracer_.trace(theta - kFoldStep, before);
  tracer_.trace(theta + kFoldStep, after);
  if (!before.arrived || !after.arrived) return;
  if (before.family != ray.family || after.family != ray.family) return;
  const auto slowness = [](const TracedRay& one) { return one.sine * one.xi / cosine_of(one); };
  // In the plane of unfolded depth, slowness sin / c.
  const Fold fold{(after.zeta_slope - before.zeta_slope) / (2 * kFoldStep),
                  (slowness(after) - slowness(before)) / (2 * kFoldStep)};
  ray.caustics = std::min(before.caustics, after.caustics);
  const double frequency = tracer_.sea().options.frequency_hz, period = 2 * tracer_.bottom_at_receiver_m();
  for (const double image : {tracer_.receiver_depth_m(), -tracer_.receiver_depth_m()}) {
    const double target = image + std::round((ray.zeta - image) / period) * period, off = target - ray.zeta;
    const double x = off / std::copysign(fold.length_m(frequency), fold.curvature);
    if (x < kDarkFold || x > kLitFold) continue;
    Arrival path = arrival_of(tracer_, ray, details, target, cosine_of(ray) * fold.tube_slope(x, frequency));
    path.phase_rad = std::fmod(path.phase_rad + pi / 4, 2 * pi);  // of the caustic half way through it
    found_.push_back({path, target, x, std::sqrt(2 * std::abs(off / fold.curvature))});
  }
}

// Delays and tubes of rays over a bent bottom do not agree closely enough to derive from them where a fold is.
std::vector<Arrival> ProfileFolds::finished(const std::vector<ProfilePath>& paths) const {
  std::vector<Arrival> arrivals;
  arrivals.reserve(paths.size() + found_.size());
  for (const ProfilePath& path : paths) arrivals.push_back(path.arrival);
  std::vector<FoldMember> members(paths.size());
  std::uint64_t family = kNoFamily;
  for (const Found& found : found_) {
    if (found.x <= 0) {
      arrivals.push_back(found.path);
      continue;
    }
    // The rays of the same image on both sides, about as far from the fold as they should be.
    std::optional<std::size_t> below, above;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (paths[i].target != found.target || members[i].family != kNoFamily) continue;
      const double off = arrivals[i].launch_angle_rad - found.path.launch_angle_rad;
      const double share = std::abs(off) / found.to_rays_rad;
      if (share > kLeastFoldShare && share < 1 / kLeastFoldShare) (off < 0 ? below : above) = i;
    }
    if (!below || !above) continue;
    const bool is_one = found.x < kMergedFold;
    members[*below] = {++family, arrivals[*below].launch_angle_rad, found.x};
    members[*above] = {is_one ? ++family : family, arrivals[*above].launch_angle_rad, found.x};
    if (!is_one) continue;
    arrivals[*below] = found.path;
    arrivals[*above].amplitude = 0;
  }
  members.resize(arrivals.size());
  finish(arrivals, members, tracer_.sea().options);
  return arrivals;
}

std::vector<double> fan_angles(const ArcTracer& tracer, double steepest) {
  const double limit = std::min(steepest, tracer.sea().options.max_launch_angle_rad);
  std::vector<double> angles;
  const auto add_both = [&angles](double theta) {
    angles.push_back(theta);
    angles.push_back(-theta);
  };
  // Steps grow with the angle: 0.6 degrees near the horizontal, 4 at 60.
  for (double theta = 0.005; theta < limit; theta += 0.01 + 0.06 * theta) add_both(theta);
  add_both(limit);
  const RayWater& water = tracer.sea().water;
  for (std::size_t i = 0; i < water.speeds_mps().size(); ++i) {
    if (i > 0 && water.depths_m()[i - 1] > tracer.sea().profile.deepest_m()) break;
    const double cosine = tracer.source_speed_mps() / water.speeds_mps()[i];
    if (cosine >= 1 || cosine < std::cos(limit)) continue;
    add_both(std::acos(cosine) - kBesideGrazing);
    add_both(std::acos(cosine) + kBesideGrazing);
  }
  if (limit < steepest) {
    for (int i = 1; i <= 8; ++i) add_both(limit + (steepest - limit) * i / 8);
  }
  std::sort(angles.begin(), angles.end());
  std::erase_if(angles, [steepest](double theta) { return theta <= -steepest || theta > steepest; });
  return angles;
}

double leave_out_core(const ArcTracer& tracer, std::vector<double>& angles) {
  const double core = tracer.sea().core_speed_mps;
  if (core <= tracer.source_speed_mps()) return 0;
  const double edge = std::acos(tracer.source_speed_mps() / core);
  std::erase_if(angles, [edge](double theta) { return std::abs(theta) < edge; });
  angles.insert(std::upper_bound(angles.begin(), angles.end(), 0.0), {-edge, edge});
  return edge;
}

}  // namespace halocline::acoustics

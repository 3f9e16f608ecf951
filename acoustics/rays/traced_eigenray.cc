// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/traced_eigenray.h"

#include <queue>
#include <utility>

#include "acoustics/sea/ray_water.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kFarOff = 1e-2;         // m of unfolded depth: a ray further off has not converged
constexpr double kBesideGrazing = 1e-9;  // rad: distance of the two rays of a fan from one that grazes a knot

constexpr double kMinTube = 1e-9;  // m, of |q|: a ray on a caustic, to rounding

// Least and, inverted, greatest share of the predicted distance from a fold to its rays.
constexpr double kMinFoldShare = 0.5;
constexpr double kFoldMargin = 1.25;  // factor on the Airy length
constexpr double kFoldStep = 1e-4;    // rad: distance of the rays that give the curvature of a fold

constexpr int kDiffuseBounces = 16'383;  // more than RayOptions::max_bounces allows

constexpr double kSimplifiedWithin = 0.05;  // m
constexpr double kTouched = 1e-3;           // m: a point this close to a boundary is a bounce
// Metres of depth at the receiver: a ray with other turns and a greater error is not the path.
constexpr double kMissed = 1;

// The point of a polyline between two others that lies furthest from the line through them.
struct Detour {
  double off_m;
  std::size_t at, first, last;
  bool operator<(const Detour& other) const {
    return off_m != other.off_m ? off_m < other.off_m : at > other.at;
  }
};

Detour greatest_detour(const std::vector<RayPoint>& points, std::size_t first, std::size_t last) {
  const RayPoint &a = points[first], &b = points[last];
  const double slope = b.range_m > a.range_m ? (b.depth_m - a.depth_m) / (b.range_m - a.range_m) : 0;
  Detour greatest{-1, first, first, last};
  for (std::size_t i = first + 1; i < last; ++i) {
    const double off = std::abs(points[i].depth_m - a.depth_m - slope * (points[i].range_m - a.range_m));
    if (off > greatest.off_m) greatest = {off, i, first, last};
  }
  return greatest;
}

// A course of straight lines from bounce to bounce, all at the same angle: the image sources of a flat sea
// (acoustics/rays/image_rays.h).
std::vector<RayPoint> straight_way(double bottom_m, const RayLink& link, const Eigenray& path) {
  std::vector<double> depths{link.source_depth_m};
  bool up = path.surface_bounces != path.bottom_bounces ? path.surface_bounces > path.bottom_bounces
                                                        : path.launch_angle_rad < 0;
  for (int i = path.surface_bounces + path.bottom_bounces; i > 0; --i, up = !up)
    depths.push_back(up ? 0 : bottom_m);
  depths.push_back(link.receiver_depth_m);
  double height = 0, gone = 0;
  for (std::size_t i = 1; i < depths.size(); ++i) height += std::abs(depths[i] - depths[i - 1]);
  std::vector<RayPoint> way{{0, depths[0]}};
  for (std::size_t i = 1; i < depths.size(); ++i) {
    gone += std::abs(depths[i] - depths[i - 1]);
    way.push_back({height > 0 ? link.range_m * gone / height : link.range_m, depths[i]});
  }
  return way;
}

// The course of the ray of the same launch angle, up to the place nearest to the receiver at which it passes
// the receiver's depth after the same bounces, with all ranges scaled so that it ends at the link's range.
// Needed because the wave field of rays that graze a boundary or turn beside a knot changes their range
// (acoustics/math/turning_field.h). Empty over a bottom that is not level.
std::optional<std::vector<RayPoint>> scaled_way(const ProfiledSea& sea, const RayLink& link,
                                                const Eigenray& path) {
  constexpr double kLonger = 1.5;
  RayLink far = link;
  far.range_m *= kLonger;
  if (!sea.profile.is_flat_until(far.range_m)) return std::nullopt;
  std::vector<RayPoint> way{{0, link.source_depth_m}};
  RayTrace ray;
  TraceDetails details;
  details.track = &way;
  ArcTracer(sea, far).trace(path.launch_angle_rad, ray, &details);
  const bool comes_down = path.arrival_angle_rad > 0;
  std::size_t end = 0;
  double end_range = 0;
  int surface = 0, bottoms = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const RayPoint &a = way[i - 1], &b = way[i];
    const double above = link.receiver_depth_m - a.depth_m, down = b.depth_m - a.depth_m;
    const bool passes = (down > 0) == comes_down && above / down >= 0 && above / down <= 1;
    if (passes && surface == path.surface_bounces && bottoms == path.bottom_bounces) {
      const double range = a.range_m + above / down * (b.range_m - a.range_m);
      if (end == 0 || std::abs(range - link.range_m) < std::abs(end_range - link.range_m)) {
        end = i;
        end_range = range;
      }
    }
    if (b.depth_m < kTouched) ++surface;
    if (b.depth_m > sea.profile.depth_at(0) - kTouched) ++bottoms;
  }
  if (end == 0) return std::nullopt;
  way.resize(end + 1);
  for (RayPoint& point : way) point.range_m *= link.range_m / end_range;
  return way;
}

bool is_kept(const ArcTracer& tracer, const RayTrace& ray) {
  const RayOptions& options = tracer.sea().options;
  return ray.arrived && ray.factor >= options.min_boundary_factor &&
         ray.surface_bounces + ray.bottom_bounces <= options.max_bounces;
}

double cosine_of(const RayTrace& ray) { return std::sqrt(1 - ray.sine * ray.sine); }

}  // namespace

Eigenray eigenray_of(const ArcTracer& tracer, const RayTrace& ray, const TraceDetails& details,
                     const TubeEnd& end) {
  // A^2 = c_r cos_s / (c_s r |q|) (Jensen and others 2011, section 3.3).
  const double speed = cosine_of(ray) / ray.xi;
  Eigenray path = details;
  // The ray passes close to the receiver but not through it. A wavefront of vertical slowness sin / c covers
  // the difference:
  //   tau = tau_ray + sin / c (target - zeta), with its sign reversed on an odd number of bounces
  const double down = (ray.surface_bounces + ray.bottom_bounces) % 2 == 0 ? 1 : -1;
  path.delay_s += ray.sine / speed * down * (end.target_m - ray.zeta);
  path.amplitude = ray.factor * std::sqrt(speed * elementary::cos(ray.theta) /
                                          (tracer.source_speed_mps() * end.range_m * end.tube_m));
  path.phase_rad = positive_angle(pi * (ray.surface_bounces % 2) + details.phase_rad + ray.caustics * pi / 2);
  path.launch_angle_rad = ray.theta;
  path.launch_slowness_spm = elementary::cos(ray.theta) / tracer.source_speed_mps();
  path.range_slowness_spm = details.slowness_over_range / end.range_m;
  path.arrival_angle_rad = elementary::asin(ray.sine);
  path.surface_bounces = ray.surface_bounces;
  path.bottom_bounces = ray.bottom_bounces;
  path.caustics = ray.caustics;
  path.identity = {ray.theta < 0,   ray.surface_bounces, ray.bottom_bounces,
                   ray.upper_turns, ray.lower_turns,     0};
  return path;
}

std::optional<ImageHit> image_hit(const ArcTracer& tracer, double theta, double target) {
  RayTrace ray;
  TraceDetails details;
  tracer.trace(theta, ray, &details);
  if (!is_kept(tracer, ray) || std::abs(ray.zeta - target) > kFarOff) return std::nullopt;
  return ImageHit{
      eigenray_of(tracer, ray, details, {tracer.range_m(), target, std::max(std::abs(ray.q), kMinTube)}),
      target, ray.zeta_slope, ray.family};
}

// The counts of bounces exceed those of any path, so no path has this identity.
PathIdentity diffuse_identity(double theta, std::size_t window) {
  return {theta < 0, kDiffuseBounces, kDiffuseBounces, 0, static_cast<int>(window), 0};
}

std::optional<DiffuseRay> diffuse_ray(const ArcTracer& tracer, double theta, std::size_t window) {
  RayTrace ray;
  TraceDetails details;
  tracer.trace(theta, ray, &details);
  if (!ray.arrived) return std::nullopt;
  Eigenray path = eigenray_of(tracer, ray, details, {tracer.range_m(), ray.zeta, 1});
  path.phase_rad = 0;
  path.diffuse = true;
  path.identity = diffuse_identity(ray.theta, window);
  return DiffuseRay{path, ray.xi};
}

double ProfileFolds::length_m(const Fold& fold) const {
  const RayOptions& options = tracer_.sea().options;
  if (!options.airy_folds) return 0;
  return std::min(kFoldMargin * fold.length_m(options.frequency_hz),
                  kNearFold * tracer_.bottom_at_receiver_m() / -kDarkFold);
}

void ProfileFolds::note(double theta) {
  tracer_.trace(theta - kFoldStep, before_);
  if (!before_.arrived) return;
  tracer_.trace(theta + kFoldStep, after_);
  if (!after_.arrived || before_.family != after_.family) return;
  const auto slowness = [](const RayTrace& one) { return one.sine * one.xi / cosine_of(one); };
  // The fold in the coordinate u = unfolded depth, with the slowness p = sin / c.
  const Fold fold{(after_.zeta_slope - before_.zeta_slope) / (2 * kFoldStep),
                  (slowness(after_) - slowness(before_)) / (2 * kFoldStep)};
  // The fold's place from the cubic between the two rays; the ray between them lies off the turn by
  // slope^2 / (2 curvature).
  const double slope = 0.5 * (before_.zeta_slope + after_.zeta_slope);
  const double turn = 0.5 * (before_.zeta + after_.zeta) - fold.curvature * kFoldStep * kFoldStep / 2 -
                      0.5 * slope * slope / fold.curvature;
  const double frequency = tracer_.sea().options.frequency_hz, period = 2 * tracer_.bottom_at_receiver_m();
  for (const double image : {tracer_.receiver_depth_m(), -tracer_.receiver_depth_m()}) {
    const double target = image + std::round((turn - image) / period) * period, off = target - turn;
    const double x = off / std::copysign(fold.length_m(frequency), fold.curvature);
    if (x < kDarkFold || x > kLitFold) continue;
    RayTrace ray;
    TraceDetails details;
    tracer_.trace(theta, ray, &details);
    if (!is_kept(tracer_, ray) || ray.family != before_.family) continue;
    ray.caustics = std::min(before_.caustics, after_.caustics);
    Eigenray path = eigenray_of(tracer_, ray, details,
                                {tracer_.range_m(), target, cosine_of(ray) * fold.tube_slope(x, frequency)});
    path.phase_rad = std::fmod(path.phase_rad + pi / 4, 2 * pi);  // half of the caustic's pi / 2
    found_.push_back({path, target, x, std::sqrt(2 * std::abs(off / fold.curvature))});
  }
}

// Pairs the rays of each fold with it. Delays and tubes of rays over a bent bottom do not agree closely
// enough to derive the place of a fold from them.
std::vector<Eigenray> ProfileFolds::finished(const std::vector<ImageHit>& paths) const {
  std::vector<Eigenray> eigenrays;
  eigenrays.reserve(paths.size() + found_.size());
  for (const ImageHit& path : paths) eigenrays.push_back(path.eigenray);
  std::vector<FoldMember> members(paths.size());
  std::uint64_t family = kNoFamily;
  for (const Found& found : found_) {
    if (found.x <= 0) {
      eigenrays.push_back(found.path);
      continue;
    }
    // The two rays of the same image on both sides of the fold, roughly as far from it as predicted.
    std::optional<std::size_t> below, above;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (paths[i].target != found.target || members[i].family != kNoFamily) continue;
      const double off = eigenrays[i].launch_angle_rad - found.path.launch_angle_rad;
      const double share = std::abs(off) / found.to_rays_rad;
      if (share > kMinFoldShare && share < 1 / kMinFoldShare) (off < 0 ? below : above) = i;
    }
    if (!below || !above) continue;
    const bool is_one = found.x < kMergedFold;
    const auto member = [&](std::size_t i) {
      return FoldMember{family, eigenrays[i].launch_angle_rad, eigenrays[i].caustics, 0, found.x};
    };
    ++family;
    members[*below] = member(*below);
    if (is_one) ++family;
    members[*above] = member(*above);
    if (!is_one) continue;
    eigenrays[*below] = found.path;
    eigenrays[*above].amplitude = 0;
  }
  members.resize(eigenrays.size());
  finish(eigenrays, members, tracer_.sea().options);
  return eigenrays;
}

// The steps grow with the angle: 0.6 degrees near the horizontal, 4 degrees at 60.
std::vector<double> even_angles(double limit, double coarseness) {
  std::vector<double> angles{-limit, limit};
  for (double theta = 0.005; theta < limit; theta += coarseness * (0.01 + 0.06 * theta)) {
    angles.push_back(theta);
    angles.push_back(-theta);
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

std::vector<double> fan_angles(const ArcTracer& tracer, double steepest) {
  const double limit = std::min(steepest, tracer.sea().options.max_launch_angle_rad);
  std::vector<double> angles = even_angles(limit, 1);
  const auto add_both = [&angles](double theta) {
    angles.push_back(theta);
    angles.push_back(-theta);
  };
  const RayWater& water = tracer.sea().water;
  // The sound speed of a section is smooth at its inner knots, so these give no kinks.
  const auto counts = [&](std::size_t i) {
    return tracer.sea().section == nullptr || i == 0 || i == water.layers();
  };
  for (std::size_t i = 0; i < water.speeds_mps().size(); ++i) {
    if (!counts(i)) continue;
    if (i > 0 && water.depths_m()[i - 1] > tracer.sea().profile.deepest_m()) break;
    const double cosine = tracer.source_speed_mps() / water.speeds_mps()[i];
    if (cosine >= 1 || cosine < elementary::cos(limit)) continue;
    add_both(elementary::acos(cosine) - kBesideGrazing);
    add_both(elementary::acos(cosine) + kBesideGrazing);
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
  const double edge = elementary::acos(tracer.source_speed_mps() / core);
  std::erase_if(angles, [edge](double theta) { return std::abs(theta) < edge; });
  angles.insert(std::upper_bound(angles.begin(), angles.end(), 0.0), {-edge, edge});
  return edge;
}

std::vector<RayPoint> polyline(const ProfiledSea& sea, const RayLink& link, const Eigenray& path,
                               std::size_t max_points) {
  // The path is traced whatever it loses.
  ProfiledSea open = sea;
  open.options.max_bounces = path.surface_bounces + path.bottom_bounces + 1;
  open.options.max_launch_angle_rad = pi / 2;
  open.options.min_boundary_factor = 0;
  open.options.scattering = {};
  const RayLink held = held_apart(link);
  const ArcTracer tracer(open, held);
  std::vector<RayPoint> way{{0, tracer.source_depth_m()}};
  RayTrace ray;
  TraceDetails details;
  details.track = &way;
  tracer.trace(path.launch_angle_rad, ray, &details);
  // On the shadow side of a fold the path is that of the fold, which does not pass through the receiver.
  const bool turns_alike =
      ray.upper_turns == path.identity.upper_turns && ray.lower_turns == path.identity.lower_turns;
  const bool is_path = ray.arrived && ray.surface_bounces == path.surface_bounces &&
                       ray.bottom_bounces == path.bottom_bounces &&
                       (turns_alike || std::abs(ray.z - tracer.receiver_depth_m()) <= kMissed);
  if (!is_path || std::abs(ray.z - tracer.receiver_depth_m()) > kMissed) {
    if (auto longer = scaled_way(open, held, path)) {
      way = *longer;
    } else if (!is_path) {
      way = straight_way(tracer.bottom_at_receiver_m(), held, path);
    }
  }
  way.back() = {held.range_m, tracer.receiver_depth_m()};
  return simplified(way, max_points);
}

std::vector<RayPoint> simplified(const std::vector<RayPoint>& points, std::size_t max_points) {
  if (points.size() <= 2) return points;
  std::priority_queue<Detour> detours;
  detours.push(greatest_detour(points, 0, points.size() - 1));
  std::vector<std::size_t> kept{0, points.size() - 1};
  while (!detours.empty() && kept.size() < max_points && detours.top().off_m > kSimplifiedWithin) {
    const Detour detour = detours.top();
    detours.pop();
    kept.push_back(detour.at);
    for (const auto& [first, last] : {std::pair(detour.first, detour.at), {detour.at, detour.last}}) {
      if (last > first + 1) detours.push(greatest_detour(points, first, last));
    }
  }
  std::sort(kept.begin(), kept.end());
  std::vector<RayPoint> few;
  for (const std::size_t index : kept) few.push_back(points[index]);
  return few;
}

}  // namespace halocline::acoustics

#include "acoustics/rays/profile_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kFarOff = 1e-2;         // m of unfolded depth: a ray further off did not converge
constexpr double kBesideGrazing = 1e-9;  // rad

constexpr double kMinTube = 1e-9;  // m, of |q|: a ray on a caustic to rounding

}  // namespace

void append_profile_arrival(const ArcTracer& tracer, double theta, double target, std::vector<Arrival>& paths,
                            std::vector<std::uint64_t>& families) {
  TracedRay ray;
  TracedDetails details;
  tracer.trace(theta, ray, &details);
  const RayOptions& options = tracer.sea().options;
  if (!ray.arrived || ray.factor < options.min_boundary_factor) return;
  if (ray.surface_bounces + ray.bottom_bounces > options.max_bounces) return;
  if (std::abs(ray.zeta - target) > kFarOff) return;
  // A^2 = c_r cos_s / (c_s r |q|) (Jensen and others 2011, section 3.3).
  const double tube = std::max(std::abs(ray.q), kMinTube);
  const double speed = std::sqrt(1 - ray.sine * ray.sine) / ray.xi;
  Arrival path;
  // The receiver is not quite where the ray is: a front of slowness sin / c moves over the difference.
  const double down = (ray.surface_bounces + ray.bottom_bounces) % 2 == 0 ? 1 : -1;
  path.delay_s = details.delay_s + ray.sine / speed * down * (target - ray.zeta);
  path.amplitude =
      ray.factor * std::sqrt(speed * std::cos(theta) / (tracer.source_speed_mps() * tracer.range_m() * tube));
  const double phase = pi * (ray.surface_bounces % 2) + details.bottom_phase_rad + ray.caustics * pi / 2;
  path.phase_rad = phase - 2 * pi * std::floor(phase / (2 * pi));
  path.launch_angle_rad = theta;
  path.launch_slowness_spm = std::cos(theta) / tracer.source_speed_mps();
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
  path.identity = {theta < 0, ray.surface_bounces, ray.bottom_bounces, ray.upper_turns, ray.lower_turns, 0};
  paths.push_back(path);
  families.push_back(ray.family);
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

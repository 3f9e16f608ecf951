// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/near_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kLayers = 14;        // depth of the bubble layer in e-foldings: e^-14 of it lies below
constexpr double kCrests = 3;         // height of crests in rms heights
constexpr double kFarBelow = 6;       // least depth in rms heights from which no wave matters: 1e-9
constexpr double kPieces = 2;         // pieces of a ray for each e-folding
constexpr int kMaxPieces = 4096;      // of one ray
constexpr double kLevelSines = 1e-9;  // sum of the sines of a level piece

// Integrals along a ray: loss by bubbles, and length above the crests' depth.
struct Sums {
  double bubble_db = 0, length_m = 0;
  Sums operator+(const Sums& o) const { return {bubble_db + o.bubble_db, length_m + o.length_m}; }
  Sums operator*(double x) const { return {bubble_db * x, length_m * x}; }
};

// A piece of a ray, from depth z1 with the vertical sine s1 to z2 with s2, L long. Over a layer of constant
// gradient sin^2 is linear in depth, so that the sine is linear in the length.
struct Piece {
  double z1, s1, z2, s2, length;
};

class SurfaceIntegral {
 public:
  explicit SurfaceIntegral(const NearSurface& surface)
      : surface_(surface),
        crests_m_(kCrests * surface.waves.rms_height_m),
        step_m_(surface.bubbles.e_folding_m / kPieces),
        deep_m_(std::max(kLayers * surface.bubbles.e_folding_m, crests_m_)) {}

  double deep_m() const { return deep_m_; }

  // Integral from `depth` down along the ray of the sine `sine` there, to `until`, to where it turns, or to
  // below the layer.
  Sums down(const RayWater& water, double depth, double sine, double until) const {
    Sums sums;
    const double end = std::min(until, deep_m_), c = water.speed_at(depth);
    const double xi = std::sqrt(std::max(1 - sine * sine, 0.0)) / c;
    double z = depth, s = sine, speed = c;
    std::size_t layer = water.layer_at(depth);
    for (int i = 0; z < end && i < kMaxPieces; ++i) {
      const double knot = water.depths_m()[layer + 1];
      double next = std::min({z + step_m_, knot, end});
      if (z < crests_m_) next = std::min(next, crests_m_);
      const double next_speed = speed + water.gradients_per_s()[layer] * (next - z);
      const double square = s * s - xi * xi * (next_speed - speed) * (next_speed + speed);
      if (square <= 0) {  // turns within the piece
        if (!(s > 0)) break;
        next = z + (next - z) * s * s / (s * s - square);
        add({z, s, next, 0, 2 * (next - z) / s}, sums);
        break;
      }
      const double next_sine = std::sqrt(square);
      add({z, s, next, next_sine, 2 * (next - z) / std::max(s + next_sine, kLevelSines)}, sums);
      z = next;
      s = next_sine;
      speed = next_speed;
      if (z >= knot && layer + 1 < water.layers()) ++layer;
    }
    return sums;
  }

  // Integral along a path that neither turns nor bounces, from its ends' depths and sines (positive down), as
  // a cubic over its length.
  Sums along(double z1, double s1, double z2, double s2, double length) const {
    const double e_foldings = std::abs(z2 - z1) / surface_.bubbles.e_folding_m;
    const int count = std::clamp(static_cast<int>(std::ceil(4 * e_foldings)), 8, kMaxPieces);
    Sums sums;
    Piece piece{z1, s1, z1, s1, length / count};
    for (int i = 1; i <= count; ++i) {
      const double u = static_cast<double>(i) / count, v = 1 - u;
      // Hermite's cubic and its slope, du = ds / length.
      piece.z2 = std::max(
          v * v * (1 + 2 * u) * z1 + u * u * (3 - 2 * u) * z2 + length * u * v * (v * s1 - u * s2), 0.0);
      piece.s2 = 6 * u * v * (z2 - z1) / length + v * (1 - 3 * u) * s1 + u * (3 * u - 2) * s2;
      add(piece, sums);
      piece.z1 = piece.z2;
      piece.s1 = piece.s2;
    }
    return sums;
  }

 private:
  // Gauss and Legendre's rule of three points over the length of the piece.
  void add(const Piece& piece, Sums& sums) const {
    constexpr double kOff = 0.7745966692414834;  // sqrt(3 / 5)
    constexpr std::array<double, 3> kPlaces{0.5 - kOff / 2, 0.5, 0.5 + kOff / 2};
    constexpr std::array<double, 3> kWeights{5.0 / 18, 8.0 / 18, 5.0 / 18};
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      const double u = kPlaces[i], v = 1 - u;
      const double z = v * v * (1 + 2 * u) * piece.z1 + u * u * (3 - 2 * u) * piece.z2 +
                       piece.length * u * v * (v * piece.s1 - u * piece.s2);
      sums.bubble_db += kWeights[i] * piece.length * surface_.bubbles.db_per_m(std::max(z, 0.0));
    }
    if ((piece.z1 + piece.z2) / 2 < crests_m_) sums.length_m += piece.length;
  }

  const NearSurface& surface_;
  double crests_m_, step_m_, deep_m_;
};

// Depth at which a ray of the sine `sine` at `depth` turns above it; empty when it reaches the surface.
std::optional<double> upper_turn_m(const RayWater& water, double depth, double sine) {
  const double c = water.speed_at(depth), fastest = c / std::sqrt(std::max(1 - sine * sine, 1e-12));
  std::size_t layer = water.layer_at(depth);
  double z = depth, speed = c;
  for (;;) {
    const double top = water.depths_m()[layer], top_speed = water.speeds_mps()[layer];
    if (top_speed >= fastest)
      return top_speed > speed ? z - (z - top) * (fastest - speed) / (top_speed - speed) : z;
    if (layer == 0) return std::nullopt;
    z = top;
    speed = top_speed;
    --layer;
  }
}

// True when a path leaves or meets an end from below: the ray's part beyond the end lies deeper.
bool lies_below(double angle_rad, bool is_source) { return is_source == (angle_rad > 0); }

// The path's integrals, besides its bounces at the surface.
Sums sums_of(const SurfaceIntegral& integral, const RayWater& water, const RayLink& link,
             const Eigenray& path, std::optional<double> turn_m) {
  const double zs = link.source_depth_m, zr = link.receiver_depth_m;
  const double ss = elementary::sin(path.launch_angle_rad), sr = elementary::sin(path.arrival_angle_rad);
  const bool bounces = path.surface_bounces + path.bottom_bounces > 0;
  const bool turns = path.identity.upper_turns + path.identity.lower_turns > 0;
  if (!bounces && !turns && !path.diffuse) {
    // Near-level paths have no single integral down to the deep.
    const double between = std::abs(zr - zs), shallower = std::min(zs, zr);
    if (between < 2 * integral.deep_m()) return integral.along(zs, ss, zr, sr, path.path_length_m);
    return integral.down(water, shallower, std::abs(zs < zr ? ss : sr), std::max(zs, zr));
  }
  Sums sums;
  if (turn_m) sums = integral.down(water, *turn_m, 0, kDeepestWater) * (2.0 * path.identity.upper_turns);
  sums = sums + integral.down(water, zs, std::abs(ss), kDeepestWater) *
                    (lies_below(path.launch_angle_rad, true) ? 1 : -1);
  return sums + integral.down(water, zr, std::abs(sr), kDeepestWater) *
                    (lies_below(path.arrival_angle_rad, false) ? 1 : -1);
}

}  // namespace

NearSurface near_surface(double wind_mps, double frequency_hz) {
  return {bubble_layer(wind_mps, frequency_hz), surface_waves(wind_mps)};
}

SurfaceCrossing crossing_of(const NearSurface& surface, const RayWater& water, const RayLink& link,
                            const Eigenray& path) {
  SurfaceCrossing crossing;
  if (!(surface.waves.rms_height_m > 0)) return crossing;
  const SurfaceIntegral integral(surface);
  const bool may_turn = path.identity.upper_turns > 0 && !path.diffuse;
  const bool source_is_upper = link.source_depth_m <= link.receiver_depth_m;
  const double upper_m = std::min(link.source_depth_m, link.receiver_depth_m);
  const double upper_sine = elementary::sin(source_is_upper ? path.launch_angle_rad : path.arrival_angle_rad);
  std::optional<double> turn_m;
  if (may_turn) turn_m = upper_turn_m(water, upper_m, std::abs(upper_sine));
  const double least_m = std::min(upper_m, turn_m.value_or(upper_m));
  if (least_m >= integral.deep_m() && least_m >= kFarBelow * surface.waves.rms_height_m) return crossing;
  const Sums sums = sums_of(integral, water, link, path, turn_m);
  // Of a ray that turns close to the surface the solver may have taken a bounce already; the integral has
  // all.
  const double taken_db = path.surface_loss_db, bounces_db = path.surface_bounces > 0 ? taken_db : 0;
  const double all_db = std::clamp(bounces_db + sums.bubble_db, 0.0, std::max(kMaxBubblePathDb, bounces_db));
  crossing.bubble_db = all_db - taken_db;
  if (path.surface_bounces == 0 && least_m < kFarBelow * surface.waves.rms_height_m)
    crossing.clear_share = surface.waves.clear_share(least_m, std::max(sums.length_m, 0.0));
  return crossing;
}

void take_bubbles(const SurfaceCrossing& crossing, Eigenray& path) {
  if (crossing.bubble_db == 0) return;
  path.surface_loss_db += crossing.bubble_db;
  path.amplitude *= elementary::exp10(-crossing.bubble_db / 20);
}

// Of the power p P, p c and p m stay steady; the rest is p s of before, and 1 - p by the waves.
PathFading behind_crests(const PathFading& fading, double clear_share, double mean_wave_frequency_radps) {
  if (!(clear_share < 1)) return fading;
  PathFading waves = fading;
  waves.coherent *= clear_share;
  waves.medium *= clear_share;
  waves.scattered = 1 - waves.coherent - waves.medium;
  const double wave_hz = mean_wave_frequency_radps / (2 * pi);
  const double before = fading.doppler_spread_hz * fading.doppler_spread_hz;
  const double by_waves = 1 - clear_share, kept = clear_share * fading.scattered;
  // Mean square of both spreads, each weighted by what it scatters.
  waves.doppler_spread_hz =
      std::sqrt((kept * before + by_waves * (before + wave_hz * wave_hz)) / (kept + by_waves));
  return waves;
}

}  // namespace halocline::acoustics

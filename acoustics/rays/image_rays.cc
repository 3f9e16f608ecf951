// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/image_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "acoustics/math/arc_math.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// An image source: its number n of whole cycles, and i and j of acoustics/rays/image_rays.h.
struct Image {
  int cycles;
  bool up, down;
  double drop_m;  // vertical distance to the image
};

// base^exponent for a small exponent >= 0.
double power(double base, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent >>= 1, base *= base) {
    if ((exponent & 1) != 0) result *= base;
  }
  return result;
}

// The sum over the images of one link.
class ImageSum {
 public:
  ImageSum(const FlatSea& sea, const RayLink& link)
      : sea_(sea),
        range_(link.range_m),
        speed_(sea.water.speeds_mps().front()),
        source_is_upper_(link.source_depth_m <= link.receiver_depth_m),
        up_(std::min(link.source_depth_m, link.receiver_depth_m)),
        between_(std::abs(link.source_depth_m - link.receiver_depth_m)),
        down_(sea.bottom_depth_m - std::max(link.source_depth_m, link.receiver_depth_m)),
        min_sine_(elementary::sin(sea.options.max_launch_angle_rad)),
        steepest_factor_(bottom_magnitude_at_sine(sea.bottom, min_sine_, speed_)),
        absorption_up_(mean_absorption_over(0, up_)),
        absorption_between_(mean_absorption_over(up_, up_ + between_)),
        absorption_down_(mean_absorption_over(up_ + between_, sea.bottom_depth_m)),
        absorption_level_(sea.water.absorption_db_per_m(up_)) {
    const bool surface_first = up_ <= down_;
    order_ = {
        {{false, false}, {surface_first, !surface_first}, {!surface_first, surface_first}, {true, true}}};
  }

  std::vector<Eigenray> run() {
    paths_.reserve(48);
    for (int n = 0; n <= sea_.options.max_bounces; ++n) {
      bool any = false;
      for (const auto& [up, down] : order_) any = add(image(n, up, down)) || any;
      if (!any) break;
    }
    return std::move(paths_);
  }

 private:
  // Vertical distance to the image (Jensen and others 2011, section 2.4):
  //   2 (n + i) u + (2 n + 1) s + 2 (n + j) d
  Image image(int n, bool up, bool down) const {
    return {n, up, down,
            2.0 * (n + (up ? 1 : 0)) * up_ + (2.0 * n + 1) * between_ + 2.0 * (n + (down ? 1 : 0)) * down_};
  }

  // Mean of the absorption between two depths, dB/m, by Simpson's rule, which is exact for the parabola
  // within a layer.
  double mean_absorption_over(double top, double base) const {
    const RayWater& water = sea_.water;
    return (water.absorption_db_per_m(top) + 4 * water.absorption_db_per_m((top + base) / 2) +
            water.absorption_db_per_m(base)) /
           6;
  }

  double absorption_db(const Image& image, double length) const;
  // Adds an image; returns false when this image and all later ones are too steep or too faint.
  bool add(const Image& image);
  void set_phase(const Image& image, const Reflection& one, int surface, int bottom, Eigenray& path) const;

  const FlatSea& sea_;
  double range_, speed_;
  bool source_is_upper_;
  double up_, between_, down_, min_sine_, steepest_factor_;
  double absorption_up_, absorption_between_, absorption_down_, absorption_level_;  // dB/m
  std::array<std::array<bool, 2>, 4> order_{};
  std::vector<Eigenray> paths_;
};

double ImageSum::absorption_db(const Image& image, double length) const {
  // A straight line covers all depths evenly, so the parts u, s and d each contribute their own mean.
  if (image.drop_m <= 0) return length * absorption_level_;
  const double u = 2.0 * (image.cycles + (image.up ? 1 : 0)) * up_, s = (2.0 * image.cycles + 1) * between_;
  const double d = 2.0 * (image.cycles + (image.down ? 1 : 0)) * down_;
  const double sum = u * absorption_up_ + s * absorption_between_ + d * absorption_down_;
  return length * sum / image.drop_m;
}

bool ImageSum::add(const Image& image) {
  const int surface = image.cycles + (image.up ? 1 : 0), bottom = image.cycles + (image.down ? 1 : 0);
  const RayOptions& options = sea_.options;
  if (surface + bottom > options.max_bounces) return false;
  // A straight line of length L = sqrt(r^2 + drop^2) has the delay L / c and the pressure (-1)^surface
  // V^bottom / L.
  const double length = std::max(std::sqrt(range_ * range_ + image.drop_m * image.drop_m), 1e-6);
  const double sine = image.drop_m / length;
  if (surface + bottom > 0 && sine > min_sine_) return false;
  const double scattered = options.scattering.nepers(surface * sine * sine, bottom * sine * sine);
  if (options.scattering.leaves_none(surface + bottom, scattered)) return false;
  const Reflection one = bottom > 0 ? bottom_reflection_at_sine(sea_.bottom, sine, speed_) : Reflection{};
  double factor = power(one.magnitude, bottom);
  if (factor < options.min_boundary_factor) {
    // Steeper images have more bounces. The reflection coefficient has at most one minimum, so all of them
    // are fainter unless the coefficient at the steepest angle is greater again.
    return power(std::max(one.magnitude, steepest_factor_), bottom) >= options.min_boundary_factor;
  }
  const double angle = angle_of(image.drop_m, range_);
  const double top = surface > 0 ? surface_magnitude(sea_.surface, angle, options.frequency_hz) : 1;
  factor *= power(top, surface);
  if (factor < options.min_boundary_factor || factor / length < options.min_amplitude) return true;
  Eigenray& path = paths_.emplace_back();
  path.amplitude = factor / length;
  if (top < 1) path.surface_loss_db = -20 * surface * elementary::log10(top);
  path.delay_s = length / speed_;
  path.launch_slowness_spm = path.range_slowness_spm = range_ / (length * speed_);
  path.path_length_m = length;
  path.absorption_db = absorption_db(image, length);
  path.bottom_loss_db = bottom > 0 ? bottom * one.loss_db() : 0;
  path.surface_sine_squares = surface * sine * sine;
  path.bottom_sine_squares = bottom * sine * sine;
  set_phase(image, one, surface, bottom, path);
  const bool leaves_down = source_is_upper_ ? !image.up : image.down;
  const bool comes_down = source_is_upper_ ? !image.down : image.up;
  path.launch_angle_rad = leaves_down ? angle : -angle;
  path.arrival_angle_rad = comes_down ? angle : -angle;
  path.identity = {!leaves_down && angle > 0, surface, bottom, 0, 0, 0};
  return true;
}

// phase = pi (surface bounces) + (phase of one bottom bounce) (bottom bounces).
void ImageSum::set_phase(const Image&, const Reflection& one, int surface, int bottom, Eigenray& path) const {
  path.surface_bounces = surface;
  path.bottom_bounces = bottom;
  path.phase_rad = positive_angle(pi * (surface % 2) + one.phase_rad * bottom);
}

}  // namespace

std::vector<Eigenray> image_rays(const FlatSea& sea, const RayLink& link) {
  validate(sea.options);
  require_in_range(sea.bottom_depth_m, 0.1, kDeepestWater, "depth of the bottom", "m");
  require_in_range(link.source_depth_m, 0, sea.bottom_depth_m, "depth of the source", "m");
  require_in_range(link.receiver_depth_m, 0, sea.bottom_depth_m, "depth of the receiver", "m");
  require_in_range(link.range_m, 0, 1e7, "range", "m");
  require(sea.water.is_isovelocity_above(sea.bottom_depth_m), "images need water of one sound speed");
  return ImageSum(sea, link).run();
}

}  // namespace halocline::acoustics

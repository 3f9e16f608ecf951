// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/bottom_echo.h"

#include <cstddef>

#include "acoustics/link/transmission_loss.h"

namespace halocline::acoustics {
namespace {

// True when the bottom stands above one of the straight legs between the ends and point `bounce`.
bool is_blocked(double from_z_m, double to_z_m, std::span<const double> bottom_z_m, std::size_t bounce) {
  const double count = static_cast<double>(bottom_z_m.size()), start = static_cast<double>(bounce) + 0.5;
  for (std::size_t i = 0; i < bottom_z_m.size(); ++i) {
    if (i == bounce) continue;
    const bool is_before = i < bounce;
    const double along = static_cast<double>(i) + 0.5, end_z_m = is_before ? from_z_m : to_z_m;
    const double share = is_before ? along / start : (count - along) / (count - start);  // of the leg
    if (bottom_z_m[i] < end_z_m + share * (bottom_z_m[bounce] - end_z_m)) return true;
  }
  return false;
}

}  // namespace

Decibels echo_level(const LinkKernel& model, const Vec3& from_ned_m, const Vec3& to_ned_m,
                    const Vec3& bottom_ned_m) {
  const double surface = model.environment().sea_surface_z_m;
  const double from = depth_below_surface_m(from_ned_m, surface),
               to = depth_below_surface_m(to_ned_m, surface),
               bottom = depth_below_surface_m(bottom_ned_m, surface);
  const double down = (bottom_ned_m - from_ned_m).norm(), up = (to_ned_m - bottom_ned_m).norm();
  const double length = down + up;
  // The two beams point to the reflection point on the bottom.
  const Decibels level = model.transmitter().source_level -
                         model.transmitter().beam.loss(angle_down_rad(from_ned_m, bottom_ned_m)) -
                         model.receiver().beam.loss(angle_down_rad(to_ned_m, bottom_ned_m));
  if (length <= 0) return level;
  // One bounce without loss: TL over the length of both legs, alpha their mean weighted by length.
  const double mean_absorption =
      (model.absorption_db_per_km(from, bottom) * down + model.absorption_db_per_km(bottom, to) * up) /
      length;
  return level - transmission_loss(length, model.environment().spreading_exponent, mean_absorption).total;
}

bool is_echo_likely(const LinkKernel& model, const Vec3& from_ned_m, const Vec3& to_ned_m,
                    std::span<const double> bottom_z_m) {
  for (std::size_t i = kReflectingOneIn / 2; i < bottom_z_m.size(); i += kReflectingOneIn) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(bottom_z_m.size());
    Vec3 bottom = from_ned_m + share * (to_ned_m - from_ned_m);
    bottom.z() = bottom_z_m[i];
    const bool reflects = bottom.z() > model.environment().sea_surface_z_m &&
                          !is_blocked(from_ned_m.z(), to_ned_m.z(), bottom_z_m, i);
    if (reflects && echo_level(model, from_ned_m, to_ned_m, bottom) > model.receiver().min_receivable_level)
      return true;
  }
  return false;
}

}  // namespace halocline::acoustics

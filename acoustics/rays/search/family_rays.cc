// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/search/family_rays.h"

#include <cmath>
#include <cstddef>

#include "acoustics/rays/traced_eigenray.h"
#include "acoustics/sea/bottom_profile.h"

namespace halocline::acoustics {
namespace {

std::optional<Eigenray> representative_of(const ArcTracer& tracer, double theta) {
  const std::optional<DiffuseRay> ray = diffuse_ray(tracer, theta, 0);
  return ray ? std::optional(ray->eigenray) : std::nullopt;
}

}  // namespace

LevelFamilyRays::LevelFamilyRays(const FlatSea& sea, const RayLink& link)
    : sea_(sea), link_(link), rays_(sea.water, sea.bottom_depth_m, link.source_depth_m, link.range_m) {}

std::optional<FamilyRay> LevelFamilyRays::at(double theta) {
  const RangeEnd end = rays_.at(theta);
  if (!end.arrived) return std::nullopt;
  return FamilyRay{
      theta, end.depth_m - link_.receiver_depth_m, end.sine, {end.surface_bounces, end.bottom_bounces}};
}

std::optional<Eigenray> LevelFamilyRays::representative(double theta) const {
  const BottomProfile profile = BottomProfile::flat(sea_.bottom_depth_m);
  return representative_of(ArcTracer({sea_.water, profile, sea_.bottom, sea_.surface, sea_.options}, link_),
                           theta);
}

ProfiledFamilyRays::ProfiledFamilyRays(const ProfiledSea& sea, const RayLink& link)
    : tracer_(sea, link), fan_(tracer_) {}

std::optional<FamilyRay> ProfiledFamilyRays::at(double theta) {
  const std::size_t kept = fan_.kept_events();
  const FanRay ray = fan_.trace(theta);
  FamilyBounces bounces;
  for (const EventCode& event : fan_.events_of(ray)) {
    if (event.event == RayEvent::kSurface) ++bounces.surface;
    if (event.event == RayEvent::kBottom) ++bounces.bottom;
  }
  fan_.forget_since(kept);
  if (!ray.arrived) return std::nullopt;
  // Unfolded depth is an image of the depth, z or -z, a whole number of 2 H away.
  const double depth = std::abs(std::remainder(ray.zeta, 2 * tracer_.bottom_at_receiver_m()));
  const double sine = ray.slowness * tracer_.water_at_receiver().speed_at(depth);
  return FamilyRay{theta, depth - tracer_.receiver_depth_m(), sine, bounces};
}

std::optional<Eigenray> ProfiledFamilyRays::representative(double theta) const {
  return representative_of(tracer_, theta);
}

}  // namespace halocline::acoustics

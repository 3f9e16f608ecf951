// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/local_frame.h"

#include <GeographicLib/Constants.hpp>

#include "core/check.h"
#include "core/units.h"

namespace halocline::bathymetry {
namespace {

constexpr double kMaxLatitudeDeg = 89.9;  // at the poles, north is undefined

double checked_latitude(double latitude_rad) {
  require_in_range(to_degrees(latitude_rad), -kMaxLatitudeDeg, kMaxLatitudeDeg, "latitude of the origin",
                   "degrees");
  return latitude_rad;
}

}  // namespace

LocalFrame::LocalFrame(FrameMode mode, double origin_latitude_rad, double origin_longitude_rad)
    : mode_(mode),
      latitude_rad_(checked_latitude(origin_latitude_rad)),
      longitude_rad_(require_finite(origin_longitude_rad, "longitude of the origin")),
      projection_(GeographicLib::Constants::WGS84_a(), GeographicLib::Constants::WGS84_f(), 1.0),
      tangent_plane_(to_degrees(latitude_rad_), to_degrees(longitude_rad_), 0.0) {
  double easting = 0;
  projection_.Forward(to_degrees(longitude_rad_), to_degrees(latitude_rad_), to_degrees(longitude_rad_),
                      easting, origin_northing_m_);
}

Vec3 LocalFrame::to_ned(const GeodeticPoint& point) const {
  const double latitude = to_degrees(point.latitude_rad), longitude = to_degrees(point.longitude_rad);
  double east = 0, north = 0, up = 0;
  if (mode_ == FrameMode::kEnu) {
    tangent_plane_.Forward(latitude, longitude, -point.depth_m, east, north, up);
    return {north, east, -up};
  }
  projection_.Forward(to_degrees(longitude_rad_), latitude, longitude, east, north);
  return {north - origin_northing_m_, east, point.depth_m};
}

GeodeticPoint LocalFrame::to_geodetic(const Vec3& position_ned_m) const {
  double latitude = 0, longitude = 0, height = -position_ned_m.z();
  if (mode_ == FrameMode::kEnu) {
    tangent_plane_.Reverse(position_ned_m.y(), position_ned_m.x(), -position_ned_m.z(), latitude, longitude,
                           height);
  } else {
    projection_.Reverse(to_degrees(longitude_rad_), position_ned_m.y(),
                        position_ned_m.x() + origin_northing_m_, latitude, longitude);
  }
  return {to_radians(latitude), to_radians(longitude), -height};
}

}  // namespace halocline::bathymetry

// SPDX-License-Identifier: BSD-3-Clause
// Transformation between latitude, longitude and depth on the ellipsoid and the scenario's local NED frame.
//
// Both modes use WGS84, with the origin at depth 0 of the datum.
// - flat: z is depth; x, y are a transverse Mercator projection with scale 1 on the origin's meridian
//   (Krueger's series to sixth order, Karney 2011: 5 nm). Depth has the same meaning everywhere, and the
//   earth's curvature is removed. At the distance y east or west of the origin and with the earth's radius R,
//   distances are too long by the relative amount y^2 / (2 R^2): 3e-5 at 50 km (1.5 m in 50 km). x is grid
//   north, which differs from true north by y tan(latitude) / R: 0.26 degrees at 50 km and latitude 30
//   degrees.
// - enu: the tangent plane at the origin, exact. Straight lines are straight, and at the distance d the datum
//   lies below the plane by d^2 / (2 R): 7.85 m at 10 km, 196 m at 50 km. There z is not depth;
//   GeodeticPoint::depth_m is.
//
// UTM is not used: its scale and convergence cause errors of 20 m in 50 km and turn north by up to 2 degrees.
// The datum is taken as a surface parallel to the ellipsoid: slopes of the geoid (some 10 mm per km) are left
// out.
#pragma once

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/TransverseMercator.hpp>

#include "core/frames.h"

namespace halocline::bathymetry {

enum class FrameMode { kFlat, kEnu };

struct GeodeticPoint {
  double latitude_rad = 0;   // north positive, WGS84, within +-pi/2
  double longitude_rad = 0;  // east positive; any turn on input, -pi..pi on output
  double depth_m = 0;        // below the datum, positive down
};

// Immutable; const calls may overlap between threads.
class LocalFrame {
 public:
  // Throws InvalidArgument unless the latitude is within +-89.9 degrees and both are finite.
  LocalFrame(FrameMode mode, double origin_latitude_rad, double origin_longitude_rad);

  // Returns the position in local NED. In flat mode the point must lie within 3900 km of the origin's
  // meridian.
  Vec3 to_ned(const GeodeticPoint& point) const;
  GeodeticPoint to_geodetic(const Vec3& position_ned_m) const;

  FrameMode mode() const { return mode_; }
  double origin_latitude_rad() const { return latitude_rad_; }
  double origin_longitude_rad() const { return longitude_rad_; }

 private:
  FrameMode mode_;
  double latitude_rad_, longitude_rad_;
  double origin_northing_m_ = 0;  // distance of the origin from the equator along its meridian
  GeographicLib::TransverseMercator projection_;
  GeographicLib::LocalCartesian tangent_plane_;
};

}  // namespace halocline::bathymetry

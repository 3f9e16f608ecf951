// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/local_frame.h"

#include <cmath>

#include <GeographicLib/Geodesic.hpp>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"
#include "tests/support/tolerance.h"

namespace halocline::bathymetry {
namespace {

using halocline::testing::tolerance;

LocalFrame frame_at(FrameMode mode, double latitude_deg, double longitude_deg) {
  return LocalFrame(mode, to_radians(latitude_deg), to_radians(longitude_deg));
}

// The point `distance_m` from the origin on the ellipsoid, by another code (Karney's geodesics).
GeodeticPoint along_geodesic(double latitude_deg, double longitude_deg, double azimuth_deg,
                             double distance_m) {
  double latitude = 0, longitude = 0;
  GeographicLib::Geodesic::WGS84().Direct(latitude_deg, longitude_deg, azimuth_deg, distance_m, latitude,
                                          longitude);
  return {to_radians(latitude), to_radians(longitude), 0};
}

TEST(LocalFrame, OriginIsZeroInBothModes) {
  for (const FrameMode mode : {FrameMode::kFlat, FrameMode::kEnu}) {
    const LocalFrame frame = frame_at(mode, 30, -28);
    const Vec3 origin = frame.to_ned({to_radians(30), to_radians(-28), 0});
    EXPECT_LT(origin.norm(), tolerance(1e-8)) << "nanometres of a projection of 3000 km";
  }
}

TEST(LocalFrame, ComesBackToWhereItWas) {
  for (const FrameMode mode : {FrameMode::kFlat, FrameMode::kEnu}) {
    for (const double latitude : {-75.0, 0.0, 30.0, 60.0}) {
      const LocalFrame frame = frame_at(mode, latitude, 179.9);  // the date line is no edge
      const Vec3 point(12'345, 23'456, 789);
      EXPECT_LT((frame.to_ned(frame.to_geodetic(point)) - point).norm(), tolerance(1e-7)) << latitude;
    }
  }
}

TEST(LocalFrame, NorthIsXAndEastIsY) {
  for (const FrameMode mode : {FrameMode::kFlat, FrameMode::kEnu}) {
    const LocalFrame frame = frame_at(mode, 30, -28);
    EXPECT_GT(frame.to_ned({to_radians(30.01), to_radians(-28), 0}).x(), 1000);
    EXPECT_GT(frame.to_ned({to_radians(30), to_radians(-27.99), 0}).y(), 900);
  }
}

TEST(LocalFrame, FlatKeepsDepthAndDistance) {
  const LocalFrame frame = frame_at(FrameMode::kFlat, 30, -28);
  for (double azimuth = 0; azimuth < 360; azimuth += 30) {
    GeodeticPoint point = along_geodesic(30, -28, azimuth, 10'000);
    point.depth_m = 321;
    const Vec3 ned = frame.to_ned(point);
    EXPECT_EQ(ned.z(), 321);
    // Stated: too long by y^2 / (2 R^2), 1.2e-6 at 10 km.
    EXPECT_NEAR(std::hypot(ned.x(), ned.y()), 10'000, tolerance(0.0125)) << azimuth;
  }
}

TEST(LocalFrame, EnuDropsWithTheCurvatureOfTheEarth) {
  const LocalFrame frame = frame_at(FrameMode::kEnu, 0, 0);
  // Along the equator, where the radius is 6 378 137 m: R (1 - cos(d / R)).
  const double radius = 6'378'137;
  for (const double distance : {10'000.0, 50'000.0}) {
    const Vec3 ned = frame.to_ned(along_geodesic(0, 0, 90, distance));
    EXPECT_NEAR(ned.z(), radius * (1 - std::cos(distance / radius)), tolerance(1e-6));
  }
  EXPECT_NEAR(frame.to_ned(along_geodesic(0, 0, 90, 10'000)).z(), 7.84, tolerance(0.005));
  // 7.85 m where the radius is the mean one, at some 30 degrees along the meridian.
  EXPECT_NEAR(frame_at(FrameMode::kEnu, 30, 0).to_ned(along_geodesic(30, 0, 0, 10'000)).z(), 7.85,
              tolerance(0.03));
  EXPECT_NEAR(frame_at(FrameMode::kEnu, 30, 0).to_ned(along_geodesic(30, 0, 90, 50'000)).z(), 196,
              tolerance(0.5));
}

TEST(LocalFrame, RefusesPolesAndNaN) {
  EXPECT_THROW(frame_at(FrameMode::kFlat, 90, 0), InvalidArgument);
  EXPECT_THROW(frame_at(FrameMode::kEnu, std::nan(""), 0), InvalidArgument);
  EXPECT_THROW(frame_at(FrameMode::kEnu, 0, HUGE_VAL), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bathymetry

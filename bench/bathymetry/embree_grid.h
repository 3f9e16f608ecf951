// SPDX-License-Identifier: BSD-3-Clause
// The bottom as a grid of Embree (Wald et al. 2014), to compare the speed of rays with.
//
// Model: two triangles a cell in single precision, robust mode, built at high quality. Its surface differs
// from ours by a quarter of a cell's twist, so ranges agree to metres, not to the bit. One thread a query.
#pragma once

#include <limits>

#include <embree3/rtcore.h>

#include "bathymetry/terrain/height_grid.h"
#include "bathymetry/terrain/terrain.h"

namespace halocline::bathymetry {

class EmbreeGrid {
 public:
  explicit EmbreeGrid(const HeightGrid& grid)
      : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    const GridGeometry& g = grid.geometry();
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_GRID);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), grid.posts().size()));
    for (int i = 0; i < g.posts_x; ++i) {
      for (int j = 0; j < g.posts_y; ++j) {
        *vertex++ = static_cast<float>(g.x_at(i));
        *vertex++ = static_cast<float>(g.y_at(j));
        *vertex++ = grid.post(i, j);
      }
    }
    auto* patch = static_cast<RTCGrid*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
    *patch = {0, static_cast<unsigned>(g.posts_y), static_cast<unsigned short>(g.posts_y),
              static_cast<unsigned short>(g.posts_x)};
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeGrid() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeGrid(const EmbreeGrid&) = delete;
  EmbreeGrid& operator=(const EmbreeGrid&) = delete;

  // m; infinity without a hit. The ray has a direction of length 1.
  float range_of_hit(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    query.ray = {};
    query.ray.org_x = static_cast<float>(ray.origin_ned_m.x());
    query.ray.org_y = static_cast<float>(ray.origin_ned_m.y());
    query.ray.org_z = static_cast<float>(ray.origin_ned_m.z());
    query.ray.dir_x = static_cast<float>(ray.direction.x());
    query.ray.dir_y = static_cast<float>(ray.direction.y());
    query.ray.dir_z = static_cast<float>(ray.direction.z());
    query.ray.tfar = static_cast<float>(ray.max_range_m);
    query.ray.mask = ~0U;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity()
                                                       : query.ray.tfar;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace halocline::bathymetry

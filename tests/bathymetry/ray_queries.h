// SPDX-License-Identifier: BSD-3-Clause
// RAY_QUERYs as clients of the bathymetry service make them.
#pragma once

#include <cstdint>
#include <vector>

#include "bathymetry/bathymetry_messages.h"
#include "bathymetry/ray_service.h"
#include "bathymetry/terrain/terrain.h"
#include "bus/messages/messages.h"
#include "core/frames.h"

namespace halocline::bathymetry {

// Ray origins are stored relative to `base_ned_m`, so that offsets stay short far from the origin.
inline ray_query_t to_message(const QueryHeader& header, const RayBatch& batch, const Vec3& base_ned_m) {
  const auto as_list = [](const Vec3& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
  ray_query_t message;
  message.utime = header.utime;
  message.client_name = header.client_name;
  message.request_id = header.request_id;
  message.expected_terrain = batch.expected_terrain;
  message.query_mode = static_cast<std::int8_t>(batch.mode);
  message.sample_spacing_m = batch.sample_spacing_m;
  for (int axis = 0; axis < 3; ++axis) message.base_origin_ned_m[axis] = base_ned_m[axis];
  message.num_rays = static_cast<std::int32_t>(batch.rays.size());
  for (const Ray& ray : batch.rays) {
    message.offset_m.push_back(as_list(ray.origin_ned_m - base_ned_m));
    message.direction.push_back(as_list(ray.direction));
    message.max_range_m.push_back(ray.max_range_m);
  }
  return message;
}

}  // namespace halocline::bathymetry

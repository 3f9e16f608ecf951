// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/search/cycle_rays.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kLeastSine = 1e-9;  // of a ray at the source: one that is horizontal turns, or runs on

}  // namespace

CycleRays::CycleRays(const RayWater& water, double bottom_m, double source_m, double range_m)
    : source_m_(source_m), source_mps_(water.speed_at(source_m)), range_m_(range_m) {
  const std::vector<double>&depths = water.depths_m(), &gradients = water.gradients_per_s();
  const std::size_t here = water.layer_at(source_m);
  const auto add = [&](Side& side, double from_m, double to_m, std::size_t layer, double sign) {
    const double height = std::abs(to_m - from_m);
    if (!(height > 0)) return;
    const double c1 = water.speeds_mps()[layer] + gradients[layer] * (from_m - depths[layer]);
    const double c2 = water.speeds_mps()[layer] + gradients[layer] * (to_m - depths[layer]);
    side.layers.push_back({height, c1, c2, sign * gradients[layer]});
  };
  for (std::size_t i = here + 1; i-- > 0;) add(up_, std::min(source_m, depths[i + 1]), depths[i], i, -1);
  for (std::size_t i = here; i < water.layers() && depths[i] < bottom_m; ++i)
    add(down_, std::max(source_m, depths[i]), std::min(bottom_m, depths[i + 1]), i, 1);
  for (Side* side : {&up_, &down_}) {
    side->range_m.resize(side->layers.size() + 1);
    side->sine.resize(side->layers.size() + 1);
  }
}

void CycleRays::march(Side& side, double xi, double sine) const {
  double range = 0;
  side.count = 0;
  side.bounces = true;
  for (const CycleLayer& layer : side.layers) {
    side.range_m[side.count] = range;
    side.sine[side.count++] = sine;
    const double cosine = xi * layer.c2;
    if (cosine >= 1 && layer.gradient_per_s > 0) {
      range += sine / (xi * layer.gradient_per_s);
      side.bounces = false;
      break;
    }
    const double end = std::max(std::sqrt(std::max((1 - cosine) * (1 + cosine), 0.0)), kLeastSine);
    range += layer.height_m * xi * (layer.c1 + layer.c2) / (sine + end);
    sine = end;
  }
  side.total_m = range;
}

// With e the range from the start of a layer, s = s1 - xi g e and z = z1 + e (s1 + s) / (xi (c1 + c)).
double CycleRays::height_at(const Side& side, double xi, double along_m, double& sine) {
  double height = 0;
  std::size_t i = 0;
  for (; i + 1 < side.count && side.range_m[i + 1] <= along_m; ++i) height += side.layers[i].height_m;
  if (side.count == 0) return 0;
  const CycleLayer& layer = side.layers[i];
  const double e = along_m - side.range_m[i];
  sine = std::clamp(side.sine[i] - xi * layer.gradient_per_s * e, 0.0, 1.0);
  const double c = std::sqrt(1 - sine * sine) / xi;
  return height + e * (side.sine[i] + sine) / (xi * (layer.c1 + c));
}

RangeEnd CycleRays::at(double theta) {
  const elementary::SineCosine turn = elementary::sin_cos(theta);
  const double xi = turn.cosine / source_mps_, sine = std::max(std::abs(turn.sine), kLeastSine);
  march(up_, xi, sine);
  march(down_, xi, sine);
  const bool first_down = turn.sine >= 0;
  const Side &first = first_down ? down_ : up_, &second = first_down ? up_ : down_;
  const double cycle = 2 * (first.total_m + second.total_m);
  RangeEnd end;
  if (!(cycle > 0)) return end;
  const double whole = std::floor(range_m_ / cycle);
  const double place = std::clamp(range_m_ - whole * cycle, 0.0, cycle);
  double on_first = whole, on_second = whole, along = place, away = 1;
  bool at_first = true;
  if (place > first.total_m) {
    on_first += 1;
    along = 2 * first.total_m - place;
    away = -1;
  }
  if (along < 0) {
    at_first = false;
    along = -along;
    away = 1;
    if (along > second.total_m) {
      on_second += 1;
      along = 2 * second.total_m - along;
      away = -1;
    }
  }
  const Side& side = at_first ? first : second;
  const bool below = at_first == first_down;
  const double height = height_at(side, xi, along, end.sine);
  end.depth_m = source_m_ + (below ? height : -height);
  end.sine *= below ? away : -away;
  const auto count = [](const Side& of, double touches) {
    return of.bounces ? static_cast<int>(touches) : 0;
  };
  end.surface_bounces = first_down ? count(second, on_second) : count(first, on_first);
  end.bottom_bounces = first_down ? count(first, on_first) : count(second, on_second);
  end.arrived = true;
  return end;
}

}  // namespace halocline::acoustics

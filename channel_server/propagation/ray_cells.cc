#include "channel_server/propagation/ray_cells.h"

#include <cmath>

namespace halocline::channel_server {
namespace {

constexpr double kMinCellsOfALink = 20;
constexpr int kMaxHalvings = 6;
constexpr double kDepthShare = 0.1;  // height of a cell over its length

double middle(double value, double cell) { return cell * (std::floor(value / cell) + 0.5); }

}  // namespace

std::optional<acoustics::RayLink> middle_of_cell(const acoustics::RayLink& link, double distance_m) {
  double cell = distance_m;
  for (int halvings = 0; link.range_m < kMinCellsOfALink * cell; ++halvings, cell /= 2) {
    if (halvings == kMaxHalvings) return std::nullopt;
  }
  const double height = kDepthShare * cell;
  return acoustics::RayLink{middle(link.source_depth_m, height), middle(link.receiver_depth_m, height),
                            middle(link.range_m, cell)};
}

}  // namespace halocline::channel_server

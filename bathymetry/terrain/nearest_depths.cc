// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/nearest_depths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace halocline::bathymetry {
namespace {

using Posts = std::vector<std::size_t>;  // indices

// Visits the neighbours of a post, at most four.
template <typename Visit>
void visit_neighbours(const GridGeometry& g, std::size_t post, const Visit& visit) {
  const auto row = static_cast<std::size_t>(g.posts_y), rows = static_cast<std::size_t>(g.posts_x);
  const std::size_t i = post / row, j = post % row;
  if (i > 0) visit(post - row);
  if (i + 1 < rows) visit(post + row);
  if (j > 0) visit(post - 1);
  if (j + 1 < row) visit(post + 1);
}

}  // namespace

// Breadth-first search from all posts with data at once.
NearestDepths::NearestDepths(const HeightGrid& grid) : geometry_(grid.geometry()), z_m_(grid.posts()) {
  Posts front;
  for (std::size_t post = 0; post < z_m_.size(); ++post) {
    if (std::isnan(z_m_[post])) continue;
    bool borders_a_gap = false;
    visit_neighbours(geometry_, post,
                     [&](std::size_t beside) { borders_a_gap = borders_a_gap || std::isnan(z_m_[beside]); });
    if (borders_a_gap) front.push_back(post);
  }
  while (!front.empty()) {
    Posts next;
    for (const std::size_t post : front) {
      visit_neighbours(geometry_, post, [&](std::size_t beside) {
        if (!std::isnan(z_m_[beside])) return;
        z_m_[beside] = z_m_[post];
        next.push_back(beside);
      });
    }
    front = std::move(next);
  }
}

double NearestDepths::at(double x_m, double y_m) const {
  const auto nearest = [&](double from_m, int posts) {
    return static_cast<std::size_t>(std::clamp(std::round(from_m / geometry_.spacing_m), 0.0, posts - 1.0));
  };
  const std::size_t i = nearest(x_m - geometry_.first_x_m, geometry_.posts_x);
  return z_m_[i * static_cast<std::size_t>(geometry_.posts_y) +
              nearest(y_m - geometry_.first_y_m, geometry_.posts_y)];
}

}  // namespace halocline::bathymetry

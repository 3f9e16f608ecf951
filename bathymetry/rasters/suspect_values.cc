// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/rasters/suspect_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace halocline::bathymetry {
namespace {

constexpr float kDeepestM = 12'000, kHighestM = 9'500;
constexpr float kMark = 9999, kSmallMark = 999;
constexpr float kMaxStepM = 2000;  // limit between neighbouring posts of real terrain
constexpr float kMinCliffM = 50, kCliffSteps = 10;
constexpr double kUsualShare = 0.95;          // quantile of steps between neighbours
constexpr std::size_t kMaxSteps = 1'000'000;  // limit of examined steps
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

bool is_mark(float value) { return std::abs(value) == kMark || std::abs(value) == kSmallMark; }

class Suspects {
 public:
  explicit Suspects(RasterWindow& window) : window_(window), is_seen_(window.depths_m.size(), false) {}

  std::size_t remove() {
    std::size_t removed = 0;
    for (float& depth : window_.depths_m) {
      const bool is_impossible = depth > kDeepestM || depth < -kHighestM;
      removed += is_impossible ? 1 : 0;
      depth = is_impossible ? kNone : depth;
    }
    std::vector<std::vector<std::size_t>> marked;
    for (std::size_t post = 0; post < window_.depths_m.size(); ++post) {
      if (!is_mark(window_.depths_m[post]) || is_seen_[post]) continue;
      std::vector<std::size_t> patch = patch_from(post);
      if (is_no_depth(patch)) marked.push_back(std::move(patch));
    }
    for (const auto& patch : marked) {
      for (const std::size_t post : patch) window_.depths_m[post] = kNone;
      removed += patch.size();
    }
    return removed;
  }

 private:
  template <class Visit>
  void for_neighbours(std::size_t post, const Visit& visit) const {
    const int row = static_cast<int>(post / static_cast<std::size_t>(window_.columns)),
              column = static_cast<int>(post % static_cast<std::size_t>(window_.columns));
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, window_.rows - 1); ++r) {
      for (int c = std::max(column - 1, 0); c <= std::min(column + 1, window_.columns - 1); ++c)
        visit(static_cast<std::size_t>(r) * static_cast<std::size_t>(window_.columns) +
              static_cast<std::size_t>(c));
    }
  }

  // Returns the connected posts around `first` that have the same mark.
  std::vector<std::size_t> patch_from(std::size_t first) {
    const float mark = window_.depths_m[first];
    std::vector<std::size_t> patch{first};
    is_seen_[first] = true;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      for_neighbours(patch[i], [&](std::size_t post) {
        if (window_.depths_m[post] != mark || is_seen_[post]) return;
        is_seen_[post] = true;
        patch.push_back(post);
      });
    }
    return patch;
  }

  bool is_no_depth(const std::vector<std::size_t>& patch) {
    const float mark = window_.depths_m[patch.front()];
    float nearest = std::numeric_limits<float>::infinity();
    bool has_others = false;
    for (const std::size_t inside : patch) {
      for_neighbours(inside, [&](std::size_t post) {
        const float depth = window_.depths_m[post];
        if (std::isnan(depth) || is_mark(depth)) return;
        has_others = true;
        nearest = std::min(nearest, std::abs(depth - mark));
      });
    }
    if (std::abs(mark) == kMark) return nearest > kMaxStepM;
    return has_others && nearest > std::max(kMinCliffM, kCliffSteps * usual_step());
  }

  // Returns the usual step from a post to the next of its row, over pairs without marks.
  float usual_step() {
    if (usual_step_ >= 0) return usual_step_;
    std::vector<float> steps;
    const std::size_t stride = 1 + window_.depths_m.size() / kMaxSteps;
    for (std::size_t post = 0; post + 1 < window_.depths_m.size(); post += stride) {
      const float a = window_.depths_m[post], b = window_.depths_m[post + 1];
      const bool is_row = (post + 1) % static_cast<std::size_t>(window_.columns) != 0;
      if (is_row && !is_mark(a) && !is_mark(b) && std::isfinite(a - b)) steps.push_back(std::abs(a - b));
    }
    if (steps.empty()) return usual_step_ = 0;
    const auto usual =
        steps.begin() + static_cast<std::ptrdiff_t>(kUsualShare * static_cast<double>(steps.size() - 1));
    std::nth_element(steps.begin(), usual, steps.end());
    return usual_step_ = *usual;
  }

  RasterWindow& window_;
  std::vector<bool> is_seen_;
  float usual_step_ = -1;  // below 0: not computed yet
};

}  // namespace

std::size_t remove_suspects(RasterWindow& window) { return Suspects(window).remove(); }

}  // namespace halocline::bathymetry

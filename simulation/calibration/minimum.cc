// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/minimum.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace halocline::clients {
namespace {

constexpr double kAlike = 1e-7;

struct Corner {
  Eigen::VectorXd at;
  double value;
};

}  // namespace

Eigen::VectorXd minimum_of(const FunctionOfVector& f, const Eigen::VectorXd& start,
                           const Eigen::VectorXd& steps, int most_values) {
  std::vector<Corner> corners{{start, f(start)}};
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    Eigen::VectorXd at = start;
    at[i] += steps[i];
    corners.push_back({at, f(at)});
  }
  const auto sort = [&] {
    std::stable_sort(corners.begin(), corners.end(),
                     [](const Corner& a, const Corner& b) { return a.value < b.value; });
  };
  sort();
  const auto size = static_cast<double>(start.size());
  for (int values = static_cast<int>(corners.size()); values < most_values;) {
    if (corners.back().value - corners.front().value < kAlike) break;
    Eigen::VectorXd middle = Eigen::VectorXd::Zero(start.size());
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) middle += corners[i].at / size;
    // Returns the point beyond the middle, seen from the worst corner, at a multiple of its distance.
    const auto beyond = [&](double multiple) {
      const Eigen::VectorXd at = middle + multiple * (middle - corners.back().at);
      ++values;
      return Corner{at, f(at)};
    };
    Corner next = beyond(1);
    if (next.value < corners.front().value) {
      const Corner further = beyond(2);
      if (further.value < next.value) next = further;
    } else if (next.value >= corners[corners.size() - 2].value) {
      next = beyond(next.value < corners.back().value ? 0.5 : -0.5);
    }
    if (next.value < corners.back().value) {
      corners.back() = next;
    } else {
      for (std::size_t i = 1; i < corners.size(); ++i) {
        corners[i].at = 0.5 * (corners[i].at + corners.front().at);
        corners[i].value = f(corners[i].at);
        ++values;
      }
    }
    sort();
  }
  return corners.front().at;
}

Eigen::MatrixXd curvature_of(const FunctionOfVector& f, const Eigen::VectorXd& at,
                             const Eigen::VectorXd& steps) {
  const Eigen::Index n = at.size();
  Eigen::MatrixXd curvature(n, n);
  const auto value = [&](Eigen::Index i, double si, Eigen::Index j, double sj) {
    Eigen::VectorXd place = at;
    place[i] += si * steps[i];
    place[j] += sj * steps[j];
    return f(place);
  };
  const double middle = f(at);
  for (Eigen::Index i = 0; i < n; ++i) {
    curvature(i, i) = (value(i, 1, i, 0) - 2 * middle + value(i, -1, i, 0)) / (steps[i] * steps[i]);
    for (Eigen::Index j = 0; j < i; ++j) {
      curvature(i, j) = curvature(j, i) =
          (value(i, 1, j, 1) - value(i, 1, j, -1) - value(i, -1, j, 1) + value(i, -1, j, -1)) /
          (4 * steps[i] * steps[j]);
    }
  }
  return curvature;
}

}  // namespace halocline::clients

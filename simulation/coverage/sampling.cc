// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/coverage/sampling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace halocline::clients {
namespace {

using Indices = std::vector<std::size_t>;

class Sampling {
 public:
  Sampling(const std::vector<double>& places, const Sample& tolerance,
           const std::function<Sample(double)>& compute)
      : places_(places),
        tolerance_(tolerance),
        compute_(compute),
        values_(places.size()),
        known_(places.size(), false) {}

  std::vector<Sample> run(double longest) {
    for (std::size_t from = 0; from + 1 < places_.size();) {
      const auto end = std::upper_bound(places_.begin() + static_cast<std::ptrdiff_t>(from), places_.end(),
                                        places_[from] + longest);
      const std::size_t to = std::max(static_cast<std::size_t>(end - places_.begin()) - 1, from + 1);
      fill(from, to);
      from = to;
    }
    if (places_.size() == 1) know(0);
    return std::move(values_);
  }

 private:
  static constexpr std::size_t kFewest = 8;  // shorter spans are computed place by place

  void know(std::size_t i) {
    if (!known_[i]) values_[i] = compute_(places_[i]);
    known_[i] = true;
  }

  // Returns the first place between two others that is not before the middle of them.
  std::size_t middle(std::size_t a, std::size_t b) const {
    const auto at = std::lower_bound(places_.begin() + static_cast<std::ptrdiff_t>(a) + 1,
                                     places_.begin() + static_cast<std::ptrdiff_t>(b) - 1,
                                     0.5 * (places_[a] + places_[b]));
    return static_cast<std::size_t>(at - places_.begin());
  }

  // Returns the Lagrange polynomial through the values at `nodes`:
  //   p(x) = sum_i y_i prod_{k != i} (x - x_k) / (x_i - x_k)
  Sample through(const Indices& nodes, double place) const {
    Sample sum{};
    for (const std::size_t i : nodes) {
      double weight = 1;
      for (const std::size_t k : nodes) {
        if (k != i) weight *= (place - places_[k]) / (places_[i] - places_[k]);
      }
      for (std::size_t q = 0; q < sum.size(); ++q) sum[q] += weight * values_[i][q];
    }
    return sum;
  }

  bool is_predicted(const Indices& nodes, std::size_t i) const {
    const Sample guess = through(nodes, places_[i]);
    for (std::size_t q = 0; q < guess.size(); ++q) {
      if (!(std::abs(guess[q] - values_[i][q]) <= tolerance_[q])) return false;
    }
    return true;
  }

  void fill(std::size_t from, std::size_t to) {
    if (to - from < kFewest) {
      for (std::size_t i = from; i <= to; ++i) know(i);
      return;
    }
    const std::size_t half = middle(from, to);
    if (half - from < 2 || to - half < 2) {
      fill(from, half);
      return fill(half, to);
    }
    const std::size_t first = middle(from, half), last = middle(half, to);
    for (const std::size_t i : {from, first, half, last, to}) know(i);
    const Indices three{from, half, to};
    if (!is_predicted(three, first) || !is_predicted(three, last)) {
      fill(from, half);
      return fill(half, to);
    }
    const Indices five{from, first, half, last, to};
    for (std::size_t i = from; i < to; ++i) {
      if (!known_[i]) values_[i] = through(five, places_[i]);
    }
  }

  const std::vector<double>& places_;
  const Sample& tolerance_;
  const std::function<Sample(double)>& compute_;
  std::vector<Sample> values_;
  std::vector<bool> known_;
};

}  // namespace

std::vector<Sample> sampled(const std::vector<double>& places, double longest, const Sample& tolerance,
                            const std::function<Sample(double place)>& compute) {
  return Sampling(places, tolerance, compute).run(longest);
}

}  // namespace halocline::clients

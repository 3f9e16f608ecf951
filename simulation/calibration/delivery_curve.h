// SPDX-License-Identifier: BSD-3-Clause
// Delivery of a link against an offset of its noise, as a calibration interpolates it.
//
// Model: seven offsets about the middle, where the delivery is half of that without noise, found by
// bisection, and the delivery without noise. Between them the normal quantile of the delivery ("score") is
// interpolated by a monotonic cubic, beyond the last linearly: a curve Phi(x / w) is a straight line of
// scores, and one with a plateau below 1 (late echoes) keeps it. Stored at steps of 1 dB, linear between.
#pragma once

#include <array>
#include <cstddef>
#include <functional>

namespace halocline::clients {

class DeliveryCurve {
 public:
  static constexpr double kFirstDb = -60, kStepDb = 1;
  static constexpr std::size_t kCount = 121;
  using Scores = std::array<double, kCount>;

  // A curve that is 0 everywhere.
  DeliveryCurve();
  // `delivery` returns the probability (0 to 1) with that much more noise, dB; it must not rise with it.
  explicit DeliveryCurve(const std::function<double(double)>& delivery);

  const Scores& scores() const { return scores_; }

  // Score at an offset, dB, from `scores`; held at the first and the last of them beyond the table.
  static double score_at(const Scores& scores, double more_noise_db);
  // Delivery probability of a score.
  static double delivery_of(double score);

 private:
  Scores scores_;
};

}  // namespace halocline::clients

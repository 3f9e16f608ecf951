// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/calibration/delivery_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "acoustics/math/functions.h"
#include "core/elementary.h"

namespace halocline::clients {
namespace {

constexpr double kLeast = 1e-9;          // probabilities are held within this and 1 less this
constexpr double kLeastPlateau = 1e-6;   // below: no packet ever arrives
constexpr double kMiddleWithinDb = 0.5;  // precision of the middle
constexpr std::array kOffsetsDb{-12.0, -6.0, -3.0, 0.0, 3.0, 6.0, 12.0};  // about the middle

double score_of(double delivery) {
  return acoustics::normal_quantile(std::clamp(delivery, kLeast, 1 - kLeast));
}

struct Knot {
  double at_db, score;
};

// Slopes of the monotonic cubic of Fritsch and Butland 1984 (SIAM J. Sci. Stat. Comput. 5, 300): the harmonic
// mean of the neighbours' slopes, weighted by the spans.
std::vector<double> slopes_of(const std::vector<Knot>& knots) {
  std::vector<double> secants, slopes(knots.size());
  for (std::size_t i = 1; i < knots.size(); ++i)
    secants.push_back((knots[i].score - knots[i - 1].score) / (knots[i].at_db - knots[i - 1].at_db));
  slopes.front() = secants.front();
  slopes.back() = secants.back();
  for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
    if (secants[i - 1] * secants[i] <= 0) continue;
    const double before = knots[i].at_db - knots[i - 1].at_db, after = knots[i + 1].at_db - knots[i].at_db;
    const double share = (before + 2 * after) / (3 * (before + after));
    slopes[i] = secants[i - 1] * secants[i] / (share * secants[i] + (1 - share) * secants[i - 1]);
  }
  return slopes;
}

double interpolated(const std::vector<Knot>& knots, const std::vector<double>& slopes, double at_db) {
  if (at_db <= knots.front().at_db) return knots.front().score;
  if (at_db >= knots.back().at_db) return knots.back().score + slopes.back() * (at_db - knots.back().at_db);
  std::size_t i = 1;
  while (knots[i].at_db < at_db) ++i;
  const Knot &a = knots[i - 1], &b = knots[i];
  const double h = b.at_db - a.at_db, t = (at_db - a.at_db) / h, u = 1 - t;
  return u * u * (1 + 2 * t) * a.score + t * t * (1 + 2 * u) * b.score +
         h * t * u * (u * slopes[i - 1] - t * slopes[i]);
}

}  // namespace

DeliveryCurve::DeliveryCurve() { scores_.fill(score_of(0)); }

DeliveryCurve::DeliveryCurve(const std::function<double(double)>& delivery) : DeliveryCurve() {
  constexpr double kLastDb = kFirstDb + kStepDb * (kCount - 1);
  const double plateau = delivery(kFirstDb);
  if (plateau < kLeastPlateau) return;
  double loud_db = kLastDb, quiet_db = kFirstDb;
  while (loud_db - quiet_db > kMiddleWithinDb) {
    const double middle_db = 0.5 * (quiet_db + loud_db);
    (delivery(middle_db) > 0.5 * plateau ? quiet_db : loud_db) = middle_db;
  }
  const double middle_db = 0.5 * (quiet_db + loud_db);
  std::vector<Knot> knots{{kFirstDb, score_of(plateau)}};
  for (const double offset_db : kOffsetsDb) {
    const double at_db = middle_db + offset_db;
    // A curve does not rise with the noise, but for the noise of its computation.
    if (at_db > knots.back().at_db + kStepDb)
      knots.push_back({at_db, std::min(score_of(delivery(at_db)), knots.back().score)});
  }
  if (knots.size() < 2) knots.push_back({kLastDb, score_of(0)});
  const std::vector<double> slopes = slopes_of(knots);
  for (std::size_t i = 0; i < kCount; ++i)
    scores_[i] = std::clamp(interpolated(knots, slopes, kFirstDb + kStepDb * static_cast<double>(i)),
                            score_of(0), score_of(1));
}

double DeliveryCurve::score_at(const Scores& scores, double more_noise_db) {
  const double place = std::clamp((more_noise_db - kFirstDb) / kStepDb, 0.0, static_cast<double>(kCount - 1));
  const auto below = std::min(static_cast<std::size_t>(place), kCount - 2);
  const double part = place - static_cast<double>(below);
  return (1 - part) * scores[below] + part * scores[below + 1];
}

double DeliveryCurve::delivery_of(double score) {
  return 0.5 * elementary::erfc(-score / std::numbers::sqrt2);
}

}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/equalizer_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "acoustics/prediction/platform_jitter.h"
#include "acoustics/prediction/steady_band.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kSoundSpeedMps = 1500;  // for the wave number
constexpr double kNegligible = 1e-5;     // share of the power that has no effect
constexpr double kJitterSkewness = 1;    // skewness of a cross term, which is bounded below (our choice)

// A path with the quantities that its pairs need.
struct Member {
  std::size_t path;
  double steady, turned, fast;  // powers
  double steady_root, medium_root;
  // Phase at the centre of the band; phase change over the band in turns, and half of its angle.
  double cos_phase, sin_phase, turns, cos_half, sin_half;
  double launch_sine, arrival_sine;
  double cross_terms = 0, unit = 0;  // block-fading and fast-fading power of the path and its neighbours
};

Member member_of(const EqualizerPath& path, std::size_t index, const Band& band, double reference_s) {
  const double turns = band.width_hz() * (path.delay_s - reference_s), half = pi * turned(turns, 2);
  const double steady = path.signal * path.steady, turned_power = path.signal * path.turned,
               fast = path.signal * path.scattered;
  const auto phase = fast_turn(path.phase_rad), half_turn = fast_turn(half);
  return {.path = index,
          .steady = steady,
          .turned = turned_power,
          .fast = fast,
          .steady_root = std::sqrt(steady),
          .medium_root = std::sqrt(path.signal * path.medium),
          .cos_phase = phase.cosine,
          .sin_phase = phase.sine,
          .turns = turns,
          .cos_half = half_turn.cosine,
          .sin_half = half_turn.sine,
          .launch_sine = fast_turn(path.launch_angle_rad).sine,
          .arrival_sine = fast_turn(path.arrival_angle_rad).sine,
          .cross_terms = steady + turned_power,
          .unit = fast};
}

// Accumulates the sums over pairs of paths.
class PairSums {
 public:
  explicit PairSums(const Band& band, double power)
      : jitter_(2 * pi * band.centre_hz() / kSoundSpeedMps), least_(kNegligible * power) {}

  void add(Member& p, Member& q) {
    // sinc(W tau) by the sine of the difference of the two half angles.
    const double x = pi * (p.turns - q.turns),
                 sinc = std::abs(x) < 1e-6 ? 1 : (p.sin_half * q.cos_half - p.cos_half * q.sin_half) / x;
    const double near = sinc * sinc;
    p.unit += q.fast * near;
    q.unit += p.fast * near;
    p.cross_terms += (q.steady + q.turned) * near;
    q.cross_terms += (p.steady + p.turned) * near;
    turned_variance += 2 * p.turned * q.turned * near;
    mixed_variance += 2 * (p.turned * q.steady + p.steady * q.turned) * near;
    // Correlation of the medium's fading of two paths: exp(-distance^2 / 2) over delay and both angles.
    const double apart = squared(2 * x / pi) + squared((p.launch_sine - q.launch_sine) / kAngle) +
                         squared((p.arrival_sine - q.arrival_sine) / kAngle);
    const double shared = p.medium_root * q.medium_root * fast_exp(-apart / 2);
    const double product = 2 * (p.steady_root * q.steady_root + shared);
    if (product < least_) return;
    const double interference = product * sinc,
                 cosine_part = interference * (p.cos_phase * q.cos_phase + p.sin_phase * q.sin_phase),
                 sine_part = interference * (p.sin_phase * q.cos_phase - p.cos_phase * q.sin_phase);
    crossed += cosine_part * jitter_.add(cosine_part, sine_part, p.launch_sine - q.launch_sine,
                                         p.arrival_sine - q.arrival_sine);
  }

  double jitter_variance() const { return jitter_.variance(); }
  double crossed = 0, turned_variance = 0, mixed_variance = 0;

 private:
  static constexpr double kAngle = 4 * pi / 180;  // angle over which the medium's fading decorrelates
  JitterVariance jitter_;
  double least_;
};

}  // namespace

EqualizerStatistics equalizer_statistics(const std::vector<EqualizerPath>& paths, const Band& band) {
  EqualizerStatistics sound;
  std::vector<Member> members;
  members.reserve(paths.size());
  double steady = 0, turned = 0, strongest = 0;
  for (const EqualizerPath& path : paths) strongest = std::max(strongest, path.signal);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (!(paths[i].signal > kNegligible * strongest)) continue;
    members.push_back(member_of(paths[i], i, band, paths.front().delay_s));
    steady += members.back().steady;
    turned += members.back().turned;
    sound.fast += members.back().fast;
  }
  PairSums pairs(band, steady + turned + sound.fast);
  for (std::size_t i = 0; i < members.size(); ++i) {
    pairs.turned_variance += squared(members[i].turned);
    pairs.mixed_variance += 2 * members[i].turned * members[i].steady;
    for (std::size_t k = i; k-- > 0 && members[i].turns - members[k].turns < kNearCycles;) {
      pairs.add(members[i], members[k]);
    }
  }
  const double apart = steady + turned, together = std::max(apart + pairs.crossed, 0.0);
  const double louder = apart > 0 ? together / apart : 0;
  sound.block_fading.mean = together;
  if (apart > 0) {
    const double own = pairs.turned_variance * squared(louder),
                 mixed = pairs.mixed_variance * squared(louder), medium = turned * louder;
    const double jitter_variance = pairs.jitter_variance();
    sound.block_fading.variance = own + mixed + jitter_variance;
    sound.block_fading.third = kJitterSkewness * jitter_variance * std::sqrt(jitter_variance);
    if (medium > 1e-9 * together) {
      const double kept = own / squared(medium), share = third_share(kept);
      sound.block_fading.third += medium * share * (2 * medium * medium + 3 * mixed / kept);
    }
  }
  std::size_t next = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const EqualizerPath& path = paths[i];
    FadingTerm term{.interference = path.interference * path.scattered,
                    .interference_cross_terms = path.interference * (1 - path.scattered),
                    .squared_spread = squared(path.spread_hz)};
    if (next < members.size() && members[next].path == i) {
      const Member& member = members[next++];
      if (member.fast > 0) {
        term.signal = member.fast;
        term.unit = member.unit;
        term.signal_cross_terms = louder * member.fast * member.cross_terms / member.unit;
        sound.own += member.fast * member.unit;
        sound.cross_terms += 2 * member.fast * member.cross_terms;
      }
    }
    if (term.signal > 0 || term.interference > 0) sound.terms.push_back(term);
  }
  if (apart > 0) sound.cross_terms /= apart;
  return sound;
}

}  // namespace halocline::acoustics

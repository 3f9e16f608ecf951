// SPDX-License-Identifier: BSD-3-Clause
// Equivalent constant levels of a packet for a given block fading: those at which preamble and bits have the
// same outcome as under the fast fading (acoustics/prediction/link_prediction.h has the model).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "acoustics/prediction/equalizer_statistics.h"
#include "acoustics/prediction/fade_statistics.h"
#include "acoustics/prediction/gamma_power.h"
#include "acoustics/prediction/medium_states.h"
#include "acoustics/prediction/reception_statistics.h"
#include "acoustics/reception/reception_curves.h"

namespace halocline::acoustics {

// A level that varies with the fast fading, dB. At the normal score z it is median + z deviation + z^2
// curvature.
struct Level {
  double median_db = 0, deviation_db = 0, curvature_db = 0;
  double at(double z) const { return median_db + z * (deviation_db + z * curvature_db); }
};

// Fading of a phase-shift keying signal within a packet. Its distribution is computed at two thresholds of
// the ratio, the higher and the lower, and interpolated between them.
class FadingSignal {
 public:
  FadingSignal() = default;
  // Only `high` is used when `low` is absent: interference does not matter then.
  FadingSignal(const BandTerms& high, const std::optional<BandTerms>& low, double block_power,
               const Stretches& stretches);

  // State of the signal where its ratio to a disturbance equals each of the thresholds, which descend.
  struct States {
    // Normal score of the probability that the signal is below the threshold.
    std::array<double, ReceptionCurves::kThresholds> scores{};
    // Number of independent parts of a packet, for fades below the threshold.
    std::array<double, ReceptionCurves::kThresholds> parts{};
  };
  States at(const ReceptionCurves::Thresholds& thresholds, double disturbance) const;
  double mean() const { return mean_; }
  double deviation() const { return sides_.back().deviation; }
  // Number of independent parts of a packet for fades that are narrower than the steps of the reception
  // curve.
  double narrow_parts() const { return narrow_parts_; }

 private:
  static constexpr std::size_t kPoints = FadeStatistics::kPoints, kThresholds = ReceptionCurves::kThresholds;
  using Thresholds = std::array<double, kThresholds>;
  // Distribution at one of the two thresholds.
  struct Side {
    double threshold = 0, deviation = 0;
    FadeStatistics::Points points{};
    FadeStatistics::Values logs{};  // logarithms of the powers; unused for powers below 0
    // Reciprocal of the rise to the point: of the logarithm, or of the power where a power is not positive.
    FadeStatistics::Values rises{};
    Side() = default;
    Side(double at_threshold, const FadeStatistics& law, const Stretches& stretches);
    // Looks up `powers`, fastest when they descend; `states.parts` are logarithms.
    void at(const Thresholds& powers, States& states) const;
    double log_parts_at(double power) const;

   private:
    struct Place {
      std::size_t low, high;
      double part;
    };
    Place place(double power, double log_power, std::size_t& above) const;
  };
  std::array<Side, 2> sides_;
  bool alike_ = false;  // true: both thresholds share one distribution
  double mean_ = 0, narrow_parts_ = 1;
};

// Levels of one packet for any block-fading power.
class PacketLevels {
 public:
  // `curves` and `sound` must outlive it.
  PacketLevels(const ReceptionCurves& curves, const ReceptionStatistics& sound);

  // True when the receiver combines the whole band before it decides on bits, as an equaliser does:
  // phase-shift keying.
  bool collects_band() const { return collects_band_; }

  // Level of the mean signal over the preamble while the block-fading power is `block_power`, dB re 1 uPa.
  Level preamble(double block_power) const;
  // Phase-shift keying: fading of the signal within a packet while the block-fading power is `block_power`.
  FadingSignal fading_signal(double block_power) const;
  // Equivalent ratio of signal to noise and interference for the bits, dB. `disturbance` is the noise and
  // mean interference over the band, uPa^2. `parts` is the number of parts of the packet that fade
  // independently: a guess on entry, 0 for none, and the result on return.
  Level bits(const FadingSignal& signal, double disturbance, double& parts) const;
  // True when all bits of a packet with these powers are more likely lost than correct.
  bool is_likely_lost(double block_power, double disturbance) const;
  struct StateAndNoise {
    const BlockFading* block_fading;
    double noise;
  };
  // Upper bound of the result over the ratio to the mean signal.
  static constexpr double kMaxGainDb = 3;
  // Frequency-shift keying: equivalent ratios for at most ExponentialMeans::kMax states, each with its noise
  // and late echoes, uPa^2. The equivalent ratio falls by less than a decibel as they rise by one: fades
  // decide on it.
  void bits(std::span<const StateAndNoise> states, std::span<Level> levels) const;
  Level bits(const BlockFading& block_fading, double noise) const;

 private:
  double loss(const FadingSignal& signal, double disturbance, double& parts) const;
  double narrow_loss(const FadingSignal& signal, double disturbance) const;
  double wide_loss(const FadingSignal& signal, double disturbance, double& parts) const;
  // Thresholds of the ratio below which one of `parts` parts of the packet is lost.
  ReceptionCurves::Thresholds thresholds(double parts) const;
  const ReceptionCurves& curves_;
  const ReceptionStatistics& sound_;
  double chip_, bits_, bits_s_;
  bool coded_, collects_band_;
  double stretches_ = 1;
  std::optional<BandTerms> high_, low_;    // phase-shift keying: the terms of FadingSignal
  double slope_ = 0, errors_at_zero_ = 0;  // frequency-shift keying: fit of -ln(1 - BER) over the ratio
  double own_, cross_terms_;               // variances of ReceptionStatistics after averaging over the bits
};

}  // namespace halocline::acoustics

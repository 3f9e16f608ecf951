// SPDX-License-Identifier: BSD-3-Clause
// What a packet comes to while the slow fading of its link holds: constant levels that decide of its preamble
// and of its bits as the fast fading does (acoustics/reception/link_prediction.h has the model).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "acoustics/reception/band_law.h"
#include "acoustics/reception/collected_sound.h"
#include "acoustics/reception/mean_sound.h"
#include "acoustics/reception/medium_states.h"
#include "acoustics/reception/power_law.h"
#include "acoustics/reception/reception_curves.h"

namespace halocline::acoustics {

// A level over the fast fading, dB, at the normal score z: median + z deviation + z^2 curvature.
struct Level {
  double median_db = 0, deviation_db = 0, curvature_db = 0;
  double at(double z) const { return median_db + z * (deviation_db + z * curvature_db); }
};

// How phase-shift keying fades within a packet, against two thresholds of the ratio between which it changes
// evenly, the higher and the lower.
class FadingSignal {
 public:
  FadingSignal() = default;
  // `low` alone where interference matters.
  FadingSignal(const BandTerms& high, const std::optional<BandTerms>& low, double slow_power,
               const Stretches& stretches);

  // Where the ratio to a disturbance is one of the thresholds, which fall.
  struct States {
    std::array<double, ReceptionCurves::kThresholds> scores{};  // normal, of the signal below the power
    std::array<double, ReceptionCurves::kThresholds>
        parts{};  // independent ones of a packet, of fades below the power
  };
  States at(const ReceptionCurves::Thresholds& thresholds, double disturbance) const;
  double mean() const { return mean_; }
  double deviation() const { return sides_.back().deviation; }
  // Of fades that are less than the steps of the curve.
  double narrow_parts() const { return narrow_parts_; }

 private:
  static constexpr std::size_t kPoints = BandLaw::kPoints, kThresholds = ReceptionCurves::kThresholds;
  using Thresholds = std::array<double, kThresholds>;
  struct Side {
    double threshold = 0, deviation = 0;
    BandLaw::Points points{};
    BandLaw::Values logs{};   // of their powers; of a power below 0, none
    BandLaw::Values rises{};  // 1 over what the logarithm, or else the power, rises by to the point
    Side() = default;
    Side(double at_threshold, const BandLaw& law, const Stretches& stretches);
    // Of powers, best falling; the parts are logarithms.
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
  bool alike_ = false;  // the same for both thresholds
  double mean_ = 0, narrow_parts_ = 1;
};

class PacketLevels {
 public:
  // Both outlive it.
  PacketLevels(const ReceptionCurves& curves, const MeanSound& sound);

  // Whether the band is collected before bits are decided, as an equaliser does: phase-shift keying.
  bool collects_band() const { return collects_band_; }

  // The mean signal over the preamble while the power without fast fading is `slow_power`, uPa^2 in dB.
  Level preamble(double slow_power) const;
  // The ratios to noise and interference, dB, that decide of the bits. Of phase-shift keying: `disturbance`
  // is noise and mean interference, uPa^2 over the band, `parts` a guess of how many fade independently, 0 of
  // none, in which what comes out is left; of frequency-shift keying, noise alone.
  FadingSignal fading_signal(double slow_power) const;
  Level bits(const FadingSignal& signal, double disturbance, double& parts) const;
  // Whether the bits of packets of these are lost rather than right.
  bool is_likely_lost(double slow_power, double disturbance) const;
  struct StateAndNoise {
    const SlowSound* slow;
    double noise;
  };
  // Over the ratio to the mean signal, at most.
  static constexpr double kMostGainDb = 3;
  // Of ExponentialMeans::kMax at most.
  void bits(std::span<const StateAndNoise> states, std::span<Level> levels) const;
  Level bits(const SlowSound& slow, double noise) const;

 private:
  double loss(const FadingSignal& signal, double disturbance, double& parts) const;
  double narrow_loss(const FadingSignal& signal, double disturbance) const;
  double wide_loss(const FadingSignal& signal, double disturbance, double& parts) const;
  // Where so many parts turn from right to wrong.
  ReceptionCurves::Thresholds thresholds(double parts) const;
  const ReceptionCurves& curves_;
  const MeanSound& sound_;
  double chip_, bits_, bits_s_;
  bool coded_, collects_band_;
  double stretches_ = 1;
  std::optional<BandTerms> high_, low_;    // of phase-shift keying: those of FadingSignal
  double slope_ = 0, errors_at_zero_ = 0;  // of -ln(1 - BER) over the ratio
  double own_, beats_;                     // MeanSound's, as the mean over the bits keeps them
};

}  // namespace halocline::acoustics

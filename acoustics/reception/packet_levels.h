// What a packet comes to while the slow fading of its link holds: constant levels that decide of its preamble and of its
// bits as the fast fading does (acoustics/reception/link_prediction.h has the model).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "acoustics/reception/band_law.h"
#include "acoustics/reception/mean_sound.h"
#include "acoustics/reception/power_law.h"
#include "acoustics/reception/reception_curves.h"

namespace halocline::acoustics {

// A level over the fast fading, dB, at the normal score z: median + z deviation + z^2 curvature.
struct Level {
  double median_db = 0, deviation_db = 0, curvature_db = 0;
  double at(double z) const { return median_db + z * (deviation_db + z * curvature_db); }
};

// How the power of phase-shift keying is distributed over its fast fading, against two thresholds of the ratio between
// which it changes evenly.
class FadingSignal {
 public:
  static constexpr std::size_t kPoints = BandLaw::kPoints;

  FadingSignal() = default;
  FadingSignal(const BandLaw& low, const BandLaw& high, const std::array<double, kFadeScores>& parts_low,
               const std::array<double, kFadeScores>& parts_high);

  // Normal scores of the signal below powers, of their logarithms, that rise from call to call, `part` of the way from the
  // low to the high threshold.
  class Scores {
   public:
    explicit Scores(const FadingSignal& signal) : signal_(signal) {}
    double next(double power, double log, double part);

   private:
    const FadingSignal& signal_;
    std::size_t low_ = 0, high_ = 0;  // points above
  };
  // Independent parts of a packet, of fades below a score.
  double parts(double score, double part) const;
  double mean() const { return mean_; }
  double deviation() const { return deviation_; }

 private:
  struct Side {
    BandLaw::Points points;
    std::array<double, kPoints> logs{};  // of their powers
    std::array<double, kFadeScores> parts{};
    double score(double power, double log, std::size_t& above) const;
  };
  Side low_, high_;
  double mean_ = 0, deviation_ = 0;
};

class PacketLevels {
 public:
  // Both outlive it.
  PacketLevels(const ReceptionCurves& curves, const MeanSound& sound);

  // Whether the band is collected before bits are decided, as an equaliser does: phase-shift keying.
  bool collects_band() const { return collects_band_; }

  // The mean signal over the preamble while the power without fast fading is `slow_power`, uPa^2 in dB.
  Level preamble(double slow_power) const;
  // The ratios to noise and interference, dB, that decide of the bits. Of phase-shift keying: `disturbance` is noise and
  // mean interference, uPa^2 over the band; of frequency-shift keying, noise alone.
  FadingSignal fading_signal(double slow_power) const;
  Level bits(const FadingSignal& signal, double disturbance) const;
  Level bits(const SlowSound& slow, double noise) const;

 private:
  std::array<double, kFadeScores> parts_of(const BandLaw& law, double threshold, double slow_power) const;
  double narrow_loss(const FadingSignal& signal, double disturbance) const;
  double wide_loss(const FadingSignal& signal, double disturbance) const;
  double needed(double parts) const;
  // -ln of the mean over a packet of exp(-scale power), and its relative variance over the fast fading.
  struct Cells {
    double nepers = 0, variance = 0;
  };
  Cells cells_of(const SlowSound& slow, double scale) const;

  const ReceptionCurves& curves_;
  const MeanSound& sound_;
  double chip_, bits_, bits_s_;
  bool coded_, collects_band_;
  double stretches_ = 1;
  // Of phase-shift keying: thresholds of FadingSignal, and where between them each ratio lies.
  double low_threshold_ = 0, high_threshold_ = 0, softness_db_ = 0;
  std::array<double, ReceptionCurves::kRatios> between_{}, logs_{};  // of the ratios
  double slope_ = 0, errors_at_zero_ = 0;                            // of -ln(1 - BER) over the ratio
};

}  // namespace halocline::acoustics

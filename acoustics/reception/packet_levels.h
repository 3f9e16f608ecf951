// What a packet comes to while the slow fading of its link holds: constant ratios to noise and interference that decide of
// its preamble and of its bits as the fast fading does (acoustics/reception/link_prediction.h has the model).
#pragma once

#include "acoustics/reception/mean_sound.h"
#include "acoustics/reception/reception_curves.h"

namespace halocline::acoustics {

// A ratio in dB over the fast fading, at the standard normal z: median + z deviation + z^2 curvature.
struct Level {
  double median_db = 0, deviation_db = 0, curvature_db = 0;
  double at(double z) const { return median_db + z * (deviation_db + z * curvature_db); }
};

class PacketLevels {
 public:
  // Both outlive it.
  PacketLevels(const ReceptionCurves& curves, const MeanSound& sound);

  // `noise` in uPa^2 over the band.
  Level preamble(const SlowSound& slow, double noise) const;
  Level bits(const SlowSound& slow, double noise) const;

 private:
  double mean_db(const SlowSound& slow, double quiet) const;
  Level interleaved(const SlowSound& slow, double noise) const;
  double product(const SlowSound& slow, double noise) const;
  double fades(const SlowSound& slow, double noise) const;
  double errors(const SlowSound& slow, double noise) const;
  double relative_variance(double mean, double variance, double quiet) const;
  double below_threshold(double v, double least, double constant) const;
  double below_linear(double mean, double variance, double quiet, double constant) const;
  double again(double v, double least) const;

  const ReceptionCurves& curves_;
  const MeanSound& sound_;
  double chip_, bits_;
  bool coded_, collects_band_;
  double stretches_ = 1, crossings_ = 0;  // of the bits; of a threshold, in each
  // Bits that fade together; the ratio that half of them need, and the deviation of its logarithm.
  double fade_bits_ = 0, threshold_ = 0, width_ = 0;
  double slope_ = 0, errors_at_zero_ = 0;  // of -ln(1 - BER) over the ratio
};

}  // namespace halocline::acoustics

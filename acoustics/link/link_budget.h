// SPDX-License-Identifier: BSD-3-Clause
// Link budget of one straight link: delay, loss, level, noise, signal-to-noise ratio and capacity between two
// points.
//
// Model (docs/validation.md lists what each part is checked against):
//   delay       integral of ds / c(z) along the path
//   absorption  integral of alpha(z, f) ds: at the centre frequency for the levels, over the band for the
//               capacity
//   loss        TL = k 10 log10 l + that integral (0 below 1 m) + the loss of both beams along the line
//   level       RL = SL - TL
//   noise       NL = 10 log10 of the integral of N(f) df over the transmitter's band
//   ratio       SNR = SL - TL - NL + DI; `snr_narrowband` has NL = N(fc) + 10 log10 B, equation 7 of the
//               2010 IEEE SMC paper
//   capacity    integral of log2(1 + DI (P/B) / (A N)) df over the band; equation 8 of that paper when DI is
//               0 dB
// Signal and noise are those in the transmitter's band; the receiver contributes its directivity index and
// its cut-off level. Path integrals have a relative error below 1e-12, the capacity below 1e-9.
//
//   const LinkModel model(environment, transmitter, receiver);  // once for a pair of modems
//   const LinkBudget link = model.budget(from_ned_m, to_ned_m); // microseconds, any number of times
//
// Left out: refraction, echoes (acoustics/link/bottom_echo.h), terrain, motion during the time of flight.
#pragma once

#include <vector>

#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::acoustics {

// Budget of one link. Levels without a reference are in dB.
struct LinkBudget {
  double range_m = 0;               // straight distance
  double delay_s = 0;               // one way
  double mean_sound_speed_mps = 0;  // along the path, range / delay; at range 0 the speed of the place
  double absorption_db_per_km = 0;  // mean along the path, at the centre frequency
  Decibels transmission_loss;       // at the centre frequency
  Decibels received_level;          // dB re 1 uPa
  Decibels noise_level;             // dB re 1 uPa over the band
  Decibels noise_spectrum_level;    // dB re 1 uPa^2/Hz at the centre frequency
  Decibels snr;                     // noise integrated over the band; reduced by the band_loss of the modems
  Decibels snr_narrowband;  // noise at the centre frequency times the bandwidth (equation 7); reduced too
  double capacity_bps = 0;  // bit/s, over the part of the band that both modems share
  bool receivable = false;  // one family, overlapping bands, and received level >= the cut-off
};

// Depression angle of the straight line from one point to another, -pi/2..pi/2, positive down; 0 between
// equal points.
double angle_down_rad(const Vec3& from_ned_m, const Vec3& to_ned_m);

// Terms of the budget that depend on the two modems and the noise alone, not on positions. Immutable.
class LinkTerms {
 public:
  // Throws InvalidArgument when an argument is out of range (see their `validate`).
  LinkTerms(const Environment& environment, const Modem& transmitter, const Modem& receiver);

  // Sets level, noise, ratios and `receivable` for a given loss; the noise is `above_ambient` above that of
  // the environment.
  void set_levels(LinkBudget& link, Decibels loss, Decibels above_ambient = {}) const;
  // Loss of both beams along the straight line; the receiver's beam points back along it.
  Decibels beam_loss(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  // DI (P/B) / N(f): ratio of signal to noise density at 1 m.
  double unit_ratio(double frequency_hz) const;
  // The part of the transmitter's band that lies in the receiver's; its width is 0 or negative when there is
  // none.
  Band shared_band() const;

  const Environment& environment() const { return environment_; }
  const Modem& transmitter() const { return transmitter_; }
  const Modem& receiver() const { return receiver_; }
  Decibels noise_level() const { return noise_level_; }  // over the transmitter's band

 private:
  Environment environment_;
  Modem transmitter_, receiver_;
  Decibels noise_level_, centre_noise_, gain_, bandwidth_;
  double density_ = 0;        // signal at 1 m times the receiver's directivity, uPa^2/Hz
  bool of_one_kind_ = false;  // one family, and overlapping bands
};

// A link by direct evaluation of the formulas: the reference for acoustics/link/link_kernel.h, which the
// simulator uses. Owns copies of its arguments; immutable, so calls may overlap between threads. Construction
// takes about a millisecond.
class LinkModel {
 public:
  // Throws InvalidArgument when an argument is out of range (see their `validate`).
  LinkModel(const Environment& environment, const Modem& transmitter, const Modem& receiver);

  // Budget between two positions in the NED world frame, m. Depths follow from the environment's
  // sea_surface_z_m. Above the surface the water of the surface is used: the caller decides if such a link
  // exists.
  LinkBudget budget(const Vec3& from_ned_m, const Vec3& to_ned_m) const;

  // Budget for a path that another model found. `loss` is that at the centre frequency; at other frequencies
  // of the band it differs by the difference of absorption of the water between the two depths over
  // `path_length_m`. Delay and absorption remain those of the straight path.
  LinkBudget budget_of_path(const Vec3& from_ned_m, const Vec3& to_ned_m, Decibels loss,
                            double path_length_m) const;

 private:
  // A depth of a path at which absorption is sampled, and the share of the path that it represents.
  struct Sample;
  struct Samples;

  void tabulate_absorption();
  Samples sample_path(double from_depth_m, double to_depth_m) const;
  double mean_absorption(const Samples& samples, std::size_t frequency) const;
  double capacity(const Samples& samples, double range_m, Decibels beams) const;
  double capacity_of_path(const Samples& samples, Decibels loss, double path_length_m) const;

  LinkTerms terms_;
  // Index 0 is the centre frequency, of weight 0; the others are the nodes of the band.
  std::vector<double> frequency_khz_squared_, weight_hz_;
  std::vector<double> unit_ratio_;
  // [boundary * frequencies + frequency]: integral of alpha dz from the surface to that boundary, dB/km * m.
  std::vector<double> absorption_to_boundary_;
};

}  // namespace halocline::acoustics

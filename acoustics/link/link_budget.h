// SPDX-License-Identifier: BSD-3-Clause
// The quality of one straight link: delay, loss, level, noise, signal-to-noise ratio and capacity between two
// points.
//
// Model (docs/validation.md lists what each part is checked against):
//   delay       integral of ds / c(z) along the path
//   absorption  integral of alpha(z, f) ds: at the centre frequency for the levels, over the band for the
//               capacity
//   loss        TL = k 10 log l + that integral (0 below 1 m) + the loss of both beams along the line
//   level       RL = SL - TL
//   noise       NL = 10 log of the integral of N(f) df over the transmitter's band
//   ratio       SNR = SL - TL - NL + DI; `snr_narrowband` with NL = N(fc) + 10 log B, the paper's equation 7
//   capacity    integral of log2(1 + DI (P/B) / (A N)) df over the band; equation 8 where DI is 0 dB
// Signal and noise are taken in the transmitter's band; the receiver adds its directivity index and its
// cut-off. Path integrals err by less than 1e-12, capacity by less than 1e-9 (relative).
//
//   const LinkModel model(environment, transmitter, receiver);  // once for a pair of modems
//   const LinkBudget link = model.budget(from_ned_m, to_ned_m); // microseconds, any number of times
//
// Left out: bending, echoes (acoustics/link/multipath.h), terrain, motion during the flight.
#pragma once

#include <vector>

#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "core/frames.h"
#include "core/units.h"

namespace halocline::acoustics {

struct LinkBudget {
  double range_m = 0;               // straight distance
  double delay_s = 0;               // one way
  double mean_sound_speed_mps = 0;  // along the path, range / delay; at zero range the speed of the place
  double absorption_db_per_km = 0;  // mean along the path, at the centre frequency
  Decibels transmission_loss;       // at the centre frequency
  Decibels received_level;          // dB re 1 uPa
  Decibels noise_level;             // dB re 1 uPa over the band
  Decibels noise_spectrum_level;    // dB re 1 uPa^2/Hz at the centre frequency
  Decibels snr;             // with the noise integrated over the band, less the band_loss of the modems
  Decibels snr_narrowband;  // with the noise of the centre all over the band (equation 7), likewise
  double capacity_bps = 0;  // bit/s, of the part of the band that the receiver has too
  bool receivable = false;  // of one family, bands overlap, received level >= the cut-off
};

// Angle of the straight line from one point to another below the horizontal, -pi/2..pi/2; 0 between equal
// points.
double angle_down_rad(const Vec3& from_ned_m, const Vec3& to_ned_m);

// What of a link the two modems and the noise decide, wherever they are. Immutable.
class LinkTerms {
 public:
  // Throws InvalidArgument when one of them is out of range (see their `validate`).
  LinkTerms(const Environment& environment, const Modem& transmitter, const Modem& receiver);

  // Level, noise, ratios and whether the link is receivable, at a loss; noise lies `above_ambient` over that
  // of the environment.
  void set_levels(LinkBudget& link, Decibels loss, Decibels above_ambient = {}) const;
  // Of both beams along the straight line: the receiver looks back.
  Decibels beam_loss(const Vec3& from_ned_m, const Vec3& to_ned_m) const;
  // DI (P/B) / N(f): signal to noise densities at 1 m.
  double unit_ratio(double frequency_hz) const;
  // The part of the transmitter's band that the receiver has too; of no width or less where it has none.
  Band shared_band() const;

  const Environment& environment() const { return environment_; }
  const Modem& transmitter() const { return transmitter_; }
  const Modem& receiver() const { return receiver_; }
  Decibels noise_level() const { return noise_level_; }  // over the transmitter's band

 private:
  Environment environment_;
  Modem transmitter_, receiver_;
  Decibels noise_level_, centre_noise_, gain_, bandwidth_;
  double density_ = 0;        // of the signal at 1 m, times the receiver's directivity, uPa^2/Hz
  bool of_one_kind_ = false;  // one family, and bands that overlap
};

// A link by the formulas as they stand: the reference of acoustics/link/link_kernel.h, which the simulator
// uses. Owns copies of what it needs; immutable, so calls may overlap between threads. Making one costs about
// a millisecond.
class LinkModel {
 public:
  // Throws InvalidArgument when one of them is out of range (see their `validate`).
  LinkModel(const Environment& environment, const Modem& transmitter, const Modem& receiver);

  // Positions in the NED world frame, m. Depths follow from the environment's sea_surface_z_m; above the
  // surface the water of the surface is used (whether such a link exists is for the caller to decide).
  LinkBudget budget(const Vec3& from_ned_m, const Vec3& to_ned_m) const;

  // The same for a path that some other model found: its loss at the centre frequency as given, and elsewhere
  // in the band as much more or less as water between the two depths absorbs more or less over
  // `path_length_m`. Delay and absorption stay those of the straight path.
  LinkBudget budget_of_path(const Vec3& from_ned_m, const Vec3& to_ned_m, Decibels loss,
                            double path_length_m) const;

 private:
  // A place along the depth of a path where absorption is sampled, and its share of the path.
  struct Sample;
  struct Samples;

  void tabulate_absorption();
  Samples sample_path(double from_depth_m, double to_depth_m) const;
  double mean_absorption(const Samples& samples, std::size_t frequency) const;
  double capacity(const Samples& samples, double range_m, Decibels beams) const;
  double capacity_of_path(const Samples& samples, Decibels loss, double path_length_m) const;

  LinkTerms terms_;
  // Index 0 is the centre frequency (of weight 0), the rest are the nodes of the band.
  std::vector<double> frequency_khz_squared_, weight_hz_;
  std::vector<double> unit_ratio_;
  // [boundary * frequencies + frequency]: integral of alpha dz from the surface to that boundary, dB/km * m.
  std::vector<double> absorption_to_boundary_;
};

}  // namespace halocline::acoustics

// Power of a link's coherent paths over the band, by the parts of it in which a signal is evaluated (signal_history.h).
//
// Model: paths whose delays differ by d interfere with a period of 1 / d over the band. Each part is sampled at places
// apart by no more than half of 1 / (guard time + taper), so that neither the power of two paths in the window nor its square
// seems to be the same at all of them. Of a part's mean power S and its variance V over the samples,
//   constant = sqrt(S^2 - V), varying = S - constant
// are those of a steady and a diffuse signal (Rice 1945) of the same S and V. Both follow the delays, not the phases, of
// paths that interfere many times over a part: a vehicle that moves by a wavelength does not change them.
#pragma once

#include <array>
#include <cstddef>

#include "acoustics/math/frequency_band.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/signal_history.h"

namespace halocline::acoustics {

class SteadyBand {
 public:
  struct Part {
    double constant = 0, varying = 0;  // of the power, uPa^2
  };

  SteadyBand(const Modem& receiver, const Band& band);
  // A path of this pressure, phase at the band's low end and delay relative to all the others'.
  void add(double pressure, double phase_rad, double excess_s);
  // From low to high.
  std::array<Part, kSignalFrequencies> parts() const;

 private:
  static constexpr std::size_t kMaxSamples = 32;  // of a part

  double spacing_hz_;  // of samples
  std::size_t samples_;
  using Samples = std::array<double, kMaxSamples>;
  std::array<Samples, kSignalFrequencies> re_{}, im_{};
};

}  // namespace halocline::acoustics

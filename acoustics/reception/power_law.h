// How a fading power is distributed: gamma distributed beside a constant, by its first three cumulants.
//
// Exact for one scattered path (exponential) and for equal ones (gamma); of a steady path with a scattered one (Rice) within
// 0.5 dB from the 1 % quantile up. A negative third cumulant mirrors it: interference that fades more than the signal.
// Quantiles are tabulated once, over the normal score of the probability, -4.5..4.5, and the skewness, 0.1..2; the error is
// below 0.05 dB.
#pragma once

#include <array>
#include <cstddef>

namespace halocline::acoustics {

struct PowerLaw {
  double mean = 0, variance = 0, third = 0;

  // The value that is fallen below with the probability that a standard normal falls below `z`.
  double at(double z) const;
};

// Of a gamma variable of mean 1 whose skewness is `skewness`, 0.1..2: variance = skewness^2 / 4.
double gamma_quantile(double z, double skewness);

// In how many parts of a packet a power fades independently, as far as fades below a level go: the packet stays above it as
// often as that many independent powers do.
//
// The power of mean 1 is a gamma process of that skewness whose autocorrelation is exp(-(2 pi B tau)^2), met at `stretches`
// instants, each `turns` = B tau after the one before. It stays above x in all of them with the probability
//   (1 - p) (1 - q / (1 - p))^((stretches - 1) (1 + e)),  q = p (1 - p) (1 - exp(-nu / (p (1 - p))))
// p its probability below x, nu = 2 sqrt(pi) turns (k x)^(k - 1/2) exp(-k x) / Gamma(k) the crossings of x a stretch (Rice
// 1944), k = 4 / skewness^2; e = 0.27 exp(-(turns / 0.12)^2) because the crossings of so smooth a process keep apart: our fit to
// 6000 realisations each of k 1..8 and B T 0.05..10, within 3 %.
inline constexpr std::size_t kFadeScores = 6;  // normal scores of the level, kLeastFadeScore + i
inline constexpr double kLeastFadeScore = -4;
std::array<double, kFadeScores> independent_parts(double skewness, double stretches, double turns);

}  // namespace halocline::acoustics

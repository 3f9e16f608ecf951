// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/reception/signal_history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/functions.h"
#include "acoustics/modem/receiver_kind.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr std::size_t kFrequencies = kSignalFrequencies;
constexpr double kMinStretches = 8, kMaxStretches = 64;  // stretches of the bits
constexpr double kTrackingTimeS = 0.05;                  // phase-shift keying, against fading
constexpr double kPhaseLockTimeS = 0.01;  // phase-shift keying, against a residual Doppler shift

// Share of the signal that remains when tracked over `time_s`: exp(-(2 pi B T)^2 / 2).
double kept_over(double time_s, double spread_hz) {
  return elementary::exp(-squared(2 * pi * spread_hz * time_s) / 2);
}

// Interval during which a packet is present on a path, from the begin of the window.
struct Sounding {
  double begin_s, end_s;
};

Sounding sounding(const Arrival& path, const Arrival& first, const Arrival& strongest, double duration_s) {
  const double begin_s = path.delay_s - first.delay_s;
  return {begin_s, begin_s + duration_s * strongest.doppler_factor / path.doppler_factor};
}

// Share of the interval from `from_s` to `to_s` during which the path is present; of an instant, 0 or 1.
double share_within(const Sounding& sounding, double from_s, double to_s) {
  if (!(to_s > from_s)) return from_s >= sounding.begin_s && from_s < sounding.end_s ? 1 : 0;
  return std::clamp((std::min(sounding.end_s, to_s) - std::max(sounding.begin_s, from_s)) / (to_s - from_s),
                    0.0, 1.0);
}

// Appends the edges of `count` equal stretches from `from_s` to `to_s`, without the last.
void add_edges(double from_s, double to_s, int count, std::vector<double>& edges) {
  for (int i = 0; i < count; ++i) edges.push_back(from_s + (to_s - from_s) * i / count);
}

// Cycles of `frequency_hz` in a delay, modulo whole cycles.
double cycles_in(double frequency_hz, double delay_s) { return std::fmod(frequency_hz * delay_s, 1.0); }

// Pressure of the signal at each frequency in one stretch: from one frequency to the next a path turns by a
// constant phase factor. Coded frequency-shift keying hops: in each stretch it is evaluated at another of
// kFrequencies places of each part of the band, in an order that covers the part quickly. Uncoded keying
// stays in the middle.
class BandSum {
 public:
  BandSum(const std::vector<Arrival>& paths, const Synchronisation& sync, const Band& band)
      : places_(is_coded_frequency_shift_keying(sync.modem->error_model) ? kFrequencies : 1) {
    const Arrival& strongest = paths[sync.window.strongest];
    const double spacing_hz = band.width_hz() / kFrequencies,
                 step_hz = spacing_hz / static_cast<double>(places_);
    for (std::size_t p = 0; p < paths.size(); ++p) {
      const double excess_s = paths[p].delay_s - strongest.delay_s;
      const Complex between = elementary::polar(1.0, -2 * pi * cycles_in(step_hz, excess_s));
      Complex turn = elementary::polar(sync.window.shares[p].weight,
                                       -2 * pi * cycles_in(band.low_hz + step_hz / 2, excess_s));
      for (std::size_t i = 0; i < places_; ++i, turn *= between) first_.push_back(turn);
      next_.push_back(elementary::polar(1.0, -2 * pi * cycles_in(spacing_hz, excess_s)));
    }
  }
  // Adds path `p` of the response `h` to the sums, one for each frequency.
  void add(std::size_t p, Complex h, std::size_t stretch, std::array<Complex, kFrequencies>& sums) const {
    constexpr std::array<std::size_t, kFrequencies> kOrder{0, 4, 2, 6, 1, 5, 3, 7};
    Complex term = h * first_[p * places_ + kOrder[stretch % places_]];
    for (Complex& sum : sums) {
      sum += term;
      term *= next_[p];
    }
  }

 private:
  std::size_t places_;
  std::vector<Complex> first_, next_;  // first_: by path, then by place
};

// Mean signal power over the band in one stretch. Two paths p, q that are apart by tau contribute
//   2 w_p w_q Re(h_p h_q* sinc(width tau) exp(-j 2 pi f_c tau)).
class BandMean {
 public:
  BandMean(const std::vector<Arrival>& paths, const Synchronisation& sync, const Band& band) {
    for (std::size_t p = 0; p < paths.size(); ++p) {
      if (!(sync.window.shares[p].weight > 0)) continue;
      for (const std::size_t q : within_) {
        const double apart_s = paths[p].delay_s - paths[q].delay_s;
        pairs_.push_back(elementary::polar(
            2 * sync.window.shares[p].weight * sync.window.shares[q].weight * sinc(band.width_hz() * apart_s),
            -2 * pi * cycles_in(band.centre_hz(), apart_s)));
      }
      within_.push_back(p);
      squares_.push_back(squared(sync.window.shares[p].weight));
    }
  }
  // The mean power for the `responses` of all paths.
  double of(const std::vector<Complex>& responses) const {
    double power = 0;
    std::size_t pair = 0;
    for (std::size_t i = 0; i < within_.size(); ++i) {
      const Complex h = responses[within_[i]];
      Complex with_earlier = 0;
      for (std::size_t k = 0; k < i; ++k, ++pair)
        with_earlier += std::conj(responses[within_[k]]) * pairs_[pair];
      power += squares_[i] * std::norm(h) + (h * with_earlier).real();
    }
    return std::max(power, 0.0);
  }

 private:
  std::vector<std::size_t> within_;  // paths in the window
  std::vector<double> squares_;      // squared weights of those paths
  std::vector<Complex> pairs_;       // each path with those before it
};

SignalHistory::ReceiverTerms receiver_terms(const Modem& modem) {
  return {to_power_ratio(modem.receiver_loss).value, static_cast<double>(modem.receiver_channels)};
}

// Appends equal stretches with their signal and echoes to the history.
class HistoryMaker {
 public:
  HistoryMaker(const PathResponses& fading, double large_scale, const std::vector<Arrival>& paths,
               const Synchronisation& sync, const Band& band, SimTime begin, const ReceivedTiming& timing)
      : fading_(fading),
        large_scale_(large_scale),
        paths_(paths),
        sync_(sync),
        band_(band),
        begin_(begin),
        timing_(timing),
        collects_band_(!is_frequency_shift_keying(sync.modem->error_model)),
        sums_over_band_(collects_band_ ? std::vector<Arrival>() : paths, sync, band),
        mean_over_band_(collects_band_ ? paths : std::vector<Arrival>(), sync, band),
        turned_(paths.size()) {
    history_.frequencies = collects_band_ ? 1 : kFrequencies;
    history_.receiver = receiver_terms(*sync.modem);
    for (const Arrival& path : paths) {
      tracked_.push_back(tracked_share(*sync.modem, path));
    }
  }

  void add(double from_s, double to_s, int count) {
    const double step_s = (to_s - from_s) / count;
    const FadingTimes times{from_s + step_s / 2, step_s, count};
    const auto responses = fading_.responses(paths_, band_, begin_, times, large_scale_);
    add_edges(from_s, to_s, count, history_.edges_s);
    for (int i = 0; i < count; ++i) add_stretch(responses, times, i);
  }
  SignalHistory take() {
    history_.edges_s.push_back(timing_.duration_s);
    return std::move(history_);
  }

 private:
  void add_stretch(const std::vector<Complex>& responses, const FadingTimes& times, int i) {
    const Arrival &first = paths_[sync_.window.first], &strongest = paths_[sync_.window.strongest];
    const double at_s = times.begin_s + i * times.step_s;
    std::array<Complex, kFrequencies> sums{};
    double echoes = 0, fast = 0;
    for (std::size_t p = 0; p < paths_.size(); ++p) {
      const Complex h = responses[p * static_cast<std::size_t>(times.count) + static_cast<std::size_t>(i)];
      const double power = std::norm(h), w2 = squared(sync_.window.shares[p].weight);
      const Sounding when = sounding(paths_[p], first, strongest, timing_.duration_s);
      const double sounds = share_within(when, at_s - times.step_s / 2, at_s + times.step_s / 2),
                   untracked = w2 * (1 - tracked_[p]);
      echoes += (sync_.window.shares[p].interference + untracked) * power * sounds;
      fast += untracked * power * sounds;
      if (!(w2 > 0)) continue;
      const double turned = band_.centre_hz() * (paths_[p].doppler_factor - strongest.doppler_factor) * at_s;
      turned_[p] = h * elementary::polar(std::sqrt(tracked_[p]), 2 * pi * turned);
      if (!collects_band_) sums_over_band_.add(p, turned_[p], static_cast<std::size_t>(i), sums);
    }
    if (collects_band_) {
      history_.signal.push_back(mean_over_band_.of(turned_));
    } else {
      for (const Complex& sum : sums) history_.signal.push_back(std::norm(sum));
    }
    history_.echoes.push_back(echoes);
    history_.fast_fading.push_back(fast);
  }

  const PathResponses& fading_;
  double large_scale_;
  const std::vector<Arrival>& paths_;
  const Synchronisation& sync_;
  Band band_;
  SimTime begin_;
  ReceivedTiming timing_;
  bool collects_band_;
  BandSum sums_over_band_;
  BandMean mean_over_band_;
  std::vector<Complex> turned_;  // responses of the paths in the window, in one stretch
  std::vector<double> tracked_;  // share of each path's power that the receiver follows
  SignalHistory history_;
};

}  // namespace

double SignalHistory::mean_signal(std::size_t stretch) const {
  double sum = 0;
  for (std::size_t m = 0; m < frequencies; ++m) sum += signal[stretch * frequencies + m];
  return sum / static_cast<double>(frequencies);
}

double doppler_share(const Modem& receiver, const Arrival& strongest, double centre_hz) {
  const double residual_hz =
      std::max(std::abs(strongest.doppler_factor - 1) - receiver.doppler_correction, 0.0) * centre_hz;
  if (residual_hz == 0) return 1;
  if (!is_frequency_shift_keying(receiver.error_model)) return kept_over(kPhaseLockTimeS, residual_hz);
  const double chip_s = receiver.chip > SimDuration() ? receiver.chip.seconds() : 1 / receiver.bit_rate_bps;
  return squared(sinc(residual_hz * chip_s));
}

double tracked_share(const Modem& receiver, const Arrival& path) {
  return receiver.receiver != ReceiverKind::kEqualiser || is_frequency_shift_keying(receiver.error_model)
             ? 1
             : kept_over(kTrackingTimeS, path.fading.doppler_spread_hz);
}

double coherence_time_s(const std::vector<Arrival>& paths, const GuardWindow& window) {
  double weight = 0, squares = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (!(window.shares[i].weight > 0)) continue;
    const double power = squared(window.shares[i].weight) * fast_power(paths[i].level.value);
    weight += power;
    squares += power * squared(paths[i].fading.doppler_spread_hz);
  }
  return coherence_time_of(weight > 0 ? std::sqrt(squares / weight) : 0);
}

SignalHistory signal_history(const FadingModel& model, const FadingLink& link, double large_scale,
                             const std::vector<Arrival>& paths, const Synchronisation& sync, const Band& band,
                             SimTime begin, const ReceivedTiming& timing) {
  if (!model.enabled) return still_history(paths, sync, timing);
  return signal_history(LinkFading(model, link), large_scale, paths, sync, band, begin, timing);
}

SignalHistory signal_history(const PathResponses& fading, double large_scale,
                             const std::vector<Arrival>& paths, const Synchronisation& sync, const Band& band,
                             SimTime begin, const ReceivedTiming& timing) {
  HistoryMaker maker(fading, large_scale, paths, sync, band, begin, timing);
  const double coherence_s = coherence_time_s(paths, sync.window),
               bits_s = timing.duration_s - timing.preamble_s;
  const auto stretches = [&](double span_s, double least) {
    return static_cast<int>(std::clamp(std::ceil(4 * span_s / coherence_s), least, kMaxStretches));
  };
  if (timing.preamble_s > 0) {
    maker.add(0, timing.preamble_s, std::min(stretches(timing.preamble_s, 1), 8));
  }
  maker.add(timing.preamble_s, timing.duration_s, stretches(bits_s, kMinStretches));
  return maker.take();
}

SignalHistory shifted_history(SignalHistory history, double share) {
  for (std::size_t i = 0; i < history.stretches(); ++i) {
    const double lost = (1 - share) * history.mean_signal(i);
    history.echoes[i] += lost;
    history.fast_fading[i] += lost;
  }
  for (double& power : history.signal) power *= share;
  return history;
}

SignalHistory still_history(const std::vector<Arrival>& paths, const Synchronisation& sync,
                            const ReceivedTiming& timing) {
  const Arrival &first = paths[sync.window.first], &strongest = paths[sync.window.strongest];
  SignalHistory history;
  history.receiver = receiver_terms(*sync.modem);
  history.edges_s = {0, timing.preamble_s, timing.duration_s};
  struct Echo {
    Sounding when;
    double power;
  };
  std::vector<Echo> own_echoes;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    if (!(sync.window.shares[p].interference > 0)) continue;
    const Sounding when = sounding(paths[p], first, strongest, timing.duration_s);
    own_echoes.push_back({when, sync.window.shares[p].interference * to_power_ratio(paths[p].level).value});
    for (const double edge : {when.begin_s, when.end_s}) {
      if (edge > 0 && edge < timing.duration_s) history.edges_s.push_back(edge);
    }
  }
  std::sort(history.edges_s.begin(), history.edges_s.end());
  history.edges_s.erase(std::unique(history.edges_s.begin(), history.edges_s.end()), history.edges_s.end());
  const double signal = mean_signal(paths, sync.window);
  history.signal.reserve(history.edges_s.size() - 1);
  history.echoes.reserve(history.edges_s.size() - 1);
  history.fast_fading.assign(history.edges_s.size() - 1, 0);
  for (std::size_t i = 0; i + 1 < history.edges_s.size(); ++i) {
    double echoes = 0;
    for (const Echo& echo : own_echoes) {
      if (echo.when.begin_s < history.edges_s[i + 1] && echo.when.end_s > history.edges_s[i])
        echoes += echo.power * share_within(echo.when, history.edges_s[i], history.edges_s[i + 1]);
    }
    history.signal.push_back(signal);
    history.echoes.push_back(echoes);
  }
  return history;
}

}  // namespace halocline::acoustics

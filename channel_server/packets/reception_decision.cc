// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/packets/reception_decision.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <tuple>
#include <utility>

#include "acoustics/modem/modem.h"
#include "acoustics/modem/packet_format.h"
#include "acoustics/reception/decoding.h"
#include "core/random.h"

namespace halocline::channel_server {

using acoustics::DisturbingPowers;
using acoustics::LossReason;

namespace {

// The sum of the powers of many paths over [begin, end), as a step function of time.
class PowerSteps {
 public:
  PowerSteps(const std::vector<Interference>& paths, SimTime begin, SimTime end) {
    struct Change {
      SimTime at;
      double power;
    };
    if (paths.empty()) return;
    std::vector<Change> changes;
    changes.reserve(1 + 2 * paths.size());
    changes.push_back({begin, 0});
    for (const Interference& path : paths) {
      if (path.end <= begin || path.begin >= end) continue;
      changes.push_back({std::max(path.begin, begin), path.power});
      if (path.end < end) changes.push_back({path.end, -path.power});
    }
    std::sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
      return std::tie(a.at, a.power) < std::tie(b.at, b.power);
    });
    steps_.reserve(changes.size());
    double power = 0;
    for (std::size_t i = 0; i < changes.size(); ++i) {
      power += changes[i].power;
      // Rounding may leave a small negative sum after the last path has ended.
      if (i + 1 == changes.size() || changes[i + 1].at > changes[i].at)
        steps_.push_back({changes[i].at, std::max(power, 0.0)});
    }
  }
  // Calls visit(seconds, power) for each interval of constant power within [from, to), a part of [begin,
  // end).
  template <class Visitor>
  void for_each_stretch(SimTime from, SimTime to, Visitor&& visit) const {
    if (steps_.empty()) return visit((to - from).seconds(), 0.0);
    auto step = std::upper_bound(steps_.begin(), steps_.end(), from,
                                 [](SimTime time, const Step& one) { return time < one.from; });
    while (from < to) {
      const SimTime until = step == steps_.end() ? to : std::min(step->from, to);
      visit((until - from).seconds(), std::prev(step)->power);
      from = until;
      ++step;
    }
  }

 private:
  struct Step {
    SimTime from;
    double power;
  };
  std::vector<Step> steps_;  // ascending, the first at `begin`; empty without paths
};

// The means of the signal, of the packet's own echoes and of the part of these by fast fading over a part of
// the packet, uPa^2; their values at its first instant if the part has no duration.
struct SignalMeans {
  double signal = 0, echoes = 0, fast_fading = 0;
};

SignalMeans means_of(const ReceivedSignal& signal, SimTime begin, SimTime end) {
  const acoustics::SignalHistory& history = signal.history;
  const double from_s = (begin - signal.begin).seconds(), to_s = (end - signal.begin).seconds();
  SignalMeans sums;
  double weight = 0;
  for (std::size_t i = 0; i < history.stretches(); ++i) {
    const double a = std::max(history.edges_s[i], from_s), b = std::min(history.edges_s[i + 1], to_s);
    const bool instant = to_s <= from_s && history.edges_s[i] <= from_s && from_s < history.edges_s[i + 1];
    const double share = instant ? 1 : b - a;
    if (!(share > 0)) continue;
    sums.signal += share * history.mean_signal(i);
    sums.echoes += share * history.echoes[i];
    sums.fast_fading += share * history.fast_fading[i];
    weight += share;
  }
  if (!(weight > 0)) return {};
  return {sums.signal / weight, sums.echoes / weight, sums.fast_fading / weight};
}

// Returns the noise that the receiver meets, with its losses, uPa^2.
double noise_met(const ReceivedSignal& signal) {
  return signal.history.receiver.noise_loss * (signal.noise + signal.impulses);
}

// Returns the ratio of means over [begin, end), n the hydrophones:
//   SINR = n mean S / (N + mean echoes + mean I + mean bursts)
PowerRatio mean_sinr(const ReceivedSignal& signal, const std::vector<Interference>& others, SimTime begin,
                     SimTime end) {
  const SignalMeans means = means_of(signal, begin, end);
  return {signal.history.receiver.channels * means.signal /
          (noise_met(signal) + means.echoes + mean_power(others, begin, end) +
           mean_power(signal.bursts, begin, end))};
}

// Adds to the decoder of a block the SINR of each cell of the history within [begin, end), weighted by the
// cell's share of that span and of the band: SINR = n S / (N + echoes + interference).
void add_cells(const ReceivedSignal& signal, const PowerSteps& others, SimTime begin, SimTime end,
               acoustics::BlockDecoder& block) {
  const acoustics::SignalHistory& history = signal.history;
  const double whole_s = (end - begin).seconds(), noise = noise_met(signal),
               channels = history.receiver.channels;
  for (std::size_t i = 0; i < history.stretches(); ++i) {
    const SimTime from = std::max(begin, signal.begin + SimDuration::from_seconds(history.edges_s[i]));
    const SimTime to = std::min(end, signal.begin + SimDuration::from_seconds(history.edges_s[i + 1]));
    if (to <= from) continue;
    others.for_each_stretch(from, to, [&](double seconds, double interference) {
      const double disturbance = (noise + history.echoes[i] + interference) / channels;
      const double share = seconds / whole_s / static_cast<double>(history.frequencies);
      for (std::size_t m = 0; m < history.frequencies; ++m) {
        block.add(share, history.signal[i * history.frequencies + m] / disturbance);
      }
    });
  }
}

std::vector<Interference> with_bursts(std::vector<Interference> others, const ReceivedSignal& signal) {
  others.insert(others.end(), signal.bursts.begin(), signal.bursts.end());
  return others;
}

// Returns the instant at which an information bit of the packet begins; the bits are evenly spaced.
SimTime instant_of(const ReceivedSignal& signal, std::int64_t bit) {
  const double bits_s = (signal.end - signal.preamble_end).seconds();
  const auto all_bits = static_cast<double>(signal.packet->timing.information_bits);
  return signal.preamble_end + SimDuration::from_seconds(bits_s * static_cast<double>(bit) / all_bits);
}

// The success probabilities of a packet's blocks, header and frames, computed one after the other.
class BlockChances {
 public:
  BlockChances(const ReceivedSignal& signal, const std::vector<Interference>& others)
      : signal_(signal), steps_(with_bursts(others, signal), signal.preamble_end, signal.end) {}

  // Returns the probability that the next block is right.
  double next(std::int64_t bits) {
    if (bits == 0) return 1;
    acoustics::BlockDecoder block(signal_.packet->modem, signal_.fades);
    add_cells(signal_, steps_, time_of(before_), time_of(before_ + bits), block);
    before_ += bits;
    return block.success(bits);
  }

 private:
  SimTime time_of(std::int64_t bit) const { return instant_of(signal_, bit); }

  const ReceivedSignal& signal_;
  PowerSteps steps_;
  std::int64_t before_ = 0;
};

struct Decoded {
  double probability = 0;         // probability that at least one frame is right
  std::uint32_t frames_good = 0;  // bit i is set when frame i is right by the draws
};

// Decodes header and frames by the draws. The probability of at least one right frame is
//   P = P_header (1 - product over frames of (1 - P_i))
Decoded decode(const ReceivedSignal& signal, const std::vector<Interference>& others,
               const PacketDraws& draws) {
  const acoustics::PacketFormat& format = signal.packet->format;
  BlockChances chances(signal, others);
  const double header = chances.next(format.header_bits);
  const bool header_good = draws.success < header;
  Decoded decoded;
  // The probabilities, given the header, that the first frame is right and that all frames are wrong.
  double first = 1, none = 1;
  for (std::size_t i = 0; i < format.frame_bits.size(); ++i) {
    const double chance = chances.next(format.frame_bits[i]);
    if (i == 0) first = chance;
    none *= 1 - chance;
    const bool good =
        i == 0 ? draws.success < header * chance : header_good && draws.later_frames[i - 1] < chance;
    if (good) decoded.frames_good |= 1u << i;
  }
  // For one frame the product is used directly, because 1 - (1 - P) would lose digits.
  decoded.probability = format.frame_bits.size() == 1 ? header * first : header * (1 - none);
  return decoded;
}

// True when the packet is acquired and at least one frame is right, by the draws.
bool is_received(const ReceivedSignal& signal, const std::vector<Interference>& others,
                 const PacketDraws& draws) {
  return draws.acquisition < acquisition_probability(signal, others) &&
         decode(signal, others, draws).frames_good != 0;
}

const std::vector<Interference> kNoInterference;

// Returns the powers that disturb the bits, each over the signal of all hydrophones.
DisturbingPowers disturbing_powers(const ReceivedSignal& signal, const std::vector<Interference>& others) {
  const SimTime begin = signal.preamble_end, end = signal.end;
  const SignalMeans means = means_of(signal, begin, end);
  const double loss = signal.history.receiver.noise_loss,
               whole = signal.history.receiver.channels * means.signal;
  if (!(whole > 0)) return {};
  return {.noise = loss * signal.noise / whole,
          .late_echoes = std::max(means.echoes - means.fast_fading, 0.0) / whole,
          .fast_fading = means.fast_fading / whole,
          .others = mean_power(others, begin, end) / whole,
          .impulses = (loss * signal.impulses + mean_power(signal.bursts, begin, end)) / whole};
}

// Share of the noise that stays where it is taken away, so that ratios remain finite.
constexpr double kNoiseLeft = 1e-9;

// Returns the signal without one of the powers that disturb it.
ReceivedSignal signal_without(LossReason power, ReceivedSignal signal) {
  acoustics::SignalHistory& history = signal.history;
  switch (power) {
    case LossReason::kNoise:
      signal.noise *= kNoiseLeft;
      break;
    case LossReason::kLateEchoes:
      history.echoes = history.fast_fading;
      break;
    case LossReason::kFastFading:
      for (std::size_t i = 0; i < history.stretches(); ++i) {
        history.echoes[i] = std::max(history.echoes[i] - history.fast_fading[i], 0.0);
      }
      break;
    case LossReason::kImpulses:
      signal.impulses = 0;
      signal.bursts.clear();
      break;
    case LossReason::kOtherPackets:
    case LossReason::kNone:
      break;
  }
  return signal;
}

}  // namespace

LossReason loss_reason(const ReceivedSignal& signal, const std::vector<Interference>& others,
                       const DisturbingPowers& powers) {
  // A power below this share of all is no reason, whatever else there is.
  constexpr double kMinShare = 0.01;
  const double all = powers.sum();
  std::vector<std::pair<double, LossReason>> loud;
  for (const LossReason reason : acoustics::kLossReasons) {
    if (powers.of(reason) > kMinShare * all) loud.emplace_back(powers.of(reason), reason);
  }
  if (loud.empty()) return LossReason::kNone;
  // The loudest comes first: it is the reason where no power alone makes a difference.
  std::sort(loud.begin(), loud.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  if (loud.size() == 1) return loud.front().second;
  LossReason best = loud.front().second;
  double most = 0;
  for (const auto& [power, reason] : loud) {
    const std::vector<Interference>& left = reason == LossReason::kOtherPackets ? kNoInterference : others;
    const ReceivedSignal one = signal_without(reason, signal);
    const double acquired = acquisition_probability(one, left);
    const double success = acquired > most ? acquired * success_probability(one, left) : 0;
    if (success > most) {
      most = success;
      best = reason;
    }
  }
  return best;
}

std::uint64_t identity_for_draws(const Packet& packet) {
  const SendRequest& request = packet.request;
  return identity_of(
      {static_cast<std::uint64_t>(request.source_id), static_cast<std::uint64_t>(request.destination_id),
       static_cast<std::uint64_t>(request.kind), static_cast<std::uint64_t>(request.packet_sequence),
       static_cast<std::uint64_t>(packet.departure.nanoseconds())});
}

DrawAddress draw_address(std::uint64_t seed, std::uint32_t purpose, const Packet& packet,
                         VehicleId receiver) {
  return {.seed = seed,
          .purpose = purpose,
          .who = static_cast<std::uint32_t>(receiver),
          .which = identity_for_draws(packet)};
}

PacketDraws draws_of(std::uint64_t seed, const Packet& packet, std::uint64_t identity, VehicleId receiver) {
  constexpr std::uint32_t kAcquisition = purpose_of("packet-acquisition"), kBits = purpose_of("packet-bits"),
                          kFrame = purpose_of("packet-frame");
  const auto address = [&](std::uint32_t purpose, std::uint64_t which) {
    return DrawAddress{
        .seed = seed, .purpose = purpose, .who = static_cast<std::uint32_t>(receiver), .which = which};
  };
  PacketDraws draws{uniform_at(address(kAcquisition, identity)), uniform_at(address(kBits, identity))};
  for (std::size_t frame = 1; frame < packet.format.frame_bits.size(); ++frame)
    draws.later_frames.push_back(uniform_at(address(kFrame, identity_of({identity, frame}))));
  return draws;
}

double timing_draw_of(std::uint64_t seed, std::uint64_t identity, VehicleId receiver) {
  constexpr std::uint32_t kTiming = purpose_of("packet-timing");
  return normal_at(
      {.seed = seed, .purpose = kTiming, .who = static_cast<std::uint32_t>(receiver), .which = identity});
}

double mean_power(const std::vector<Interference>& paths, SimTime begin, SimTime end) {
  double energy = 0;
  if (end > begin) {
    for (const Interference& path : paths) {
      const SimTime from = std::max(path.begin, begin), to = std::min(path.end, end);
      if (to > from) energy += (to - from).seconds() * path.power;
    }
    return energy / (end - begin).seconds();
  }
  for (const Interference& path : paths) {
    if (path.begin <= begin && begin < path.end) energy += path.power;
  }
  return energy;
}

double acquisition_probability(const ReceivedSignal& signal, const std::vector<Interference>& others) {
  return acoustics::acquisition_probability(signal.packet->modem,
                                            mean_sinr(signal, others, signal.begin, signal.preamble_end));
}

double success_probability(const ReceivedSignal& signal, const std::vector<Interference>& others) {
  PacketDraws draws;
  draws.later_frames.resize(std::max<std::size_t>(signal.packet->format.frame_bits.size(), 1) - 1);
  return decode(signal, others, draws).probability;
}

double timing_error_s(const ReceivedSignal& signal, const Interferers& others, double standard_normal) {
  if (!signal.fades) return 0;
  const SimTime end = signal.preamble_end > signal.begin ? signal.preamble_end : signal.end;
  const double bandwidth_hz = signal.packet->modem.bandwidth_hz;
  const double energy = (end - signal.begin).seconds() * bandwidth_hz *
                        mean_sinr(signal, others.paths, signal.begin, end).value;
  if (!(energy > 0)) return 0;
  // sigma = 1 / (2 pi (B / sqrt(12)) sqrt(2 E/N)); B / sqrt(12) is the rms bandwidth of a flat spectrum.
  return standard_normal / (2 * std::numbers::pi * (bandwidth_hz / std::sqrt(12)) * std::sqrt(2 * energy));
}

void add_bursts(const acoustics::NoiseVariation& variation, std::uint64_t seed, VehicleId receiver,
                ReceivedSignal& signal) {
  if (!variation.draws_bursts()) return;
  const SimDuration period = variation.burst;
  const double g = signal.noise * to_power_ratio(variation.burst_level).value;
  for (SimTime begin = next_on_grid(signal.begin, period) - period; begin < signal.end;
       begin = begin + period) {
    const std::int64_t number = (begin - SimTime()).nanoseconds() / period.nanoseconds();
    const double power =
        acoustics::burst_power(variation.burst_exponent, seed, static_cast<std::uint32_t>(receiver), number);
    signal.bursts.push_back({begin, begin + period, g * power});
  }
}

std::vector<PacketName> colliders_of(const ReceivedSignal& signal, const Interferers& others) {
  std::vector<std::vector<Interference>> of_packet(others.packets.size());
  for (const Interference& path : others.paths) of_packet[path.source].push_back(path);
  const double least = signal.noise * to_power_ratio(-kNegligibleBelowNoise).value;
  std::vector<std::pair<double, PacketName>> loud;
  for (std::size_t i = 0; i < of_packet.size(); ++i) {
    const double power = mean_power(of_packet[i], signal.begin, signal.end);
    if (power >= least) loud.emplace_back(-power, others.packets[i]->name());
  }
  std::sort(loud.begin(), loud.end());
  std::vector<PacketName> names;
  for (const auto& [power, name] : loud) {
    if (names.size() < kMaxColliders) names.push_back(name);
  }
  return names;
}

bool acquires(const ReceivedSignal& signal, const Interferers& others, const PacketDraws& draws,
              DecisionStatistics& statistics) {
  statistics.acquisition_probability = acquisition_probability(signal, others.paths);
  return draws.acquisition < statistics.acquisition_probability;
}

SimTime header_end(const ReceivedSignal& signal) {
  return instant_of(signal, signal.packet->format.header_bits);
}

bool is_header_right(const ReceivedSignal& signal, const Interferers& others, const PacketDraws& draws) {
  return draws.success < BlockChances(signal, others.paths).next(signal.packet->format.header_bits);
}

OutcomeKind decide_reception(const ReceivedSignal& signal, const Interferers& others,
                             const PacketDraws& draws, bool acquired, DecisionStatistics& statistics) {
  const SignalMeans means = means_of(signal, signal.preamble_end, signal.end);
  statistics.interference =
      level_of(means.echoes + mean_power(others.paths, signal.preamble_end, signal.end) +
               mean_power(signal.bursts, signal.preamble_end, signal.end));
  statistics.sinr = level_of(mean_sinr(signal, others.paths, signal.preamble_end, signal.end).value);
  statistics.colliders = colliders_of(signal, others);
  statistics.powers = disturbing_powers(signal, others.paths);
  if (acquired) {
    const Decoded decoded = decode(signal, others.paths, draws);
    statistics.success_probability = decoded.probability;
    statistics.frames_good = decoded.frames_good;
    if (decoded.frames_good != 0) return OutcomeKind::kReceived;
  }
  statistics.reason = loss_reason(signal, others.paths, statistics.powers);
  if (!statistics.colliders.empty() && is_received(signal, {}, draws)) return OutcomeKind::kCollided;
  if (signal.without_shift) {
    ReceivedSignal corrected = signal;
    corrected.history = *signal.without_shift;
    if (is_received(corrected, others.paths, draws)) return OutcomeKind::kDoppler;
  }
  return acquired ? OutcomeKind::kBitErrors : OutcomeKind::kNotAcquired;
}

}  // namespace halocline::channel_server

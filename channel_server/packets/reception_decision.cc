#include "channel_server/packets/reception_decision.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/random.h"

namespace halocline::channel_server {
namespace {

// The sum of powers rises or falls by `power` at `at`.
struct Change {
  SimTime at;
  double power;
};

// By instant; among equals in an order of their own, so that sums do not depend on the order of arrival.
std::vector<Change> changes_within(const std::vector<Interference>& paths, SimTime begin, SimTime end) {
  std::vector<Change> changes;
  for (const Interference& path : paths) {
    if (path.end <= begin || path.begin >= end) continue;
    changes.push_back({std::max(path.begin, begin), path.power});
    changes.push_back({std::min(path.end, end), -path.power});
  }
  std::sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
    return std::tie(a.at, a.power) < std::tie(b.at, b.power);
  });
  return changes;
}

// Calls visit(seconds, power) for each stretch of constant power that has a duration.
template <class Visitor>
void for_each_stretch(const std::vector<Interference>& paths, SimTime begin, SimTime end, Visitor&& visit) {
  SimTime from = begin;
  double power = 0;
  const auto stretch_to = [&](SimTime to) {
    // What rounding leaves after the last path has ended may lie below 0.
    if (to > from) visit((to - from).seconds(), std::max(power, 0.0));
    from = to;
  };
  for (const Change& change : changes_within(paths, begin, end)) {
    stretch_to(change.at);
    power += change.power;
  }
  stretch_to(end);
}

PowerRatio sinr(const ReceivedSignal& signal, double interference) {
  return {signal.signal / (signal.noise + interference)};
}

std::vector<Interference> all_disturbances(const ReceivedSignal& signal, const Interferers& others) {
  std::vector<Interference> all = signal.echoes;
  all.insert(all.end(), others.paths.begin(), others.paths.end());
  return all;
}

Decibels level_of(double power) {
  return power > 0 ? std::max(to_decibels(PowerRatio{power}), kSilence) : kSilence;
}

}  // namespace

PacketDraws draws_of(std::uint64_t seed, const Packet& packet, VehicleId receiver) {
  const SendRequest& request = packet.request;
  const std::uint64_t identity = identity_of(
      {static_cast<std::uint64_t>(request.source_id), static_cast<std::uint64_t>(request.destination_id),
       static_cast<std::uint64_t>(request.kind), static_cast<std::uint64_t>(request.packet_sequence),
       static_cast<std::uint64_t>(packet.departure.nanoseconds())});
  const auto draw = [&](std::uint32_t purpose) {
    return uniform_at(
        {.seed = seed, .purpose = purpose, .who = static_cast<std::uint32_t>(receiver), .which = identity});
  };
  return {draw(purpose_of("packet-acquisition")), draw(purpose_of("packet-bits"))};
}

double mean_power(const std::vector<Interference>& paths, SimTime begin, SimTime end) {
  double energy = 0;
  if (end > begin) {
    for_each_stretch(paths, begin, end, [&](double seconds, double power) { energy += seconds * power; });
    return energy / (end - begin).seconds();
  }
  for (const Interference& path : paths) {
    if (path.begin <= begin && begin < path.end) energy += path.power;
  }
  return energy;
}

double acquisition_probability(const ReceivedSignal& signal, const std::vector<Interference>& disturbances) {
  const double interference = mean_power(disturbances, signal.begin, signal.preamble_end);
  return acoustics::acquisition_probability(signal.packet->modem, sinr(signal, interference));
}

double success_probability(const ReceivedSignal& signal, const std::vector<Interference>& disturbances) {
  const double whole_s = (signal.end - signal.preamble_end).seconds();
  const auto bits = static_cast<double>(signal.packet->timing.information_bits);
  double log_success = 0;
  for_each_stretch(disturbances, signal.preamble_end, signal.end, [&](double seconds, double interference) {
    const double error = acoustics::bit_error_rate(signal.packet->modem, sinr(signal, interference));
    log_success += bits * (seconds / whole_s) * std::log1p(-error);
  });
  return std::exp(log_success);
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
  statistics.acquisition_probability = acquisition_probability(signal, all_disturbances(signal, others));
  return draws.acquisition < statistics.acquisition_probability;
}

OutcomeKind decide_reception(const ReceivedSignal& signal, const Interferers& others,
                             const PacketDraws& draws, bool acquired, DecisionStatistics& statistics) {
  const auto disturbances = all_disturbances(signal, others);
  const double interference = mean_power(disturbances, signal.preamble_end, signal.end);
  statistics.interference = level_of(interference);
  statistics.sinr = level_of(sinr(signal, interference).value);
  statistics.colliders = colliders_of(signal, others);
  if (acquired) {
    statistics.success_probability = success_probability(signal, disturbances);
    if (draws.success < statistics.success_probability) return OutcomeKind::kReceived;
  }
  const bool alone_received = draws.acquisition < acquisition_probability(signal, signal.echoes) &&
                              draws.success < success_probability(signal, signal.echoes);
  if (alone_received && !statistics.colliders.empty()) return OutcomeKind::kCollided;
  return acquired ? OutcomeKind::kBitErrors : OutcomeKind::kNotAcquired;
}

}  // namespace halocline::channel_server

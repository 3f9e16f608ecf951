// SPDX-License-Identifier: BSD-3-Clause
// Results of one run that a sweep keeps.
//
// A packet counts at each receiver that it was addressed to (every vehicle for a broadcast); packets that are
// only overheard count among the outcomes alone. Delays are travel times of the first significant path of
// delivered packets; latency extends from the departure of the first bit to the arrival of the last.
// Throughput counts the payload bits that reached their destinations. Channel load and channel use are the
// textbooks' G and S: the summed durations of the packets sent, and of those received by the one vehicle that
// they were addressed to, divided by the duration of the run. Numbers of a network come from NETWORK_EVENTs,
// from the offer to the delivery; its load is the number of packets offered times the longest duration of a
// packet sent, which is that of its data. A percentile is the smallest value that at least that share of the
// sample does not exceed (nearest rank).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "bus/logs/log_reader.h"
#include "runs/analysis/outcome_summary.h"
#include "runs/timeline/outcome_ledger.h"

namespace halocline::clients {

// Numbers of a run that are averaged over seeds; NaN when the run has none (such as a delay when nothing was
// delivered).
enum class RunNumber {
  kPacketsSent,
  kPacketsRefused,
  kDeliveryRatio,
  kDelayMean,
  kDelayMedian,
  kDelay90,
  kDelay99,
  kLatencyMean,
  kThroughput,
  kChannelLoad,
  kChannelUse,
  kNetworkLoad,
  kNetworkOffered,
  kNetworkDelivered,
  kNetworkDelayMean,
  kNetworkDelay90,
  kNetworkHopsMean,
};
inline constexpr std::size_t kRunNumbers = 17;

// Description of a number for tables and files.
struct RunNumberInfo {
  const char* name;       // name of the column and variable
  const char* unit;       // unit as of UDUNITS
  const char* meaning;    // description in one line
  bool is_share = false;  // a proportion, within 0 to 1
};
const RunNumberInfo& info_of(std::size_t number);

// Packets at their receivers.
struct Delivered {
  std::int64_t packets = 0, received = 0;
};

struct RunMetrics {
  std::array<double, kRunNumbers> numbers{};
  double simulated_s = 0;
  Delivered all;
  std::map<std::pair<std::string, std::string>, Delivered> by_pair;  // keyed by sender and receiver
  OutcomeCounts outcomes{};                                          // addressed and overheard packets

  double& operator[](RunNumber n) { return numbers[static_cast<std::size_t>(n)]; }
  double operator[](RunNumber n) const { return numbers[static_cast<std::size_t>(n)]; }
};

// Computes the results of a run from its log.
RunMetrics metrics_of(LogReader& log);

std::string to_json(const RunMetrics& metrics);
// Reads results that to_json() wrote. Throws std::runtime_error for any other text.
RunMetrics metrics_from_json(const std::string& text);

}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
// The results of one run that a sweep keeps.
//
// A packet counts at a receiver that it was addressed to (or sent to all); those merely overheard count among
// the outcomes only. Delays are travel times of the first significant path of what was delivered; latency
// goes from the first bit that left to the last that arrived. Throughput counts the payload bits that reached
// their destinations. Load and use of the channel are those of textbooks, G and S: the durations of the
// packets sent, and of those received by the one vehicle that they were addressed to, over the run. Numbers
// of a network are of NETWORK_EVENTs, from the offer to the delivery; its load is the packets offered times
// the longest duration of a packet sent, which is that of their data. Percentiles are the least value that at
// least that share of the sample does not exceed (nearest rank).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "bus/logs/log_reader.h"
#include "clients/halocline/analysis/outcome_summary.h"
#include "clients/mission/outcome_ledger.h"

namespace halocline::clients {

// The numbers of a run that have a mean over seeds; NaN where the run has none (nothing was delivered).
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

struct RunNumberInfo {
  const char* name;       // as a column and a variable
  const char* unit;       // as UDUNITS has it
  const char* meaning;    // one line
  bool is_share = false;  // of something: within 0 to 1
};
const RunNumberInfo& info_of(std::size_t number);

struct Delivered {
  std::int64_t packets = 0, received = 0;  // at receivers
};

struct RunMetrics {
  std::array<double, kRunNumbers> numbers{};
  double simulated_s = 0;
  Delivered all;
  std::map<std::pair<std::string, std::string>, Delivered> by_pair;  // sender, receiver
  OutcomeCounts outcomes{};                                          // addressed and overheard

  double& operator[](RunNumber n) { return numbers[static_cast<std::size_t>(n)]; }
  double operator[](RunNumber n) const { return numbers[static_cast<std::size_t>(n)]; }
};

RunMetrics metrics_of(LogReader& log);

std::string to_json(const RunMetrics& metrics);
// Throws std::runtime_error for a text that to_json did not write.
RunMetrics metrics_from_json(const std::string& text);

}  // namespace halocline::clients

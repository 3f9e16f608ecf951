// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/sweep/run_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include "bus/logs/channel_types.h"
#include "runs/analysis/log_statistics.h"

namespace halocline::clients {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

constexpr std::array<RunNumberInfo, kRunNumbers> kInfo{
    {{"packets_sent", "1", "transmissions accepted"},
     {"packets_refused", "1", "transmissions refused"},
     {"delivery_ratio", "1", "share of addressed packets at receivers that were received", true},
     {"delay_mean_s", "s", "mean travel time of what was delivered"},
     {"delay_p50_s", "s", "median travel time of what was delivered"},
     {"delay_p90_s", "s", "90th percentile of the travel time of what was delivered"},
     {"delay_p99_s", "s", "99th percentile of the travel time of what was delivered"},
     {"latency_mean_s", "s", "mean time from the first bit sent to the last bit received"},
     {"throughput_bps", "bit s-1", "payload bits delivered to their destinations per second"},
     {"channel_load", "1", "durations of the packets sent, over the run: G of textbooks"},
     {"channel_use", "1", "durations of the packets received by the one they were for, over the run: S"},
     {"network_load", "1",
      "packets offered to networks times the longest duration of one sent, over the run"},
     {"network_offered", "1", "packets offered to networks"},
     {"network_delivered", "1", "packets that networks delivered, at each receiver"},
     {"network_delay_mean_s", "s", "mean time from the offer to the delivery"},
     {"network_delay_p90_s", "s", "90th percentile of the time from the offer to the delivery"},
     {"network_hops_mean", "1", "mean number of packets of modems on the way of what was delivered"}}};

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? kNaN : sum / static_cast<double>(values.size());
}

// Returns a percentile of `sorted`, which is ascending: the element with rank ceil(share * size).
double nearest_rank(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return kNaN;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

struct Counts {
  OutcomeSummary outcomes{3'600'000'000};
  LogStatistics statistics;
  std::int64_t payload_bits = 0;
  double sent_s = 0, longest_s = 0;  // total and greatest duration of packets
  std::int64_t offered = 0;
  std::vector<double> network_delays_s, hops;

  void count(const LoggedEvent& event) {
    outcomes.count(event);
    statistics.count(event, [] { return std::string(); });
    with_type_of(event.channel, [&]<class Message>() {
      if constexpr (std::is_same_v<Message, modem_receive_t>) {
        Message message;
        const bool is_whole = decode_checked(event.data, message);
        const bool is_addressed =
            message.destination_id == 0 || message.destination_id == message.receiver_id;
        if (is_whole && is_addressed) payload_bits += std::int64_t{8} * message.payload_size;
      } else if constexpr (std::is_same_v<Message, modem_receipt_t>) {
        Message message;
        if (decode_checked(event.data, message)) {
          sent_s += message.duration_s;
          longest_s = std::max(longest_s, message.duration_s);
        }
      } else if constexpr (std::is_same_v<Message, network_event_t>) {
        Message message;
        if (decode_checked(event.data, message)) count(message);
      }
    });
  }

  void count(const network_event_t& m) {
    offered += m.network_event == network_event_t::OFFERED ? 1 : 0;
    if (m.network_event != network_event_t::DELIVERED) return;
    network_delays_s.push_back(static_cast<double>(m.utime - m.offered_utime) * 1e-6);
    hops.push_back(m.hop_count);
  }
};

// Returns the total duration of packets received by the one vehicle that they were addressed to.
double received_s(const OutcomeSummary& outcomes) {
  double sum_s = 0;
  for (const packet_outcome_t& o : outcomes.outcomes()) {
    if (o.outcome == packet_outcome_t::RECEIVED && o.destination_id == o.receiver_id) sum_s += o.duration_s;
  }
  return sum_s;
}

void set_network(Counts& counts, RunMetrics& metrics) {
  auto& delays = counts.network_delays_s;
  std::sort(delays.begin(), delays.end());
  metrics[RunNumber::kChannelLoad] = counts.sent_s / metrics.simulated_s;
  metrics[RunNumber::kChannelUse] = received_s(counts.outcomes) / metrics.simulated_s;
  const auto offered = static_cast<double>(counts.offered);
  metrics[RunNumber::kNetworkLoad] = offered * counts.longest_s / metrics.simulated_s;
  metrics[RunNumber::kNetworkOffered] = offered;
  metrics[RunNumber::kNetworkDelivered] = static_cast<double>(delays.size());
  metrics[RunNumber::kNetworkDelayMean] = mean(delays);
  metrics[RunNumber::kNetworkDelay90] = nearest_rank(delays, 0.9);
  metrics[RunNumber::kNetworkHopsMean] = mean(counts.hops);
}

void add_delivery(const OutcomeSummary& outcomes, RunMetrics& metrics, std::vector<double>& delays,
                  std::vector<double>& latencies) {
  for (const packet_outcome_t& o : outcomes.outcomes()) {
    if (o.destination_id != 0 && o.destination_id != o.receiver_id) continue;
    const bool received = o.outcome == packet_outcome_t::RECEIVED;
    if (o.receiver_id == 0) {
      metrics.all.packets += o.num_receivers;
      continue;
    }
    Delivered& pair = metrics.by_pair[{outcomes.name(o.source_id), outcomes.name(o.receiver_id)}];
    for (Delivered* count : {&metrics.all, &pair}) {
      ++count->packets;
      count->received += received ? 1 : 0;
    }
    if (!received) continue;
    delays.push_back(o.travel_time_s);
    latencies.push_back(static_cast<double>(o.utime - o.departure_utime) * 1e-6);
  }
}

Json to_json(const Delivered& delivered) { return {delivered.packets, delivered.received}; }
Delivered delivered_from(const Json& json) { return {json.at(0), json.at(1)}; }

}  // namespace

const RunNumberInfo& info_of(std::size_t number) { return kInfo.at(number); }

RunMetrics metrics_of(LogReader& log) {
  Counts counts;
  for (LoggedEvent event; log.next(event);) counts.count(event);
  RunMetrics metrics;
  metrics.simulated_s = static_cast<double>(counts.statistics.last_stamp_us) * 1e-6;
  metrics.outcomes = counts.outcomes.total();
  std::vector<double> delays, latencies;
  add_delivery(counts.outcomes, metrics, delays, latencies);
  std::sort(delays.begin(), delays.end());
  const auto& receipts = counts.statistics.receipts;
  const std::int64_t accepted = receipts[modem_receipt_t::ACCEPTED] + receipts[modem_receipt_t::QUEUED];
  metrics[RunNumber::kPacketsSent] = static_cast<double>(accepted);
  metrics[RunNumber::kPacketsRefused] = static_cast<double>(counts.statistics.packets_sent - accepted);
  metrics[RunNumber::kDeliveryRatio] =
      metrics.all.packets == 0
          ? kNaN
          : static_cast<double>(metrics.all.received) / static_cast<double>(metrics.all.packets);
  metrics[RunNumber::kDelayMean] = mean(delays);
  metrics[RunNumber::kDelayMedian] = nearest_rank(delays, 0.5);
  metrics[RunNumber::kDelay90] = nearest_rank(delays, 0.9);
  metrics[RunNumber::kDelay99] = nearest_rank(delays, 0.99);
  metrics[RunNumber::kLatencyMean] = mean(latencies);
  metrics[RunNumber::kThroughput] =
      metrics.simulated_s > 0 ? static_cast<double>(counts.payload_bits) / metrics.simulated_s : kNaN;
  set_network(counts, metrics);
  return metrics;
}

// NaN is written as null, because JSON has no NaN.
std::string to_json(const RunMetrics& metrics) {
  Json json;
  json["simulated_s"] = metrics.simulated_s;
  for (std::size_t i = 0; i < kRunNumbers; ++i)
    json["numbers"][kInfo[i].name] = std::isnan(metrics.numbers[i]) ? Json() : Json(metrics.numbers[i]);
  json["addressed"] = to_json(metrics.all);
  json["pairs"] = Json::array();
  for (const auto& [pair, delivered] : metrics.by_pair)
    json["pairs"].push_back({pair.first, pair.second, to_json(delivered)});
  json["outcomes"] = metrics.outcomes;
  return json.dump(1);
}

RunMetrics metrics_from_json(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    RunMetrics metrics;
    metrics.simulated_s = json.at("simulated_s");
    for (std::size_t i = 0; i < kRunNumbers; ++i) {
      const Json& number = json.at("numbers").at(kInfo[i].name);
      metrics.numbers[i] = number.is_null() ? kNaN : number.get<double>();
    }
    metrics.all = delivered_from(json.at("addressed"));
    for (const Json& pair : json.at("pairs"))
      metrics.by_pair[{pair.at(0), pair.at(1)}] = delivered_from(pair.at(2));
    metrics.outcomes = json.at("outcomes").get<OutcomeCounts>();
    return metrics;
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(std::string("no result of a run: ") + error.what());
  }
}

}  // namespace halocline::clients

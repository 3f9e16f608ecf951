// SPDX-License-Identifier: BSD-3-Clause
// Records every message of the bus, in the order in which they are received, each with the wall time at which
// it was: the log that lcm-logger writes, but with nothing missing that its publisher still keeps.
//
// What is missing of a flow is requested, as every node does (bus/flow_repair.h), and written under its own
// channel when it comes; of a flow each message is written once, but for SENDs, which their senders repeat on
// purpose. HEARTBEAT and REPAIR_REQUEST are written as they are. What a publisher without sequence numbers
// sent is written as often as it comes, and nobody knows what is missing of it.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bus/flow_watch.h"
#include "bus/logs/flow_head.h"
#include "bus/node_identity.h"
#include "bus/runtime/node.h"
#include "bus/sequence_number.h"
#include "clients/recorder/recorded_file.h"
#include "core/hash.h"
#include "core/sim_time.h"

namespace halocline::clients {

class RecorderNode : public bus::Node {
 public:
  // What was received is in the file within this and some milliseconds.
  static constexpr SimDuration kFlushPeriod = SimDuration::from_milliseconds(250);
  static constexpr int kExitLacking = 3;

  // Subscribes, and only then opens the file, which must outlive this. A file that an earlier recorder left
  // is read: what is missing in it, and since, is requested. Prints a line to `out` once it records.
  RecorderNode(lcm::LCM& lcm, bus::NodeIdentity identity, RecordedFile& file, std::ostream& out);

  // What the log lacks, by channel: is missing now, or was given up.
  std::vector<bus::FlowWatch::Lacking> lacking() const;
  bool wants_repair() const override { return bus().flows().num_missing() > 0; }
  // Closes the log and prints a last line. The exit code: 0 for a log that lacks nothing, kExitLacking, or 1
  // where the disk refused some.
  int finish();

 protected:
  bus::Due on_due() const override { return {.steady = next_flush_}; }
  void on_step(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  void recall();
  std::optional<bus::FlowHead> head_of(std::string_view channel, std::span<const std::uint8_t> message);
  void record(std::string_view channel, std::span<const std::uint8_t> message);
  void report_refusals();
  std::string summary() const;

  RecordedFile& file_;
  std::ostream& out_;
  bool recalls_ = false;       // messages come of the file
  std::int64_t recalled_ = 0;  // of these
  SimTime next_flush_ = SimTime::at_once();
  std::int64_t refused_ = 0;  // by the disk, and reported
  // By channel.
  std::unordered_map<std::string, bus::FlowType, TextHash, std::equal_to<>> types_;
};

// "none", or "12: STATE.a 7, SENSORS.b 5", with the channels that lack most.
std::string lacking_text(std::vector<bus::FlowWatch::Lacking> lacking);

}  // namespace halocline::clients

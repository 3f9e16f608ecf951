// SPDX-License-Identifier: BSD-3-Clause
// Node that records every message of the bus in the order of reception, each with its wall time of reception:
// the log that lcm-logger writes, but complete as far as the publishers still keep their messages.
//
// Missing messages of a flow are requested, as by every node (bus/repair/flow_repair.h), and are written
// under their own channel when they arrive. Each message of a flow is written once, except for SENDs, which
// their senders repeat on purpose. HEARTBEAT and REPAIR_REQUEST are written unchanged. Messages of a
// publisher without sequence numbers are written as often as they arrive, and losses among them cannot be
// detected.
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

#include "bus/logs/flow_head.h"
#include "bus/messages/sequence_number.h"
#include "bus/repair/flow_watch.h"
#include "bus/runtime/node.h"
#include "bus/transport/node_identity.h"
#include "clients/recorder/recorded_file.h"
#include "core/hash.h"
#include "core/sim_time.h"

namespace halocline::clients {

class RecorderNode : public bus::Node {
 public:
  // Period after which received messages are written to the file, which takes some milliseconds more.
  static constexpr SimDuration kFlushPeriod = SimDuration::from_milliseconds(250);
  static constexpr int kExitLacking = 3;

  // Subscribes, and then opens the file, which must outlive this. If an earlier recorder left messages in the
  // file, they are read, and those missing in it, and since, are requested. Prints a line to `out` once it
  // records.
  RecorderNode(lcm::LCM& lcm, bus::NodeIdentity identity, RecordedFile& file, std::ostream& out);

  // Returns by channel how many messages the log lacks: those missing now, and those whose request was given
  // up.
  std::vector<bus::FlowWatch::Lacking> lacking() const;
  bool wants_repair() const override { return bus().flows().num_missing() > 0; }
  // Closes the log and prints a last line. Returns the exit code: 0 for a complete log, kExitLacking when
  // messages are missing, 1 when the disk refused some.
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
  bool recalls_ = false;       // the messages come from the file
  std::int64_t recalled_ = 0;  // number of messages in the file at the start
  SimTime next_flush_ = SimTime::at_once();
  std::int64_t refused_ = 0;  // messages that the disk refused, as reported
  // Type of the flow on each channel.
  std::unordered_map<std::string, bus::FlowType, TextHash, std::equal_to<>> types_;
};

// Returns "none", or "12: STATE.a 7, SENSORS.b 5" with the channels that lack most.
std::string lacking_text(std::vector<bus::FlowWatch::Lacking> lacking);

}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
// Transmitting side of a Micromodem: data cycles, and the reports of each transmission.
//
// A cycle asks its host for frames one by one (CADRQ) and then sends them as one packet. At rate 0 a cycle
// packet is transmitted first, and the host is asked when it has ended. Frames that a host gives unasked wait
// for the next cycle, which then does not ask for them. Each transmission is reported by CATXP when it
// begins, and by CATXF and CAXST when it ends. Data that does not come in time ends the cycle
// (CAERR,...,DATA_TIMEOUT).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "bus/messages/messages.h"
#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_core.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_receptions.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_reports.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// Returns the options with which a mini-packet of that kind is sent.
clients::SendOptions mini_packet(MicromodemKind kind);

class MicromodemTransmitter {
 public:
  enum class Kind { kData, kCycle, kMini, kPing, kNewPing, kFlexible, kFramed, kFramedMini };
  struct Transmission {
    Kind packet = Kind::kData;
    std::int32_t to = 0;           // vehicle id
    std::int64_t destination = 0;  // address of that vehicle
    std::vector<std::uint8_t> payload = {};
  };

  // `core` must outlive it.
  explicit MicromodemTransmitter(MicromodemCore& core) : core_(core) {}

  // Returns true while a cycle gathers its data or waits for its cycle packet to end.
  bool is_busy() const { return cycle_.has_value(); }
  // Begins a cycle in which this modem sends, whose data its host is asked for; `has_cycle_packet`: a cycle
  // packet is transmitted before.
  void begin(const MicromodemCycle& cycle, std::int32_t to, bool has_cycle_packet);
  // Returns true when a frame of that size is awaited, or may wait for a cycle.
  bool can_take(std::size_t bytes) const;
  // Takes the next frame, for which can_take() must hold; an empty frame ends the data.
  void take_data(std::vector<std::uint8_t> bytes, bool wants_ack);

  // Sends one packet, at the modem's next start or after the packets before it.
  void send(Transmission transmission, clients::SendOptions options);
  // Returns the kind of the packet that was sent with that number; nothing when it is forgotten.
  std::optional<Kind> sent_as(std::int64_t packet_sequence) const;

  void on_receipt(const modem_receipt_t& receipt);
  SimTime next() const;
  void step();

 private:
  struct Cycle {
    MicromodemCycle wanted;
    std::int32_t to = 0;
    std::optional<std::int64_t> announcement = {};  // number of its cycle packet, until that has ended
    std::vector<std::uint8_t> payload = {};
    std::vector<std::int32_t> frame_bytes = {};
    bool wants_ack = false;
    SimTime asked = SimTime::never();  // time at which the next frame was asked for
  };
  struct Frame {
    std::vector<std::uint8_t> bytes;
    bool wants_ack;
  };
  struct OnItsWay {
    Transmission transmission;
    TransmissionReport report;
    SimTime begins = SimTime::never(), ends = SimTime::never(), forgotten = SimTime::never();
  };

  // Returns the time at which the cycle ends for lack of data; never() without a cycle.
  SimTime data_due() const;
  std::size_t frame_size() const;
  void ask_for_data();
  void complete();
  std::int64_t transmit(Transmission transmission, clients::SendOptions options);
  void report_not_sent(TransmissionReport report) const;
  void end_announcement(std::int64_t sequence, bool was_sent);
  bool advance(std::int64_t sequence, OnItsWay& sent);

  MicromodemCore& core_;
  std::optional<Cycle> cycle_;
  std::deque<Frame> waiting_;  // frames that wait for a cycle
  std::map<std::int64_t, OnItsWay> sent_;
};

}  // namespace halocline::modem_gateway

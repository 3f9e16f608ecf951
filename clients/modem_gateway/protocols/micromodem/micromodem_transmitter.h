// SPDX-License-Identifier: BSD-3-Clause
// The sending side of a Micromodem: data cycles, and what it writes of each transmission.
//
// A cycle asks its host for its frames one by one (CADRQ), then sends them as one packet. At rate 0 a cycle
// packet goes out first, and the host is asked when that has ended. Frames that a host gives without being
// asked wait for the next cycle, which then does not ask for them. Of every transmission: CATXP when its
// sound begins, CATXF when it ends, then CAXST. Data that does not come in time ends the cycle
// (CAERR,...,DATA_TIMEOUT).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "bus/messages.h"
#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_core.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_receptions.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_reports.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

// How a mini-packet of that kind is sent.
clients::SendOptions mini_packet(MicromodemKind kind);

class MicromodemTransmitter {
 public:
  enum class Kind { kData, kCycle, kMini, kPing, kNewPing, kFlexible, kFramed, kFramedMini };
  struct Transmission {
    Kind packet = Kind::kData;
    std::int32_t to = 0;           // vehicle
    std::int64_t destination = 0;  // its address
    std::vector<std::uint8_t> payload = {};
  };

  // `core` must outlive it.
  explicit MicromodemTransmitter(MicromodemCore& core) : core_(core) {}

  // Whether a cycle gathers its data or waits to be sent.
  bool is_busy() const { return cycle_.has_value(); }
  // A cycle whose data this modem's host is asked for; with a cycle packet before it where told.
  void begin(const MicromodemCycle& cycle, std::int32_t to, bool has_cycle_packet);
  // Whether a frame of that size is awaited, or may wait for a cycle.
  bool can_take(std::size_t bytes) const;
  // The next frame, which can be taken; an empty one ends the data.
  void take_data(std::vector<std::uint8_t> bytes, bool wants_ack);

  // One packet, at the modem's next start, or after those before it.
  void send(Transmission transmission, clients::SendOptions options);
  // What was sent with that number; none where it is forgotten.
  std::optional<Kind> sent_as(std::int64_t packet_sequence) const;

  void on_receipt(const modem_receipt_t& receipt);
  SimTime next() const;
  void step();

 private:
  struct Cycle {
    MicromodemCycle wanted;
    std::int32_t to = 0;
    std::optional<std::int64_t> announcement = {};  // its cycle packet, until that has ended
    std::vector<std::uint8_t> payload = {};
    std::vector<std::int32_t> frame_bytes = {};
    bool wants_ack = false;
    SimTime asked = SimTime::never();  // for the next frame
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

  // When the cycle is given up for want of data; never() without one.
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
  std::deque<Frame> waiting_;  // for a cycle
  std::map<std::int64_t, OnItsWay> sent_;
};

}  // namespace halocline::modem_gateway

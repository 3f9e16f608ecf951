// The sending side of a Micromodem: data cycles, and what it writes of each transmission.
//
// A cycle asks its host for its frames one by one (CADRQ), then sends them as one packet, at rate 0 after a cycle packet. Of every
// transmission: CATXP when its sound begins, CATXF when it ends, then CAXST. Data that does not come in time ends the cycle
// (CAERR,...,DATA_TIMEOUT).
#pragma once

#include <cstddef>
#include <cstdint>
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
  enum class Kind { kData, kCycle, kMini, kPing, kNewPing, kFlexible };
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
  // Whether a frame of that size is awaited.
  bool wants_data(std::size_t bytes) const;
  // The next frame, which is wanted; an empty one ends the data.
  void take_data(const std::vector<std::uint8_t>& bytes, bool wants_ack);

  // One packet, from the modem's next start on.
  void send(Transmission transmission, clients::SendOptions options);
  bool is_new_ping(std::int64_t packet_sequence) const;

  void on_receipt(const modem_receipt_t& receipt);
  SimTime next() const;
  void step();

 private:
  struct Cycle {
    MicromodemCycle wanted;
    std::int32_t to = 0;
    bool has_cycle_packet = false;
    std::vector<std::uint8_t> payload;
    std::vector<std::int32_t> frame_bytes;
    bool wants_ack = false;
    bool is_complete = false;
    SimTime asked;  // for the next frame
  };
  struct OnItsWay {
    Transmission transmission;
    TransmissionReport report;
    SimTime begins = SimTime::never(), ends = SimTime::never(), forgotten = SimTime::never();
    bool has_receipt = false, is_accepted = false;
  };

  // When the cycle is given up for want of data; never() without one.
  SimTime data_due() const;
  void ask_for_data();
  void complete();
  void send_data(SimTime start);
  void send_at(SimTime start, Transmission transmission, clients::SendOptions options);
  bool advance(OnItsWay& sent);

  MicromodemCore& core_;
  std::optional<Cycle> cycle_;
  std::map<std::int64_t, OnItsWay> sent_;
};

}  // namespace halocline::modem_gateway

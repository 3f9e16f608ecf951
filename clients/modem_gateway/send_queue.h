// SPDX-License-Identifier: BSD-3-Clause
// Queue of the packets that a modem interface has accepted from its hosts and sends one after the other.
//
// A packet leaves the queue when its transmission has ended or when it was refused. The channel server
// refuses a packet that overlaps another transmission of the modem, such as its own acknowledgement. Such a
// packet is sent again a little later, as a new packet of the modem library. Packets therefore have numbers
// of the queue, and protocols never see those of the library.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "bus/messages/messages.h"
#include "bus/runtime/node.h"
#include "clients/modem/modem_client.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

class SendQueue {
 public:
  struct Packet {
    ProtocolPort::StartRule start;
    std::int32_t destination = 0;
    std::vector<std::uint8_t> payload;
    clients::SendOptions options;
  };

  // `modem` must outlive it.
  explicit SendQueue(clients::ModemClient& modem) : modem_(modem) {}

  // Adds a packet and returns its number. The packet is sent at once if it is the first and the simulation
  // time is known.
  std::int64_t add(Packet packet, const bus::Now& now);
  std::size_t size() const { return packets_.size(); }

  // Takes a receipt and returns it with the number of the queue; nothing when the packet is sent again, or is
  // not the one being sent.
  std::optional<modem_receipt_t> take(const modem_receipt_t& receipt, const bus::Now& now);
  // Returns the number of the packet that the modem library sent as `packet_sequence`; kForgotten when it is
  // not among the last ones.
  std::int64_t number_of(std::int64_t packet_sequence) const;

  // Sends what is due. Returns the refusal of a packet that was never answered.
  std::optional<modem_receipt_t> step(const bus::Now& now);
  // Returns the simulation time at which step() is due.
  SimTime next() const { return std::min(due_, ends_); }
  void clear();

 private:
  struct Numbered {
    std::int64_t number = 0;
    Packet packet;
    SimTime expires = SimTime::never();  // end of the repetition while the modem is busy
  };

  void transmit(const bus::Now& now);
  void remove_first(SimTime now);
  bool has_expired() const;

  clients::ModemClient& modem_;
  std::deque<Numbered> packets_;          // the first is being sent
  std::optional<std::int64_t> sequence_;  // packet_sequence of the first packet's SEND in the modem library
  SimTime due_ = SimTime::never();        // time of the next SEND
  SimTime ends_ = SimTime::never();       // end of the transmission
  std::map<std::int64_t, std::int64_t> numbers_;  // number of the queue, by sequence of the library
  std::int64_t next_number_ = 0;
};

}  // namespace halocline::modem_gateway

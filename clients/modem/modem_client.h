// SPDX-License-Identifier: BSD-3-Clause
// A vehicle's interface to its modem: sends packets, reports whether they were accepted, and receives
// packets.
//
// The bus may lose datagrams. The library repairs that and nothing else. A SEND is repeated, with the same
// (session, packet_sequence), until its RECEIPT is received; the channel server answers a repetition with the
// same receipt and transmits once. A duplicate RECEIVE is passed on once. A packet that is lost in the water
// stays lost.
//
// For use within a node: nothing here blocks or reads a clock. Call resend() from the node's step, and
// include next_resend() in its due time (steady):
//
//   ModemClient modem(bus(), {.vehicle = "auv-1", .vehicle_id = 1, .session = session});
//   const std::int64_t sequence = modem.send(now.steady, now.sim, kBroadcastId, payload);
//   ...
//   if (const auto receipt = modem.receipt_of(sequence)) { ... }
//   while (const auto packet = modem.take_received()) { ... }
//
// A program without nodes uses BlockingModem (blocking_modem.h). The Bus must outlive the client, and the
// client must exist as long as the Bus dispatches. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bus/bus.h"
#include "bus/transport/subscription.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

// Identity of the modem. `session` must differ each time the sender is started (bus::session_of).
struct ModemAddress {
  std::string vehicle;          // satisfies is_valid_name()
  std::int32_t vehicle_id = 0;  // 1 and up
  std::int64_t session = 0;
};

struct SendOptions {
  std::int8_t kind = modem_send_t::DATA;  // DATA, PING (to one vehicle, whose modem answers with a
                                          // PING_REPLY, or to all, for transponders), MINI_PACKET, ...
  bool stamped = true;     // carries the time of its departure, from which the receiver computes the delay
  bool wants_ack = false;  // to one vehicle, whose modem answers with an ACK; not for a PING
  std::optional<std::int32_t> rate_number = {};  // number of a rate of the modem, 0..255; none: its own
  std::optional<double> source_level_db = {};    // dB re 1 uPa at 1 m, 0..250; none: the modem's own
  std::int32_t header_number = 0;                // carried by the packet's header, 0..255
  std::vector<std::int32_t> frame_bytes =
      {};  // frame sizes of DATA, in sum the payload; none: the modem's default
};

// Options of the modem's receiver; the defaults are those of [modem].
struct ListenOptions {
  bool asleep = false;       // acquires nothing
  SimTime wakes = {};        // end of being asleep; 0: only another listen() ends it
  bool promiscuous = false;  // packets for others are received as well
  bool events = false;       // MODEM_EVENTs are published
  double carrier_threshold_db =
      6;  // excess of the sound of others over the noise at which carrier is sensed, dB, 0..100
};

// Returns true when all frames of a packet were received correctly; otherwise some of its payload is zeros.
bool is_whole(const modem_receive_t& packet);

// Repetition of a SEND that was not answered; steady time.
struct ResendPolicy {
  SimDuration interval = SimDuration::from_milliseconds(200);  // above 0
  SimDuration expire_after = SimDuration::from_seconds(10.0);  // from the first SEND
};

struct ModemCounters {
  std::int64_t sent = 0;          // packets given to send()
  std::int64_t resent = 0;        // repetitions of a SEND
  std::int64_t accepted = 0;      // receipts, including those of queued packets
  std::int64_t refused = 0;       // receipts
  std::int64_t unanswered = 0;    // packets whose SEND was repeated in vain
  std::int64_t received = 0;      // packets that arrived, each once, including answers of modems
  std::int64_t acknowledged = 0;  // own packets whose acknowledgement arrived
  std::int64_t duplicates = 0;    // repeated RECEIVEs
  std::int64_t discarded = 0;     // arrived, but not taken before kMaxWaiting others
};

class ModemClient {
 public:
  using ReceiptHandler = std::function<void(const modem_receipt_t&)>;
  using ReceiveHandler = std::function<void(const modem_receive_t&)>;
  using EventHandler = std::function<void(const modem_event_t&)>;

  // Most packets kept until they are taken, most receipts, and most packet identities to detect duplicates.
  static constexpr std::size_t kMaxWaiting = 1000, kMaxReceipts = 100, kMaxRemembered = 200;

  // `wakeup`: the effect of the handlers of receipts and packets on the node's due time
  // (bus/transport/subscription.h).
  ModemClient(bus::Bus& bus, ModemAddress address, ResendPolicy policy = {},
              bus::Wakeup wakeup = bus::Wakeup::kMayAdvanceDue);
  ModemClient(const ModemClient&) = delete;
  ModemClient& operator=(const ModemClient&) = delete;

  // Sets the function that is called once for each receipt of an own packet, while LCM dispatches.
  void on_receipt(ReceiptHandler handler) { receipt_handler_ = std::move(handler); }
  // Sets the function that is called once for each packet that arrives. Without it, packets wait for
  // take_received().
  void on_receive(ReceiveHandler handler) { receive_handler_ = std::move(handler); }

  // Sets the function that is called for each event of the modem, if it reports them (listen). To be called
  // before the node's first step.
  void on_event(EventHandler handler);

  // Publishes a LISTEN that is valid from `from` on (simulation time); it has no answer. Throws
  // InvalidArgument for a threshold out of range.
  void listen(SimTime from, const ListenOptions& options);

  // Publishes a SEND that starts at `start` (simulation time) and returns its packet_sequence. `destination`:
  // a vehicle's id, or kBroadcastId. `payload`: 0 to 32768 bytes; beyond the modem's own limit the receipt is
  // a refusal. Throws InvalidArgument otherwise, and for options that contradict each other.
  std::int64_t send(SimTime steady, SimTime start, std::int32_t destination,
                    std::span<const std::uint8_t> payload, SendOptions options = {});
  // Returns the reason why no modem can send such a packet; empty when there is none.
  std::string problem_with(std::int32_t destination, std::span<const std::uint8_t> payload,
                           const SendOptions& options) const;
  // Sends a PING without payload. Its answer, if any, is a RECEIVE of kind PING_REPLY with this
  // packet_sequence, which contains the two-way travel time.
  std::int64_t ping(SimTime steady, SimTime start, std::int32_t destination) {
    return send(steady, start, destination, {}, {.kind = modem_send_t::PING});
  }

  // Returns the receipt of a packet; nothing until it has arrived.
  std::optional<modem_receipt_t> receipt_of(std::int64_t packet_sequence) const;
  // Returns true while the SEND of this packet is being repeated: neither answered nor expired.
  bool is_pending(std::int64_t packet_sequence) const { return pending_.contains(packet_sequence); }
  // Returns the packet that has waited longest; nothing when there is none.
  std::optional<modem_receive_t> take_received();

  // Takes the waiting answer to this ping and returns its two-way travel time, s; nothing while none waits.
  std::optional<double> take_ping_reply(std::int64_t packet_sequence);

  // Takes the waiting acknowledgement of this packet: bit i is 1 when frame i was received correctly. Nothing
  // while none waits.
  std::optional<std::uint32_t> take_ack(std::int64_t packet_sequence);

  // Repeats each SEND that has waited for its receipt for the policy's interval.
  void resend(SimTime steady);
  // Returns the steady time at which resend() is due; never() when every packet is answered.
  SimTime next_resend() const;

  // Saves or loads the state. After loading, packets whose receipt is missing are sent again at once.
  void archive(Archive& a);
  // Returns a number that increases with each change of the archived state.
  std::uint64_t changes() const { return changes_; }

  const ModemAddress& address() const { return address_; }
  const ModemCounters& counters() const { return counters_; }

 private:
  struct Pending {
    modem_send_t message;
    SimTime next_try, last_try;  // steady time
    void archive(Archive& a) { a(message); }
  };
  // Session, source, kind and sequence number of a packet; a PING_REPLY has session and sequence number of
  // its ping.
  using PacketName = std::tuple<std::int64_t, std::int32_t, std::int8_t, std::int64_t>;

  modem_send_t message_of(std::int32_t destination, std::span<const std::uint8_t> payload,
                          SendOptions options) const;
  // Takes the waiting answer of that kind to an own packet.
  std::optional<modem_receive_t> take_answer(std::int64_t packet_sequence, std::int8_t kind);
  void take_receipt(const modem_receipt_t& receipt);
  void take_packet(const modem_receive_t& packet);
  [[nodiscard]] bool is_new(const PacketName& packet);

  bus::Bus& bus_;
  ModemAddress address_;
  ResendPolicy policy_;
  ReceiptHandler receipt_handler_;
  ReceiveHandler receive_handler_;
  ModemCounters counters_;
  std::uint64_t changes_ = 0;
  std::int64_t next_sequence_ = 0, next_listen_ = 0;
  std::map<std::int64_t, Pending> pending_;
  std::map<std::int64_t, modem_receipt_t> receipts_;
  std::deque<modem_receive_t> waiting_;
  std::deque<PacketName> known_;  // ordered by arrival
};

}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
// A vehicle's side of its modem: send a packet, learn whether it was accepted, take in what arrives.
//
// The bus may lose datagrams; the library repairs that and nothing else. A SEND is repeated, with the same
// (session, packet_sequence), until its RECEIPT is received; the channel server answers a repetition with the
// same receipt and transmits once. A duplicate RECEIVE is passed on once. What the water loses stays
// lost.
//
// For use within a node: nothing here blocks or reads a clock. Call resend() from the node's step, and take
// next_resend() into its due time (steady):
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
#include "bus/subscription.h"
#include "core/archive.h"
#include "core/sim_time.h"

namespace halocline::clients {

// Whose modem this is. `session` must differ each time the sender is started (bus::session_of).
struct ModemAddress {
  std::string vehicle;          // is_valid_name
  std::int32_t vehicle_id = 0;  // 1 and up
  std::int64_t session = 0;
};

// How a packet is sent.
struct SendOptions {
  std::int8_t kind = modem_send_t::DATA;  // or PING: to one vehicle, whose modem answers with a PING_REPLY,
                                          // or to all, for transponders; MINI_PACKET ...
  bool stamped = true;     // carries the instant of its departure: the receiver computes the delay
  bool wants_ack = false;  // to one vehicle, whose modem answers with an ACK; not for a PING
  std::optional<std::int32_t> rate_number = {};  // of a rate of the modem, 0..255; none: its own
  std::optional<double> source_level_db = {};    // dB re 1 uPa at 1 m, 0..250; none: the modem's own
  std::int32_t header_number = 0;                // carried by the packet's header, 0..255
  std::vector<std::int32_t> frame_bytes =
      {};  // of each frame of DATA, together the payload; none: as the modem does
};

// How the modem listens; the defaults are those of [modem].
struct ListenOptions {
  bool asleep = false;       // acquires nothing
  SimTime wakes = {};        // of one asleep: by itself, at this instant; 0: by another listen() alone
  bool promiscuous = false;  // packets for others are received as well
  bool events = false;       // MODEM_EVENTs are published
  double carrier_threshold_db =
      6;  // carrier is sensed where the sound of others exceeds the noise by this, 0..100
};

// Whether every frame of a packet was right: otherwise some of its payload is zeros.
bool is_whole(const modem_receive_t& packet);

// When to repeat a SEND that was not answered; steady time.
struct ResendPolicy {
  SimDuration interval = SimDuration::from_milliseconds(200);   // above 0
  SimDuration give_up_after = SimDuration::from_seconds(10.0);  // from the first SEND
};

struct ModemCounters {
  std::int64_t sent = 0;          // packets given to send()
  std::int64_t resent = 0;        // repetitions of a SEND
  std::int64_t accepted = 0;      // receipts, those of queued packets among them
  std::int64_t refused = 0;       // receipts
  std::int64_t unanswered = 0;    // given up
  std::int64_t received = 0;      // packets that arrived, each once, answers of modems among them
  std::int64_t acknowledged = 0;  // own packets whose acknowledgement arrived
  std::int64_t duplicates = 0;    // RECEIVEs that came again
  std::int64_t discarded = 0;     // arrived, but not taken before kMaxWaiting others came
};

class ModemClient {
 public:
  using ReceiptHandler = std::function<void(const modem_receipt_t&)>;
  using ReceiveHandler = std::function<void(const modem_receive_t&)>;
  using EventHandler = std::function<void(const modem_event_t&)>;

  // Bounds of what a client keeps: packets not taken yet, receipts, and packet identities to detect
  // duplicates.
  static constexpr std::size_t kMaxWaiting = 1000, kMaxReceipts = 100, kMaxRemembered = 200;

  // `wakeup`: what the handlers of receipts and packets may do to the node (bus/subscription.h).
  ModemClient(bus::Bus& bus, ModemAddress address, ResendPolicy policy = {},
              bus::Wakeup wakeup = bus::Wakeup::kMayAdvanceDue);
  ModemClient(const ModemClient&) = delete;
  ModemClient& operator=(const ModemClient&) = delete;

  // Called for each receipt of a packet of ours, once, while LCM dispatches.
  void on_receipt(ReceiptHandler handler) { receipt_handler_ = std::move(handler); }
  // Called for each packet that arrives, once. Without a handler packets wait for take_received().
  void on_receive(ReceiveHandler handler) { receive_handler_ = std::move(handler); }

  // Called for each event of the modem, where it reports them (listen). Before the first step of a node.
  void on_event(EventHandler handler);

  // Publishes a LISTEN that holds from `from` on (simulation time); nothing answers it. Throws
  // InvalidArgument for a threshold out of range.
  void listen(SimTime from, const ListenOptions& options);

  // Publishes a SEND that starts at `start` (simulation time) and returns its packet_sequence.
  // `destination`: a vehicle's id, or kBroadcastId. `payload`: 0 to 32768 bytes; a modem's own limit shows in
  // the receipt. Throws InvalidArgument otherwise, and for options that contradict each other.
  std::int64_t send(SimTime steady, SimTime start, std::int32_t destination,
                    std::span<const std::uint8_t> payload, SendOptions options = {});
  // Reason why no modem sends such a packet; empty where there is none.
  std::string problem_with(std::int32_t destination, std::span<const std::uint8_t> payload,
                           const SendOptions& options) const;
  // A PING without payload. What comes back, if it does, is a RECEIVE of kind PING_REPLY with this
  // packet_sequence, which holds the travel time out and back.
  std::int64_t ping(SimTime steady, SimTime start, std::int32_t destination) {
    return send(steady, start, destination, {}, {.kind = modem_send_t::PING});
  }

  // The answer to a packet; empty while none has come.
  std::optional<modem_receipt_t> receipt_of(std::int64_t packet_sequence) const;
  // Whether SENDs of this packet still go out: neither answered nor given up.
  bool is_pending(std::int64_t packet_sequence) const { return pending_.contains(packet_sequence); }
  std::size_t num_pending() const { return pending_.size(); }  // packets of which SENDs still go out
  // The longest-waiting packet that arrived; empty when there is none.
  std::optional<modem_receive_t> take_received();

  // The two-way travel time of the waiting answer to this ping, s, which is taken; empty while none waits.
  std::optional<double> take_ping_reply(std::int64_t packet_sequence);

  // Of the waiting acknowledgement of this packet, which is taken: bit i is 1 where frame i was right. Empty
  // while none waits.
  std::optional<std::uint32_t> take_ack(std::int64_t packet_sequence);

  // Repeats what has waited for its receipt for the policy's interval.
  void resend(SimTime steady);
  // The steady time at which resend() has something to do; never() while every packet is answered.
  SimTime next_resend() const;

  // Packets whose receipt is missing are sent again at once after loading.
  void archive(Archive& a);
  // Greater after each change of what is archived.
  std::uint64_t changes() const { return changes_; }

  const ModemAddress& address() const { return address_; }
  const ModemCounters& counters() const { return counters_; }

 private:
  struct Pending {
    modem_send_t message;
    SimTime next_try, last_try;  // steady
    void archive(Archive& a) { a(message); }
  };
  // Session, source, kind, sequence: a PING_REPLY has session and sequence of its ping.
  using PacketName = std::tuple<std::int64_t, std::int32_t, std::int8_t, std::int64_t>;

  modem_send_t message_of(std::int32_t destination, std::span<const std::uint8_t> payload,
                          SendOptions options) const;
  // Takes the waiting answer of that kind to a packet of ours.
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
  std::deque<PacketName> known_;  // the latest last
};

}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
// Messages that an EvoLogics modem has to send: at most one instant message, one piggy-back message, which
// waits for an acknowledgement to follow, and a queue of bursts.
//
// An instant message with acknowledgement is repeated !RI times, and a burst !RC times, when no
// acknowledgement arrives within !RT milliseconds after the end of the transmission. While the modem is
// receiving, an instant message is cancelled (CANCELED...) unless it is forced, and a burst waits. A
// piggy-back message is transmitted as a packet of its own as soon as the modem's acknowledgement has ended.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "bus/messages/messages.h"
#include "clients/modem_gateway/protocols/s2c/s2c_core.h"
#include "clients/modem_gateway/protocols/s2c/s2c_reader.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

struct S2cMessage {
  enum class Type { kInstant, kSynchronous, kPiggyBack, kBurst };
  Type type = Type::kInstant;
  std::int32_t address = 0;
  S2cPayload payload;
  bool wants_ack = false;
  std::optional<std::uint32_t> at_us;  // start of a synchronous message, by the modem's clock
};

class S2cSender {
 public:
  static constexpr std::size_t kMaxBursts = 16;

  // `core` must outlive it.
  explicit S2cSender(S2cCore& core) : core_(core) {}

  // Takes a command that sends, with its fields and data. Returns OK, or the reason of a refusal.
  std::string take(const S2cCommand& command);
  std::string take(S2cMessage message);
  // Forgets all messages that were not sent or not acknowledged.
  void clear();

  void on_receipt(const modem_receipt_t& receipt);
  void on_ack(const modem_receive_t& ack);
  void on_event(const modem_event_t& event);
  // Sends the waiting piggy-back message after the acknowledgement of this received packet.
  void on_acknowledged(const modem_receive_t& packet);

  SimTime next() const;
  void step();

  // Returns the one-way travel time that the last acknowledgement showed, us; 0 before the first.
  std::int64_t propagation_us() const { return propagation_us_; }
  void note_propagation(double one_way_s);

 private:
  struct OnItsWay {
    S2cMessage message;
    std::int64_t sequence = kNotSent;
    std::int64_t tries_left = 0;
    SimTime start, ends = SimTime::never(), until = SimTime::never();
  };

  bool is_receiving() const { return core_.now() < receiving_until_; }
  void transmit(OnItsWay& sent);
  void begin(std::optional<OnItsWay>& place, S2cMessage message, SimTime start);
  std::optional<OnItsWay>* place_of(std::int64_t sequence);
  void on_sent(OnItsWay& sent, const modem_receipt_t& receipt);
  void cancel(std::optional<OnItsWay>& place);
  void step(std::optional<OnItsWay>& place);
  void finish(std::optional<OnItsWay>& place, bool delivered);
  void next_burst();

  int next_number(bool is_burst, std::int32_t address);

  S2cCore& core_;
  std::map<std::pair<bool, std::int32_t>, int> numbers_;  // last number, by (is a burst, address)
  std::optional<OnItsWay> instant_, burst_;               // being sent
  std::optional<OnItsWay> piggy_back_;                    // being sent
  std::optional<S2cMessage> waiting_piggy_back_;
  std::deque<S2cMessage> bursts_;
  SimTime burst_due_ = SimTime::never();
  SimTime receiving_until_;  // latest end of the packet that was detected
  std::int64_t bursts_done_ = 0, propagation_us_ = 0;
};

}  // namespace halocline::modem_gateway

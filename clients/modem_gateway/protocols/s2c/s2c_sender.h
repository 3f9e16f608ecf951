// SPDX-License-Identifier: BSD-3-Clause
// What an EvoLogics modem has to send: one instant message at a time, one piggy-back message that waits for
// an acknowledgement to ride on, and a queue of bursts.
//
// Instant messages with acknowledgement are repeated !RI times, bursts !RC times, where none comes within !RT
// milliseconds after the end of the transmission. A message is refused by the water's side (CANCELED...)
// where the modem is receiving, unless forced. A piggy-back message goes out as a packet of its own as soon
// as the modem's acknowledgement has ended.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "bus/messages.h"
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
  std::optional<std::uint32_t> at_us;  // by the modem's clock, of a synchronous one
};

class S2cSender {
 public:
  static constexpr std::size_t kMaxBursts = 16;

  // `core` must outlive it.
  explicit S2cSender(S2cCore& core) : core_(core) {}

  // Answers OK, or why it is refused. `command`: one that sends, with its fields and data.
  std::string take(const S2cCommand& command);
  std::string take(S2cMessage message);
  // Forgets what was not sent, or not acknowledged.
  void clear();

  void on_receipt(const modem_receipt_t& receipt);
  void on_ack(const modem_receive_t& ack);
  void on_event(const modem_event_t& event);
  // A packet of another that this modem acknowledges.
  void on_acknowledged(const modem_receive_t& packet);

  SimTime next() const;
  void step();

  // One way, as the last acknowledgement showed, us; 0 before one.
  std::int64_t propagation_us() const { return propagation_us_; }
  void note_propagation(double one_way_s);
  std::int32_t last_address() const { return last_address_; }

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

  // The next number of what goes to that address.
  int next_number(bool is_burst, std::int32_t address);

  S2cCore& core_;
  std::map<std::pair<bool, std::int32_t>, int> numbers_;  // the last, of bursts or not, by address
  std::optional<OnItsWay> instant_, burst_;               // under way
  std::optional<OnItsWay> piggy_back_;                    // likewise
  std::optional<S2cMessage> waiting_piggy_back_;
  std::deque<S2cMessage> bursts_;
  SimTime burst_due_ = SimTime::never();
  SimTime receiving_until_;  // of a packet that was detected, at the latest
  std::int64_t bursts_done_ = 0, propagation_us_ = 0;
  std::int32_t last_address_ = 0;
};

}  // namespace halocline::modem_gateway

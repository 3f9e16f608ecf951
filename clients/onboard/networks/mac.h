// SPDX-License-Identifier: BSD-3-Clause
// Medium access control (MAC): decides when a vehicle transmits the frames in its queue.
//
// A protocol is a class with attempt(), which is called when the first frame is due, and with handlers for
// what the modem receives and senses, as needed. Frames are transmitted one after the other, first in, first
// out; a frame that arrives while kMaxWaiting wait is dropped. The node (network_node.h) passes messages and
// time; all times are those of the vehicle's clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <utility>

#include "bus/messages/messages.h"
#include "clients/onboard/networks/network_config.h"
#include "clients/onboard/networks/network_packet.h"
#include "core/sim_time.h"

namespace halocline::networks {

struct MacPort {
  std::function<void(SimTime at, const MacFrame&)> transmit;  // hands a frame to the modem
  std::function<void(SimTime at, const MacFrame&)> deliver;  // passes on a frame for this vehicle, or for all
  std::function<void(SimTime at, const MacFrame&)> drop;     // the frame will not be transmitted
  std::function<double()> draw;                              // the vehicle's next random number in (0, 1)
};

class Mac {
 public:
  static constexpr std::size_t kMaxWaiting = 100;

  Mac(MacPort port, const NetworkRules& rules) : port_(std::move(port)), rules_(rules) {}
  virtual ~Mac() = default;
  Mac(const Mac&) = delete;
  Mac& operator=(const Mac&) = delete;

  // Queues a frame for transmission.
  void offer(MacFrame frame, SimTime now);
  // Handles a packet that the modem received; for a promiscuous modem it may be for any vehicle.
  virtual void on_packet(const modem_receive_t& packet, std::int32_t own_id);
  virtual void on_event(const modem_event_t& event);
  // Moves all that the MAC waits for by `by`, because the vehicle's clock was set and shows `now` instead of
  // `now - by`: what remains of a wait is as long as before. Slots are those of the clock as it is now.
  virtual void on_clock_set(SimTime now, SimDuration by);
  // Handles the modem's refusal of the latest transmission.
  virtual void on_refused(SimTime now);

  virtual SimTime next() const;
  virtual void step(SimTime now);

 protected:
  // Called when the first frame is due: transmits it, or sets due_ to a later time.
  virtual void attempt(SimTime now) { transmit_first(now); }
  // Returns when a frame is due that becomes the first of the queue at `now`.
  virtual SimTime first_try(SimTime now) const { return now; }

  void transmit(MacFrame frame, SimTime now);
  void transmit_first(SimTime now);
  void drop_first(SimTime now);
  SimDuration random_wait(SimDuration mean) const;  // exponentially distributed

  MacPort port_;
  NetworkRules rules_;
  std::deque<MacFrame> queue_;
  SimTime due_ = SimTime::never();  // due time of the first frame
  bool transmits_ = false;
  bool carrier_ = false;  // the sound of other vehicles is sensed
};

// Returns the travel time of sound from one vehicle to another, given by their ids.
using TravelTimes = std::function<SimDuration(std::int32_t from, std::int32_t to)>;

// Make the protocols. `index` is the vehicle's place among the `count` vehicles that share the slots.
std::unique_ptr<Mac> make_aloha(MacPort port, const NetworkRules& rules);
std::unique_ptr<Mac> make_aloha_ca(MacPort port, const NetworkRules& rules, std::int32_t own_id,
                                   TravelTimes travel);
std::unique_ptr<Mac> make_slotted_aloha(MacPort port, const NetworkRules& rules);
std::unique_ptr<Mac> make_tdma(MacPort port, const NetworkRules& rules, std::int64_t index,
                               std::int64_t count);
std::unique_ptr<Mac> make_csma(MacPort port, const NetworkRules& rules);
std::unique_ptr<Mac> make_maca(MacPort port, const NetworkRules& rules);
std::unique_ptr<Mac> make_dacap(MacPort port, const NetworkRules& rules);
std::unique_ptr<Mac> make_t_lohi(MacPort port, const NetworkRules& rules);

}  // namespace halocline::networks

// SPDX-License-Identifier: BSD-3-Clause
// MACA (Karn 1990): a short request to send (RTS), the receiver's short clear to send (CTS), then the data;
// vehicles that overhear these are silent meanwhile.
//
// The first byte of each packet tells its type. An RTS without an answer within `handshake` is repeated after
// a random wait, `tries` times in all. A vehicle that overhears an RTS is silent for `handshake`, which must
// cover RTS, CTS and twice the greatest travel time. One that overhears a CTS is silent for `exchange`, which
// must cover the data and twice the greatest travel time. The modem must be promiscuous. Broadcast frames are
// sent without a handshake. There are no acknowledgements.
#pragma once

#include <cstdint>
#include <optional>

#include "bus/messages/messages.h"
#include "clients/onboard/networks/mac.h"
#include "clients/onboard/networks/network_packet.h"
#include "core/sim_time.h"

namespace halocline::networks {

class Maca : public Mac {
 public:
  using Mac::Mac;

  void on_packet(const modem_receive_t& packet, std::int32_t own_id) override;
  void on_clock_set(SimTime now, SimDuration by) override;
  SimTime next() const override;
  void step(SimTime now) override;

 protected:
  enum class State { kIdle, kAwaitsClearToSend, kHasClearToSend, kAwaitsData };

  void attempt(SimTime now) override;
  // Called when the receiver is clear for the first frame.
  virtual void on_clear_to_send(const modem_receive_t& packet);
  // Called when packets of a third vehicle may disturb the exchange.
  virtual void on_threat(SimTime /*at*/) {}

  void await(State state, SimTime deadline);
  void become_idle(SimTime now);
  void send_data(SimTime now);
  void try_again(SimTime now);

  State state_ = State::kIdle;
  std::int32_t partner_ = 0;        // the other vehicle of the exchange, unless idle
  std::optional<MacFrame> answer_;  // to be transmitted at once

 private:
  void on_request(const modem_receive_t& packet);

  SimTime deadline_, silent_until_ = SimTime::at_once();
  int tries_ = 0;  // attempts of the first frame
};

}  // namespace halocline::networks

// SPDX-License-Identifier: BSD-3-Clause
// MACA (Karn 1990): a short request to send, the receiver's short leave to send, then the data; who overhears
// them is silent meanwhile.
//
// The first byte of each of its packets tells them apart. A request that is not answered within `handshake`
// is repeated after a random wait, `tries` times in all. Who overhears a request is silent for `handshake`,
// who overhears a leave for `exchange`: the one time holds the request, the leave and twice the greatest
// travel time, the other the data and twice the greatest travel time. The modem has to be promiscuous. Frames
// to all are sent without a handshake. Left out: acknowledgement.
#pragma once

#include <cstdint>
#include <optional>

#include "bus/messages.h"
#include "clients/examples/networks/mac.h"
#include "clients/examples/networks/network_packet.h"
#include "core/sim_time.h"

namespace halocline::networks {

class Maca : public Mac {
 public:
  using Mac::Mac;

  void on_packet(const modem_receive_t& packet, std::int32_t own_id) override;
  SimTime next() const override;
  void step(SimTime now) override;

 protected:
  enum class State { kIdle, kAwaitsLeave, kHasLeave, kAwaitsData };

  void attempt(SimTime now) override;
  // The receiver gave leave to send the first frame.
  virtual void on_leave(const modem_receive_t& packet);
  // Packets of a third vehicle may disturb the own exchange.
  virtual void on_threat(SimTime /*at*/) {}

  void await(State state, SimTime deadline);
  void become_idle(SimTime now);
  void send_data(SimTime now);
  void try_again(SimTime now);

  State state_ = State::kIdle;
  std::int32_t partner_ = 0;     // of the exchange, unless idle
  std::optional<Frame> answer_;  // to be transmitted at once

 private:
  void on_request(const modem_receive_t& packet);

  SimTime deadline_, silent_until_;
  int tries_ = 0;  // of the first frame
};

}  // namespace halocline::networks

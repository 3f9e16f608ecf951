// Long-baseline ranging of a Micromodem: the travel times to up to four transponders, vehicles of the scenario whose modems answer pings.
//
// The medium knows pings to one vehicle, so transponders are asked one after the other, each for `timeout` after its ping has ended;
// a real one asks all at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "bus/messages.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

inline constexpr std::size_t kTransponders = 4;

class MicromodemLbl {
 public:
  using Times = std::array<std::optional<double>, kTransponders>;  // one-way, s; none where not heard
  // Vehicles to ask, in their places; none: not asked.
  using Asked = std::array<std::optional<std::int32_t>, kTransponders>;
  using Done = std::function<void(const Times&)>;

  // `done` is called once for each start().
  MicromodemLbl(ProtocolPort& port, Done done) : port_(port), done_(std::move(done)) {}

  bool is_busy() const { return place_ < kTransponders; }
  // Only while it is not busy.
  void start(const Asked& asked, SimDuration timeout);
  // Whether that packet is a ping of its own, and takes its receipt or answer.
  bool takes(const modem_receipt_t& receipt);
  bool takes(const modem_receive_t& packet);

  SimTime next() const { return is_busy() ? until_ : SimTime::never(); }
  void step();

 private:
  void ask_from(std::size_t place);

  ProtocolPort& port_;
  Done done_;
  Asked asked_;
  Times times_;
  SimDuration timeout_;
  std::size_t place_ = kTransponders;  // that is asked
  std::int64_t sequence_ = -1;
  SimTime until_;
};

}  // namespace halocline::modem_gateway

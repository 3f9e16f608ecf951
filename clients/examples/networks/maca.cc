// MACA (Karn 1990): a short request to send, the receiver's short leave to send, then the data; who overhears them is silent meanwhile.
//
// The first byte of each of its packets tells the three apart. A request that is not answered within `handshake` is repeated after a
// random wait, `tries` times in all. Who overhears a request is silent for `handshake`, who overhears a leave for `exchange`: the
// one time holds the request, the leave and twice the greatest travel time, the other the data and twice the greatest travel time. The modem has
// to be promiscuous. Frames to all are sent without a handshake. Left out: acknowledgement; DACAP's warnings (Peleato and
// Stojanovic 2007) to a sender whose data would be disturbed.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "clients/examples/networks/mac.h"
#include "clients/examples/networks/network_packet.h"
#include "core/names.h"
#include "core/sim_time.h"

namespace halocline::networks {
namespace {

constexpr std::uint8_t kData = 0xA0, kRequest = 0xA1, kLeave = 0xA2;

class Maca : public Mac {
 public:
  using Mac::Mac;

  void on_packet(const modem_receive_t& packet, std::int32_t own_id) override {
    if (packet.payload.empty()) return;
    const SimTime at = SimTime::from_utime(packet.utime);
    const std::uint8_t kind = packet.payload.front();
    const bool is_ours = packet.destination_id == own_id;
    if (kind == kData && (is_ours || packet.destination_id == kBroadcastId)) {
      if (is_ours && state_ == State::kAwaitsData) become_idle(at);
      port_.deliver(at, {packet.destination_id, {packet.payload.begin() + 1, packet.payload.end()}});
    } else if (kind == kRequest && is_ours) {
      if (state_ != State::kIdle || at < silent_until_ || answer_) return;
      answer_ = Frame{packet.source_id, {kLeave}};
      await(State::kAwaitsData, at + rules_.exchange);
    } else if (kind == kLeave && is_ours) {
      if (state_ != State::kAwaitsLeave || queue_.front().destination != packet.source_id) return;
      answer_ = data_of(queue_.front());
      queue_.pop_front();
      tries_ = 0;
      become_idle(at);
    } else if (kind == kRequest || kind == kLeave) {
      silent_until_ = std::max(silent_until_, at + (kind == kRequest ? rules_.handshake : rules_.exchange));
    }
  }

  SimTime next() const override {
    if (transmits_) return SimTime::never();
    if (answer_) return SimTime::at_once();
    if (state_ != State::kIdle) return deadline_;
    return queue_.empty() ? SimTime::never() : std::max(due_, silent_until_);
  }

  void step(SimTime now) override {
    if (next() > now) return;
    if (answer_) {
      transmit(*std::exchange(answer_, std::nullopt), now);
    } else if (state_ == State::kAwaitsLeave) {
      become_idle(now);
      try_again(now);
    } else if (state_ == State::kAwaitsData) {
      become_idle(now);
    } else {
      attempt(now);
    }
  }

 protected:
  void attempt(SimTime now) override {
    if (carrier_) return try_again(now);
    const Frame& first = queue_.front();
    if (first.destination == kBroadcastId) {
      const Frame data = data_of(first);
      queue_.pop_front();
      return transmit(data, now);
    }
    await(State::kAwaitsLeave, now + rules_.handshake);
    transmit({first.destination, {kRequest}}, now);
  }

 private:
  enum class State { kIdle, kAwaitsLeave, kAwaitsData };

  static Frame data_of(const Frame& frame) {
    Frame data{frame.destination, {kData}};
    data.bytes.insert(data.bytes.end(), frame.bytes.begin(), frame.bytes.end());
    return data;
  }

  void await(State state, SimTime deadline) {
    state_ = state;
    deadline_ = deadline;
  }

  void become_idle(SimTime now) {
    state_ = State::kIdle;
    due_ = now;
  }

  void try_again(SimTime now) {
    due_ = now + random_wait(rules_.backoff);
    if (++tries_ < rules_.tries) return;
    tries_ = 0;
    drop_first(now);
  }

  State state_ = State::kIdle;
  SimTime deadline_, silent_until_;
  std::optional<Frame> answer_;  // to be transmitted at once
  int tries_ = 0;                // of the first frame
};

}  // namespace

std::unique_ptr<Mac> make_maca(MacPort port, const NetworkRules& rules) {
  return std::make_unique<Maca>(std::move(port), rules);
}

}  // namespace halocline::networks

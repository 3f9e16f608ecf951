// SPDX-License-Identifier: BSD-3-Clause
// MACs whose frames leave at the beginning of a slot: slotted ALOHA (Roberts 1975) uses any slot, TDMA those
// of the vehicle.
//
// Slots begin at multiples of `slot` by the vehicle's clock. A slot that began more than a tenth of its
// length ago, because the clock was set ahead or the step came late, is skipped: the packet would not end
// within it. The throughput of slotted ALOHA is
//
//   S = G exp(-G)
//
// if all sound takes the same time to the receiver. Different distances reduce it to that of pure ALOHA,
// unless slots are longer by the greatest difference of travel times (Syed, Ye, Heidemann and Krishnamachari
// 2008). Transmissions of TDMA never collide when slots are longer than a packet by the greatest travel time.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "clients/onboard/networks/mac.h"
#include "core/sim_time.h"

namespace halocline::networks {
namespace {

class SlottedMac : public Mac {
 public:
  // A vehicle uses the slots whose number is `index` modulo `count`.
  SlottedMac(MacPort port, const NetworkRules& rules, std::int64_t index, std::int64_t count)
      : Mac(std::move(port), rules), index_(index), count_(count) {}

  // A slot that the clock skips is past, so attempt() takes the next one.
  void on_clock_set(SimTime now, SimDuration /*by*/) override { due_ = std::min(due_, first_try(now)); }

 protected:
  void attempt(SimTime now) override {
    if ((now - due_).nanoseconds() * kLateShare <= rules_.slot.nanoseconds()) return transmit_first(now);
    due_ = first_try(now);
  }
  SimTime first_try(SimTime now) const override {
    const std::int64_t slot = rules_.slot.nanoseconds();
    std::int64_t number =
        next_on_grid(now - SimDuration::from_nanoseconds(1), rules_.slot).nanoseconds() / slot;
    number += ((index_ - number) % count_ + count_) % count_;
    return SimTime::from_nanoseconds(number * slot);
  }

 private:
  static constexpr std::int64_t kLateShare = 10;  // a tenth of a slot
  std::int64_t index_, count_;
};

}  // namespace

std::unique_ptr<Mac> make_slotted_aloha(MacPort port, const NetworkRules& rules) {
  return std::make_unique<SlottedMac>(std::move(port), rules, 0, 1);
}

std::unique_ptr<Mac> make_tdma(MacPort port, const NetworkRules& rules, std::int64_t index,
                               std::int64_t count) {
  return std::make_unique<SlottedMac>(std::move(port), rules, index, count);
}

}  // namespace halocline::networks

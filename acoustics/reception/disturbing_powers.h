// SPDX-License-Identifier: BSD-3-Clause
// The five powers that disturb the signal of a packet or of a link, and the reason of a loss: the power
// without which the packet would have been likeliest to be received.
#pragma once

#include <array>
#include <cstddef>

namespace halocline::acoustics {

// What disturbs a signal. The enumerators have the values of packet_outcome_t and link_t.
enum class LossReason { kNone, kNoise, kLateEchoes, kFastFading, kOtherPackets, kImpulses };
inline constexpr std::array kLossReasons = {LossReason::kNoise, LossReason::kLateEchoes,
                                            LossReason::kFastFading, LossReason::kOtherPackets,
                                            LossReason::kImpulses};

// Powers that disturb a signal, each over the signal of all hydrophones: means over the bits of a packet, or
// over the fading of a link. They add up to 1 / SINR. The receiver's loss is part of the noise.
struct DisturbingPowers {
  double noise = 0, late_echoes = 0, fast_fading = 0, others = 0, impulses = 0;
  double of(LossReason reason) const {
    const std::array<double, 6> all{0, noise, late_echoes, fast_fading, others, impulses};
    return all[static_cast<std::size_t>(reason)];
  }
  double sum() const { return noise + late_echoes + fast_fading + others + impulses; }
  void add(double weight, const DisturbingPowers& more) {
    noise += weight * more.noise;
    late_echoes += weight * more.late_echoes;
    fast_fading += weight * more.fast_fading;
    others += weight * more.others;
    impulses += weight * more.impulses;
  }
};

}  // namespace halocline::acoustics

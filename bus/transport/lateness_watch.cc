// SPDX-License-Identifier: BSD-3-Clause
#include "bus/transport/lateness_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/elementary.h"

namespace halocline::bus {
namespace {

// Upper limits of the bins are 2^(n/8) kFirst_s, n = 0, 1, 2, ...; the first bin has everything below.
constexpr double kFirst_s = 1e-4, kBinsPerOctave = 8;

}  // namespace

void LatenessWatch::set_clock(Clock clock, SimDuration limit) {
  clock_ = std::move(clock);
  limit_ = limit;
}

bool LatenessWatch::note(SimTime steady, SimTime instant) {
  const auto now = clock_ ? clock_() : std::nullopt;
  if (!now) return false;
  add(steady, *now - instant);
  return limit_ > SimDuration() && *now - instant > limit_;
}

std::size_t LatenessWatch::bin_of(double seconds) {
  if (seconds <= kFirst_s) return 0;
  const double bin = std::ceil(elementary::log2(seconds / kFirst_s) * kBinsPerOctave);
  return static_cast<std::size_t>(std::min(bin, static_cast<double>(kBins - 1)));
}

double LatenessWatch::end_of(std::size_t bin) {
  return bin == 0 ? 0
                  : kFirst_s * elementary::exp(std::numbers::ln2 * static_cast<double>(bin) / kBinsPerOctave);
}

void LatenessWatch::add(SimTime steady, SimDuration lateness) {
  const std::int64_t number = steady.nanoseconds() / kSlot.nanoseconds();
  Slot& slot = slots_[static_cast<std::size_t>(number) % kSlots];
  if (slot.number != number) slot = {number, {}, 0};
  const double seconds = std::max(lateness.seconds(), 0.0);
  ++slot.bins[bin_of(seconds)];
  slot.max_s = std::max(slot.max_s, seconds);
}

Lateness LatenessWatch::summary(SimTime steady) {
  const std::int64_t now = steady.nanoseconds() / kSlot.nanoseconds();
  std::array<std::uint64_t, kBins> sums{};
  std::uint64_t count = 0;
  Lateness lateness;
  for (const Slot& slot : slots_) {
    if (slot.number < 0 || slot.number + static_cast<std::int64_t>(kSlots) <= now) continue;
    lateness.max_s = std::max(lateness.max_s, slot.max_s);
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      sums[bin] += slot.bins[bin];
      count += slot.bins[bin];
    }
  }
  // Upper limit of the first bin at which the cumulative share is reached.
  const auto quantile_s = [&](double share) {
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count)));
    std::size_t bin = 0;
    for (std::uint64_t sum = sums[0]; sum < wanted; sum += sums[++bin]) {
    }
    return std::min(end_of(bin), lateness.max_s);
  };
  lateness.p50_s = quantile_s(0.5);
  lateness.p99_s = quantile_s(0.99);
  return lateness;
}

}  // namespace halocline::bus

// SPDX-License-Identifier: BSD-3-Clause
// Propagation of sound along the straight line between two points.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "acoustics/fading/path_fading.h"
#include "acoustics/link/least_loss.h"
#include "acoustics/link/link_kernel.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/environment.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/propagation/seabed_map.h"
#include "core/for_each.h"
#include "core/frames.h"
#include "core/lru_cache.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// Straight path of acoustics/link/link_kernel.h in the water of the instant, weighted by both beams. Through
// a field, delay and absorption are those along the line (acoustics/link/line_means.h); echoes off the bottom
// and the variation of the capacity over the band are those of the profile at the world's origin.
//
// The path meets no terrain. Link tables and link queries state if an echo off the bottom is likely
// (acoustics/link/bottom_echo.h), for which they wait for the seabed between the ends.
//
// Constructing a LinkKernel takes a millisecond and evaluating it a fraction of a microsecond, so one is kept
// for each pair of different modems, `max_kernels` at most. A drifting profile is another water every ten
// minutes; kernels that were not used for kKept are forgotten.
class StraightPropagation : public Propagation {
 public:
  static constexpr std::size_t kMaxKernels = 1024;
  static constexpr SimDuration kKept = SimDuration::from_milliseconds(600'000);
  // Throws InvalidArgument when the environment is out of range.
  explicit StraightPropagation(acoustics::Environment environment, std::size_t max_kernels = kMaxKernels);
  // Without a `seabed`, echoes are unknown and nothing waits.
  explicit StraightPropagation(std::shared_ptr<const EnvironmentTimeline> waters,
                               const acoustics::FadingModel& fading = {},
                               std::shared_ptr<SeabedMap> seabed = nullptr,
                               std::size_t max_kernels = kMaxKernels);

  // Returns one straight path, never in a shadow and never blocked. Doppler: acoustics/link/ray_doppler.h.
  Reception along_line(SimTime at, const EndPair& ends, acoustics::Capacity capacity);
  Reception reception(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return along_line(at, {from, to}, acoustics::Capacity::kComputed);
  }
  Reception reception_without_capacity(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return along_line(at, {from, to}, acoustics::Capacity::kLeftOut);
  }
  std::vector<Reception> receptions(SimTime at, const std::vector<EndPair>& links,
                                    const ForEach& for_each) override;
  // Returns the link where the terrain is known to cut the line: no path, silence.
  Reception blocked(SimTime at, const LinkEnd& from, const LinkEnd& to);
  bool is_ready(SimTime at, const LinkEnd& from, const LinkEnd& to) override {
    return are_ready(at, {EndPair{from, to}});
  }
  bool is_ready_for_packet(SimTime, const LinkEnd&, const LinkEnd&) override { return true; }
  bool are_ready(SimTime at, const std::vector<EndPair>& links) override;
  std::optional<acoustics::LeastLoss> least_loss(SimTime at, double frequency_hz,
                                                 double deepest_end_m) const override {
    return acoustics::LeastLoss::of_straight_path(waters_->at(at), frequency_hz, deepest_end_m);
  }
  const acoustics::Environment& environment(SimTime at) const override { return waters_->at(at); }

  std::shared_ptr<const acoustics::LinkKernel> kernel_of(SimTime at, const acoustics::Modem& transmitter,
                                                         const acoustics::Modem& receiver);

 private:
  // Numbers that a budget depends on, beam, family.
  using ModemKey = std::tuple<std::array<double, 5>, std::vector<double>, std::string>;
  using PairKey = std::tuple<EnvironmentTimeline::WaterId, ModemKey, ModemKey>;
  static ModemKey key_of(const acoustics::Modem& modem);
  static bool are_alike(const acoustics::Modem& a, const acoustics::Modem& b);
  Reception along_line(const acoustics::LinkKernel& kernel, const acoustics::Environment& water,
                       const EndPair& ends, acoustics::Capacity capacity) const;
  struct EchoQuery {
    const acoustics::LinkKernel& kernel;
    const EndPair& ends;
    Reception& reception;
  };
  // Sets the echo off the bottom of links between the same two places, in either direction.
  void add_bottom_echoes(std::span<const EchoQuery> links_of_one_pair) const;

  std::shared_ptr<const EnvironmentTimeline> waters_;
  acoustics::FadingModel fading_;
  std::shared_ptr<SeabedMap> seabed_;
  LruCache<PairKey, std::shared_ptr<const acoustics::LinkKernel>> kernels_;
  SimTime next_forgetting_ = SimTime() + kKept;
  // Most recent kernel, which most calls use again.
  EnvironmentTimeline::WaterId last_water_ = 0;
  std::shared_ptr<const acoustics::LinkKernel> last_;
};

}  // namespace halocline::channel_server

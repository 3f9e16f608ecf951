// SPDX-License-Identifier: BSD-3-Clause
// The eigenrays of profile_rays.h to receivers at several depths of one place.
//
// Method. The fan is traced and halved once for all receivers. Between paths that were traced to receivers
// above and below, paths of the same bounce sequence are interpolated (PathChains). Over a rough bottom each
// receiver has a search of its own that uses the same rays (DepthFanCache). Where the core of a channel is
// left out, nothing is shared.
//
// Error relative to profile_rays(): that of PathChains; results therefore depend on the order of the calls.
// Not shared between threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/fan_tracer.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/rays/traced_eigenray.h"

namespace halocline::acoustics {

// An image of a receiver in unfolded depth: target = sign z + period k.
struct ReceiverImage {
  double sign, k, target;
};

// Paths to receivers at several depths of one place. Between two receivers whose paths were traced, paths of
// the same bounce sequence are interpolated.
//
// Model. As the receiver descends, the path to one image with one bounce sequence changes smoothly. Launch
// angle and delay are cubics of depth through two traced paths with the slopes of both,
//   d theta / dz = +-1 / (d zeta / d theta),  d delay / dz = sin / c  at the receiver.
// The spreading is the slope of the former cubic times 1 / (A^2 |d zeta / d theta|), which is interpolated
// linearly. Losses of bounces, absorption and length are linear in depth. The arrival angle follows from
// Snell's xi, which is linear too.
//
// A path is traced after all unless
// - the cubic of zeta over theta meets the image within 5 mm and has the same slope within 0.4 %,
// - the slope of the delay at the quarters matches the arrival angle within 0.3 us, and
// - losses and phases of the two traced paths differ little.
//
// For a path weaker than the strongest, these tolerances grow in inverse proportion to its relative power, up
// to 100 times, those of the delay up to 10 times.
//
// Error: 0.05 dB of the power of all paths together, 1 us of a strong path
// (tests/acoustics/rays/depth_fan_test.cc).
//
// One object per search, not shared between threads.
class PathChains {
 public:
  // Refers to the tracer, whose receiver is the one of the current call.
  explicit PathChains(const ArcTracer& tracer) : tracer_(tracer) {}

  // Begins a receiver: the paths that follow are those of the tracer's present receiver.
  void begin_receiver() { strongest_.push_back(0); }
  // The path that passes the image between two rays of the fan, interpolated. Empty when it has to be traced,
  // after which the caller hands it to keep().
  std::optional<ImageHit> between(const FanRay& a, const FanRay& b, const ReceiverImage& image);
  void keep(const ImageHit& path, const ReceiverImage& image);

 private:
  struct Node {
    double depth_m, speed_mps;  // depth of the receiver, and the sound speed there
    std::size_t receiver;       // index in the order of receivers
    ImageHit path;
  };
  // The paths to one image with one bounce sequence.
  struct Chain {
    std::vector<Node> nodes;  // rising in depth
    bool is_several = false;  // several paths at one depth: it is unknown which are neighbours
    bool holds(const ImageHit& path) const;
  };
  struct Direction {
    double sine, speed_mps;  // sine of the angle, and the sound speed at the same place
  };
  // The direction in which a path between two nodes arrives, at a share of the depth from one to the other;
  // empty when it is horizontal there.
  std::optional<Direction> direction_between(const Node& a, const Node& b, double sine_a, double sine_b,
                                             double share) const;
  static std::int64_t number_of(const ReceiverImage& image);
  // Factor by which tolerances are wider for a path, 1..100.
  double slack_of(const Node& a, const Node& b) const;
  void note_strength(const Eigenray& path);
  std::optional<ImageHit> interpolated(const Node& a, const Node& b, const ReceiverImage& image) const;

  const ArcTracer& tracer_;
  std::vector<double> strongest_;  // received pressure of the strongest path at each receiver, re 1 m
  std::unordered_map<std::int64_t, std::vector<Chain>> chains_;  // keyed by image
};

// Rays and paths that the searches for receivers at several depths of one place share.
//
// Rays of the fan, and those that represent diffuse sound, depend on the launch angle alone, so they are the
// same to the last bit as in a search without the cache. Paths are interpolated (PathChains). Not shared
// between threads.
class DepthFanCache {
 public:
  // Refers to tracer and fan, which have to outlive this object.
  DepthFanCache(const ArcTracer& tracer, FanTracer& fan) : tracer_(tracer), fan_(fan), chains_(tracer) {}

  // Returns the ray of FanTracer::trace; each ray is traced only once.
  FanRay traced(double theta, std::size_t enough_events);
  // Events of the fan up to this number belong to rays that are kept.
  std::size_t kept_events() const { return kept_events_; }
  // Returns the ray of diffuse_ray(); each ray is traced only once.
  std::optional<DiffuseRay> diffuse(double theta, std::size_t window);
  PathChains& chains() { return chains_; }

 private:
  static constexpr std::size_t kMaxEvents = 4'000'000;  // 4 bytes each; beyond, rays are traced again
  struct Key {
    double theta;
    std::size_t enough_events;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      return std::hash<double>()(key.theta) ^ (key.enough_events * 0x9E3779B97F4A7C15U);
    }
  };

  const ArcTracer& tracer_;
  FanTracer& fan_;
  PathChains chains_;
  std::size_t kept_events_ = 0;
  // The maps are only looked up, never iterated, so their order has no effect.
  std::unordered_map<Key, FanRay, KeyHash> rays_;
  std::unordered_map<double, std::optional<DiffuseRay>> diffuse_;
};

// The eigenrays to receivers at several depths of one place, as SharedRays.
class DepthFan : public SharedRays {
 public:
  DepthFan();
  ~DepthFan() override;
  DepthFan(const DepthFan&) = delete;
  DepthFan& operator=(const DepthFan&) = delete;

  // Implements SharedRays::at; only the receiver's depth and the options may change from call to call.
  std::vector<Eigenray> at(const ProfiledSea& sea, const RayLink& link) override;

 private:
  class Column;
  std::vector<std::unique_ptr<Column>> columns_;  // one for each set of options
};

}  // namespace halocline::acoustics

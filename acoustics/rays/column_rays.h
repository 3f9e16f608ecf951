// SPDX-License-Identifier: BSD-3-Clause
// The rays of profile_rays.h to receivers at several depths of one place.
//
// Method: the fan is traced and halved once for all of them; between paths that were traced to receivers
// above and below, those of the same history are interpolated (PathChains). Over a rough bottom each receiver
// has a search of its own, by the same rays (ColumnCache); where the core of a channel is left out nothing is
// shared.
//
// Error beside profile_rays(): that of PathChains; so results depend on the order of the calls. Not shared
// between threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/fan_tracer.h"
#include "acoustics/rays/profile_path.h"
#include "acoustics/rays/traced_ray.h"

namespace halocline::acoustics {

// An image of a receiver in unfolded depth: sign z + period k.
struct ReceiverImage {
  double sign, k, target;
};

// Paths to receivers at several depths of one place: between two that were traced, those of one history
// follow by interpolation.
//
// Model. As the receiver goes down, the path of one image and one history changes smoothly. Launch angle and
// delay are the cubics of depth through two traced paths with the slopes of both,
//   d theta / dz = +-1 / (d zeta / d theta),  d delay / dz = sin / c  at the receiver,
// the spreading follows from the slope of the former times what is even between them, 1 / (A^2 |d zeta / d
// theta|); the losses of bounces, absorption and length are linear, and of the arrival angle Snell's xi is.
//
// A path is traced by itself unless the cubic of zeta over theta meets the image within 5 mm and has the same
// slope within 0.4 %, the slope of delay at the quarters is that of the arrival angle within 0.3 us, and
// losses and phases of the two differ little. Of a path weaker than the strongest all that may be as much
// more as its power is less, 100 times at most, of delay 10 times.
//
// Error: 0.05 dB of all paths together, 1 us of a strong path (tests/acoustics/rays/ray_column_test.cc). One
// for each search, not shared between threads.
class PathChains {
 public:
  // Refers to the tracer, whose receiver is that of each call.
  explicit PathChains(const ArcTracer& tracer) : tracer_(tracer) {}

  // The paths that follow are those of the tracer's receiver.
  void begin_receiver() { strongest_.push_back(0); }
  // The path that passes the image between two rays of the fan; empty where it has to be traced, and then
  // kept.
  std::optional<ProfilePath> between(const FanRay& a, const FanRay& b, const ReceiverImage& image);
  void keep(const ProfilePath& path, const ReceiverImage& image);

 private:
  struct Node {
    double depth_m, speed_mps;  // of the receiver, and there
    std::size_t receiver;       // by the order of receivers
    ProfilePath path;
  };
  struct Chain {
    std::vector<Node> nodes;  // by depth
    bool is_several = false;  // paths of one depth: they do not tell whose neighbour is whose
    bool holds(const ProfilePath& path) const;
  };
  struct Direction {
    double sine, speed_mps;  // of the angle, where the sound speed is that
  };
  // In which a path between two arrives at a share of the way from the one to the other; empty where it is
  // horizontal.
  std::optional<Direction> arrival_between(const Node& a, const Node& b, double sine_a, double sine_b,
                                           double share) const;
  static std::int64_t number_of(const ReceiverImage& image);
  // By how much tolerances are wider for a path, 1..10.
  double slack_of(const Node& a, const Node& b) const;
  void note_strength(const Arrival& path);
  std::optional<ProfilePath> interpolated(const Node& a, const Node& b, const ReceiverImage& image) const;

  const ArcTracer& tracer_;
  std::vector<double> strongest_;                                // received pressure of each receiver, re 1 m
  std::unordered_map<std::int64_t, std::vector<Chain>> chains_;  // by image
};

// What the searches of links to receivers at several depths of one place share: rays and paths, whatever
// found them.
//
// Rays of a fan and those that stand for diffuse sound depend on the launch angle alone, so they are the same
// to the last bit as without it. Paths are interpolated (PathChains). Not shared between threads.
class ColumnCache {
 public:
  // Refers to both, which have to outlive this.
  ColumnCache(const ArcTracer& tracer, FanTracer& fan) : tracer_(tracer), fan_(fan), chains_(tracer) {}

  // As FanTracer::trace.
  FanRay traced(double theta, std::size_t enough_events);
  // Events of the fan up to here belong to rays that are kept.
  std::size_t kept_events() const { return kept_events_; }
  // As diffuse_ray().
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
  // Looked up, never walked.
  std::unordered_map<Key, FanRay, KeyHash> rays_;
  std::unordered_map<double, std::optional<DiffuseRay>> diffuse_;
};

class ColumnRays : public SharedRays {
 public:
  ColumnRays();
  ~ColumnRays() override;
  ColumnRays(const ColumnRays&) = delete;
  ColumnRays& operator=(const ColumnRays&) = delete;

  // From call to call only the receiver's depth and the options change.
  std::vector<Arrival> at(const ProfiledSea& sea, const RayLink& link) override;

 private:
  class Column;
  std::vector<std::unique_ptr<Column>> columns_;  // one for each options
};

}  // namespace halocline::acoustics

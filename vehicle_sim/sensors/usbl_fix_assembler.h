// SPDX-License-Identifier: BSD-3-Clause
// A vehicle's USBL array: fixes from the true directions of arrival and the packets received.
//
// Model: the true direction of an arrival is in OUTCOME (elevation of the ray, azimuth of the straight line),
// which the vehicle itself does not receive; RECEIVE shows that the packet is for it, and its travel time
// where that is known on board. A fix is made when both have come and the attitude at the instant of the
// first bit is known: between two noted poses it is interpolated along the shortest turn. Fixes leave in the
// order in which their second half came. What waits for longer than kTimeout is forgotten.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <tuple>
#include <vector>

#include "core/archive.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "vehicle_sim/sensors/sensor_errors.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/sensors/sensors.h"

namespace halocline::vehicle_sim {

// What names a packet: sender, kind, session, number.
struct PacketKey {
  std::int32_t source_id = 0;
  std::int8_t kind = 0;
  std::int64_t session = 0, sequence = 0;
  auto operator<=>(const PacketKey&) const = default;
};

// Where a packet's sound came from, world frame.
struct SoundArrival {
  SimTime when;              // of the first bit
  double azimuth_rad = 0;    // from north by east
  double elevation_rad = 0;  // above the horizontal
};

struct UsblFix {
  PacketKey packet;
  SimTime when;
  SoundDirection direction;
  std::optional<double> travel_time_s;  // one way
};

class UsblFixAssembler {
 public:
  static constexpr SimDuration kTimeout = SimDuration::from_milliseconds(20'000);

  UsblFixAssembler(const UsblSettings& settings, const SensorIdentity& identity)
      : settings_(settings), identity_(identity) {}

  void on_arrival(const PacketKey& packet, const SoundArrival& arrival);
  // Of a packet for this vehicle; the travel time where it is known on board.
  void on_packet(const PacketKey& packet, std::optional<double> travel_time_s);
  // Poses come in ascending order.
  void note_pose(SimTime when, const Quaternion& orientation);

  void clear();
  void archive(Archive& a) { a(poses_, waiting_); }

  // All fixes that are complete now, taken out; none while the array is dead (they are then lost).
  std::vector<UsblFix> take(bool is_dead);

 private:
  struct Waiting {
    PacketKey packet;
    std::optional<SoundArrival> arrival;
    bool received = false;
    std::optional<double> travel_time_s;
    SimTime since;
  };
  struct Pose {
    SimTime when;
    Quaternion orientation;
    void archive(Archive& a) { a(when, orientation); }
  };

  Waiting& entry_of(const PacketKey& packet);
  std::optional<Quaternion> orientation_at(SimTime when) const;
  UsblFix fix_of(const Waiting& waiting, const Quaternion& orientation) const;

  UsblSettings settings_;
  SensorIdentity identity_;
  std::deque<Pose> poses_;
  std::deque<Waiting> waiting_;
};

}  // namespace halocline::vehicle_sim

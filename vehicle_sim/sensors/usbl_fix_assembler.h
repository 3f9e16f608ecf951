// SPDX-License-Identifier: BSD-3-Clause
// USBL array of a vehicle: fixes from the true directions of arrival and the packets received.
//
// Model: the true direction of an arrival is in OUTCOME (elevation of the ray, azimuth of the straight line),
// which the vehicle itself does not receive. RECEIVE shows that the packet is for the vehicle, and holds the
// travel time where it is known on board. A fix is computed when both messages have arrived and the attitude
// at the instant of the first bit is known: it is interpolated between two recorded poses by the shortest
// rotation. Fixes leave when they are complete, several at once in the order of their first messages. An
// entry that waits for longer than kTimeout is dropped.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/archive.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "vehicle_sim/sensors/sensor_errors.h"
#include "vehicle_sim/sensors/sensor_settings.h"
#include "vehicle_sim/sensors/sensors.h"

namespace halocline::vehicle_sim {

// Identity of a packet: sender, kind, session, number.
struct PacketKey {
  std::int32_t source_id = 0;
  std::int8_t kind = 0;
  std::int64_t session = 0, sequence = 0;
  auto operator<=>(const PacketKey&) const = default;
};

// Direction of arrival of a packet in the world frame.
struct SoundArrival {
  SimTime when;              // instant of the first bit
  double azimuth_rad = 0;    // clockwise from north
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
  // A packet for this vehicle has been received; `travel_time_s`: empty where it is not known on board.
  void on_packet(const PacketKey& packet, std::optional<double> travel_time_s);
  // Records the attitude at `when`. An instant that is not after the last one is ignored.
  void note_pose(SimTime when, const Quaternion& orientation);

  void clear();
  void archive(Archive& a) { a(poses_, waiting_); }

  // Removes and returns all fixes that are complete; while the array is dead they are lost.
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

// SPDX-License-Identifier: BSD-3-Clause
// The sounds at one receiver as intervals of time: the packets that reach it, those it transmits itself, and
// those it has acquired.
//
// Results depend on the instants of the sounds, not on the order of the calls. A sound is kept until no
// reception can overlap it: neither one that is still open nor one that is added late. Not thread-safe.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <boost/container/small_vector.hpp>

#include "acoustics/math/frequency_band.h"
#include "channel_server/packets/packet.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// One path of a packet at the receiver during [begin, end); power in uPa^2 over the band of its packet.
struct AudiblePath {
  SimTime begin, end;
  double power = 0;
};

// A packet at the receiver: the interval of all its paths together, and each path.
struct AudiblePacket {
  PacketPointer packet;
  SimTime begin, end;                                    // from the first path's begin to the last path's end
  boost::container::small_vector<AudiblePath, 1> paths;  // one on a straight line
};

// The noise of a vehicle over the band of the packet that it disturbs.
struct NoiseSound {
  PacketPointer source;
  double power = 0;  // uPa^2
};

// A packet and an interval of time: a transmission of the receiver's own, or a packet that it follows.
struct PacketInterval {
  PacketPointer packet;
  SimTime begin, end;
};

// A path of another packet, with its power in the band of the packet that it disturbs.
struct Interference {
  SimTime begin, end;
  double power = 0;        // uPa^2
  std::size_t source = 0;  // index into Interferers::packets
};

// The packets that disturb another packet, and their paths.
struct Interferers {
  std::vector<PacketPointer> packets;
  std::vector<Interference> paths;  // in an order that does not depend on the order of arrival
};

// An instant at which the summed power of all paths of other packets in a band crosses a level.
struct PowerCrossing {
  SimTime at = SimTime::never();
  double power = 0;  // from then on, uPa^2
};

class ReceiverState {
 public:
  // `kept_longer`: how long after its end a sound may still overlap a reception that is added late.
  explicit ReceiverState(SimDuration kept_longer) : kept_longer_(kept_longer) {}

  // Adds a packet that arrives, and opens a reception from its begin until close(). Returns true when the
  // packet comes too late: it overlaps a sound in a common band that had ended by `decided_by`, so that the
  // outcome of that sound is already decided.
  bool open(AudiblePacket packet, SimTime decided_by = SimTime::at_once());
  // Closes a reception that was opened at `begin`. May drop sounds, as forget(now).
  void close(SimTime begin, SimTime now);
  // Adds a transmission of the receiver's own. Returns true when it comes too late, as for open().
  bool transmit(const PacketInterval& span, SimTime decided_by = SimTime::at_once());
  // Records that the receiver acquires a packet at `instant` and follows it until its end.
  void acquire(const PacketInterval& reception, SimTime instant) {
    acquisitions_.push_back({reception, instant});
  }

  // Returns the receiver's own transmissions during any part of [begin, end), sorted by begin.
  std::vector<PacketPointer> transmitted_during(SimTime begin, SimTime end) const;
  // Returns the packet that the receiver follows at `instant` and that keeps it from acquiring `other`; null
  // without one. A transmission of the receiver's own ends following. Answers to one ping are followed side
  // by side.
  std::shared_ptr<const Packet> followed_at(SimTime instant, const Packet& other) const;
  // Returns all packets that disturb `packet` during [begin, end), with their power in its band. Packets
  // without power in that band are left out, and so are other answers to the ping that `packet` answers.
  Interferers interferers_of(const Packet& packet, SimTime begin, SimTime end) const;

  // True when the receiver transmits at `instant`; transmission_end() returns until when, never() when it
  // does not.
  bool transmits_at(SimTime instant) const { return transmission_end(instant) != SimTime::never(); }
  SimTime transmission_end(SimTime instant) const;
  // Returns the first instant from `from` on at which the power in `band` of all paths known so far exceeds
  // `level`, or with `is_above` false does not exceed it. `level` is in uPa^2.
  PowerCrossing next_crossing(SimTime from, const acoustics::Band& band, double level, bool is_above) const;

  bool silent() const { return sounds_.empty() && transmissions_.empty() && open_.empty(); }
  // Drops sounds that ended before every open reception and more than `kept_longer` before `now`.
  void forget(SimTime now);
  std::size_t size() const { return sounds_.size() + transmissions_.size() + acquisitions_.size(); }

 private:
  bool overlaps_decided(const PacketInterval& span, SimTime decided_by) const;

  struct Acquisition {
    PacketInterval reception;
    SimTime instant;
  };
  SimDuration kept_longer_;
  std::vector<AudiblePacket> sounds_;  // sorted by begin
  SimDuration longest_;                // duration of the longest sound so far
  std::vector<PacketInterval> transmissions_;
  std::vector<Acquisition> acquisitions_;
  std::vector<SimTime> open_;  // begins of the open receptions, ascending
  std::size_t size_at_forgetting_ = 0;
};

}  // namespace halocline::channel_server

// SPDX-License-Identifier: BSD-3-Clause
// The sounds at one receiver, by interval: the packets that reach it, those it sends itself, and those it has
// acquired.
//
// Everything counts by its own instants, whatever the order of the calls. Sounds are kept until no reception
// that is still open, nor one that is added late, can overlap them. Not thread-safe.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <boost/container/small_vector.hpp>

#include "acoustics/math/frequency_band.h"
#include "channel_server/packets/packet.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// One path of a packet at the receiver: [begin, end), power in uPa^2 over the band of its packet.
struct AudiblePath {
  SimTime begin, end;
  double power = 0;
};

struct AudiblePacket {
  PacketPointer packet;
  SimTime begin, end;                                    // of all paths together
  boost::container::small_vector<AudiblePath, 1> paths;  // one on a straight line
};

// The noise of a vehicle, over the band of the packet it disturbs.
struct NoiseSound {
  PacketPointer source;
  double power = 0;  // uPa^2
};

// A packet during an interval: a transmission of its own, or one that the receiver follows.
struct PacketInterval {
  PacketPointer packet;
  SimTime begin, end;
};

// A path of another packet, with the power it has in the band of the packet it disturbs.
struct Interference {
  SimTime begin, end;
  double power = 0;        // uPa^2
  std::size_t source = 0;  // index into Interferers::packets
};

struct Interferers {
  std::vector<PacketPointer> packets;
  std::vector<Interference> paths;  // in an order that does not depend on the order of arrival
};

// The sum of all paths of others in a band at the instant at which it passes a level.
struct PowerCrossing {
  SimTime at = SimTime::never();
  double power = 0;  // from then on, uPa^2
};

class ReceiverState {
 public:
  // `kept_longer`: how long after its end a sound may still overlap a reception that is added late.
  explicit ReceiverState(SimDuration kept_longer) : kept_longer_(kept_longer) {}

  // A packet arrives; a reception is open from its begin on until closed. Returns whether it comes too late:
  // it overlaps, in a band of both, a sound that had ended by `decided_by`, so that what became of that is
  // decided.
  bool open(AudiblePacket packet, SimTime decided_by = SimTime::at_once());
  void close(SimTime begin, SimTime now);
  // Likewise.
  bool transmit(const PacketInterval& span, SimTime decided_by = SimTime::at_once());
  // The receiver acquires a packet at `instant` and follows it until its end.
  void acquire(const PacketInterval& reception, SimTime instant) {
    acquisitions_.push_back({reception, instant});
  }

  // What the receiver itself sends at any instant of [begin, end), by begin.
  std::vector<PacketPointer> transmitted_during(SimTime begin, SimTime end) const;
  // The packet that the receiver follows at `instant` and that keeps it from `other`; null without one. A
  // transmission of its own ends that. Answers to one ping are followed beside each other.
  std::shared_ptr<const Packet> followed_at(SimTime instant, const Packet& other) const;
  // All packets that disturb `packet` during [begin, end), in its band: all others but answers to the ping
  // that it answers; those of no power in it left out.
  Interferers interferers_of(const Packet& packet, SimTime begin, SimTime end) const;

  // Whether it transmits at `instant`, and until when; never() where it does not.
  bool transmits_at(SimTime instant) const { return transmission_end(instant) != SimTime::never(); }
  SimTime transmission_end(SimTime instant) const;
  // The first instant from `from` on at which the power in `band` of all paths known so far is above `level`,
  // or with `is_above` false is not.
  PowerCrossing next_crossing(SimTime from, const acoustics::Band& band, double level, bool is_above) const;

  bool silent() const { return sounds_.empty() && transmissions_.empty() && open_.empty(); }
  // Drops what ended before every open reception and `kept_longer` before `now`.
  void forget(SimTime now);
  std::size_t size() const { return sounds_.size() + transmissions_.size() + acquisitions_.size(); }

 private:
  bool overlaps_decided(const PacketInterval& span, SimTime decided_by) const;

  struct Acquisition {
    PacketInterval reception;
    SimTime instant;
  };
  SimDuration kept_longer_;
  std::vector<AudiblePacket> sounds_;  // by begin
  SimDuration longest_;                // of all so far
  std::vector<PacketInterval> transmissions_;
  std::vector<Acquisition> acquisitions_;
  std::vector<SimTime> open_;  // begins, ascending
  std::size_t size_at_forgetting_ = 0;
};

}  // namespace halocline::channel_server

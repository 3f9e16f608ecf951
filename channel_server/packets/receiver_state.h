// What sounds at one receiver, by interval: the packets that reach it, those it sends itself, and those it was
// locked onto.
//
// Everything here is by its own instants, whatever the order it was told in. Sounds are kept until no reception
// that is still open, nor one that is asked for late, can overlap them. Not thread-safe.
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "channel_server/packets/packet.h"

namespace halocline::channel_server {

// One path of a packet at the receiver: [begin, end), power in uPa^2 over the band of its packet.
struct HeardPath {
  SimTime begin, end;
  double power = 0;
};

struct HeardPacket {
  PacketPointer packet;
  SimTime begin, end;  // of all paths together
  std::vector<HeardPath> paths;
};

// A packet during an interval: one's own in the water, or one that the receiver follows.
struct Span {
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
  std::vector<Interference> paths;
};

// The share of `of` that lies within `in`, 0..1.
double band_share(const acoustics::Band& of, const acoustics::Band& in);

class ReceiverState {
 public:
  // `kept_longer`: how long after its end a sound can still be asked about, by receptions told late.
  explicit ReceiverState(SimDuration kept_longer) : kept_longer_(kept_longer) {}

  // A packet arrives; a reception is open from its begin on until closed.
  void open(HeardPacket packet);
  void close(SimTime begin, SimTime now);
  void transmit(const Span& span) { transmissions_.push_back(span); }
  // The receiver noticed a packet at `noticed` and follows it until its end.
  void lock(const Span& reception, SimTime noticed) { locks_.push_back({reception, noticed}); }

  // What the receiver itself sends at any instant of [begin, end), by begin.
  std::vector<PacketPointer> transmitted_during(SimTime begin, SimTime end) const;
  // Whom the receiver follows at `instant`; null for nobody. A transmission of its own ends that.
  std::shared_ptr<const Packet> locked_onto(SimTime instant) const;
  // All other packets than `packet` during [begin, end), in its band; those of no power in it left out.
  Interferers interferers_of(const Packet& packet, SimTime begin, SimTime end) const;

  bool silent() const { return heard_.empty() && transmissions_.empty() && open_.empty(); }
  // Drops what ended before every open reception and `kept_longer` before `now`.
  void forget(SimTime now);
  std::size_t size() const { return heard_.size() + transmissions_.size() + locks_.size(); }

 private:
  struct Lock {
    Span reception;
    SimTime noticed;
  };
  SimDuration kept_longer_;
  std::vector<HeardPacket> heard_;  // by begin
  SimDuration longest_;             // of those ever heard
  std::vector<Span> transmissions_;
  std::vector<Lock> locks_;
  std::multiset<SimTime> open_;  // begins
  std::size_t size_at_forgetting_ = 0;
};

}  // namespace halocline::channel_server

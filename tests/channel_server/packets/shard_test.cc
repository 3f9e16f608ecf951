// SPDX-License-Identifier: BSD-3-Clause
// Several media of one water, each following packets only to the receivers it serves: together they publish
// what one publishes.
#include "channel_server/vehicles/shard.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "channel_server/packets/medium_event.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/packet_medium.h"
#include "channel_server/vehicles/vehicle_id.h"
#include "channel_server/vehicles/vehicle_registry.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "tests/channel_server/packets/busy_sea.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using testing::name_of;

constexpr std::size_t kPackets = 3000;

// All that distinguishes one event from another, in full precision.
std::string text_of(const MediumEvent& event) {
  std::ostringstream out;
  out.precision(17);
  out << event.at.nanoseconds() << ' ' << event.late << ' ';
  if (const auto* receipt = std::get_if<Receipt>(&event.what)) {
    out << "receipt " << receipt->vehicle << ' ' << receipt->packet_sequence << ' '
        << static_cast<int>(receipt->result) << ' ' << receipt->start.nanoseconds();
  } else if (const auto* end = std::get_if<PacketOutcome>(&event.what)) {
    const PacketName name = end->packet->name();
    out << "end " << name.source_id << ' ' << name.packet_sequence << ' ' << static_cast<int>(name.kind)
        << ' ' << end->receiver << ' ' << static_cast<int>(end->kind) << ' ' << end->travel_time_s << ' '
        << end->two_way_travel_time_s << ' ' << end->budget.snr.value << ' ' << end->statistics.sinr.value
        << ' ' << end->statistics.success_draw;
    for (const PacketName& collider : end->statistics.colliders) out << ' ' << collider.packet_sequence;
  } else if (const auto* noticed = std::get_if<ModemEvent>(&event.what)) {
    out << "event " << noticed->vehicle << ' ' << static_cast<int>(noticed->kind) << ' '
        << noticed->level.value << ' ' << static_cast<int>(noticed->outcome);
  }
  return out.str();
}

ConfiguredModems watching_modems() {
  ConfiguredModems modems = testing::busy_modems();
  for (auto& [name, modem] : modems.of_vehicle) modem.listening.events = true;
  return modems;
}

// A registry, a propagation and a medium of one server; all receive all.
struct Server {
  Server(Shard shard, double until_s)
      : fleet({for_s(0.05), for_s(5)}, watching_modems()),
        medium(fleet, propagation,
               {.max_lateness = for_s(10), .max_earliness = for_s(until_s), .seed = 1, .shard = shard}) {
    for (const auto& timed : testing::busy_states(until_s)) {
      EXPECT_EQ(fleet.add_state(name_of(timed.id), timed.id, timed.state), "");
    }
    for (const auto& request : testing::busy_requests(kPackets))
      EXPECT_FALSE(medium.transmit(request, SimTime()));
  }
  VehicleRegistry fleet;
  testing::ThreePaths propagation;
  PacketMedium medium;
};

// What `count` servers publish together, sorted; they pass on answers to pings at the instant these are
// known.
std::vector<std::string> said_by(int count) {
  const double until_s = static_cast<double>(kPackets) / testing::kPacketsPerSecond + 30;
  std::vector<std::unique_ptr<Server>> servers;
  for (int i = 0; i < count; ++i) servers.push_back(std::make_unique<Server>(Shard{i, count}, until_s));
  std::vector<std::string> published;
  for (;;) {
    SimTime next = SimTime::never();
    for (const auto& server : servers) next = std::min(next, server->medium.next_event());
    if (next == SimTime::never()) break;
    std::vector<ModemReply> answers;
    for (const auto& server : servers) {
      for (const MediumEvent& event : server->medium.advance_to(next)) {
        if (const auto* answer = std::get_if<ModemReply>(&event.what)) {
          answers.push_back(*answer);
        } else {
          published.push_back(text_of(event));
        }
      }
    }
    for (const ModemReply& answer : answers) {
      for (const auto& server : servers) server->medium.add_answer(answer);
    }
  }
  std::sort(published.begin(), published.end());
  return published;
}

class Shards : public ::testing::TestWithParam<int> {};

TEST_P(Shards, TogetherPublishWhatOneServerPublishes) {
  const auto one = said_by(1);
  EXPECT_GT(one.size(), kPackets * 15);
  EXPECT_EQ(said_by(GetParam()), one);
}

INSTANTIATE_TEST_SUITE_P(Counts, Shards, ::testing::Values(2, 3, 7, 25));

TEST(Shard, EveryVehicleIsServedByExactlyOne) {
  for (const int count : {1, 2, 5}) {
    for (VehicleId id = 1; id <= 100; ++id) {
      int serving = 0;
      for (int index = 0; index < count; ++index) serving += Shard{index, count}.serves(id) ? 1 : 0;
      EXPECT_EQ(serving, 1);
    }
  }
}

// Four groups of 25, 10 km apart, numbered in turn: each server has one.
TEST(Shard, VehiclesOfOnePlaceHaveOneServer) {
  std::vector<StartPlace> vehicles;
  for (VehicleId id = 1; id <= 100; ++id)
    vehicles.push_back({id, {id % 4 < 2 ? 0.0 : 12e3, (id % 2 == 0 ? 0.0 : 10e3) + id, 20}});
  const Shard shard{0, 4, servers_by_place(vehicles, 4)};
  std::map<int, std::set<int>> groups;  // of each server
  for (VehicleId id = 1; id <= 100; ++id) groups[shard.of(id)].insert(id % 4);
  EXPECT_EQ(groups.size(), 4u);
  for (const auto& [server, some] : groups) EXPECT_EQ(some.size(), 1u) << server;
  EXPECT_EQ(shard.of(1001), 1001 % 4);  // of no scenario
}

TEST(Shard, ServersHaveAsManyVehiclesButForOne) {
  for (const auto& [count, scale] : {std::pair{2, 1.0}, {3, 20.0}, {7, 1.0}, {25, 20.0}}) {
    std::vector<StartPlace> vehicles;
    for (VehicleId id = 1; id <= 100; ++id)
      vehicles.push_back({id, {37.0 * scale * (id % 11), 53.0 * scale * (id % 7), 20}});
    std::vector<int> served(static_cast<std::size_t>(count));
    for (const auto& [id, server] : *servers_by_place(vehicles, count))
      ++served[static_cast<std::size_t>(server)];
    const auto [least, most] = std::minmax_element(served.begin(), served.end());
    EXPECT_LE(*most - *least, 1) << count;
  }
}

// Whoever starts in one area of 3 km is shared in turns, whatever its place there; beyond, by place.
TEST(Shard, VehiclesOfASmallAreaAreSharedInTurns) {
  for (const double side_m : {2900.0, 3100.0}) {
    std::vector<StartPlace> vehicles;
    for (VehicleId id = 1; id <= 100; ++id) vehicles.push_back({id, {side_m * (id - 1) / 99, 500, 20}});
    const Shard shard{0, 2, servers_by_place(vehicles, 2)};
    for (VehicleId id = 1; id <= 100; ++id)
      EXPECT_EQ(shard.of(id), side_m < 3000 ? (id - 1) % 2 : (id <= 50 ? 0 : 1)) << side_m << ' ' << id;
  }
}

TEST(Shard, AnAnswerAddedTwiceIsTransmittedOnce) {
  testing::ThreePaths propagation;
  VehicleRegistry fleet({for_s(0.05), for_s(5)}, testing::busy_modems());
  for (double t = 0; t < 20; t += 1) {
    for (const VehicleId id : {3, 4}) {
      EXPECT_EQ(fleet.add_state(name_of(id), id, {at_s(t), Vec3(100.0 * id, 0, 20), Vec3::Zero()}), "");
    }
  }
  PacketMedium medium(fleet, propagation, {for_s(10), for_s(60), 1, {0, 2}});  // serves 4
  ModemReply answer;
  answer.request.vehicle = name_of(3);
  answer.request.source_id = 3;
  answer.request.destination_id = 4;
  answer.request.packet_sequence = 8;
  answer.request.kind = PacketKind::kPingReply;
  answer.request.start = at_s(2);
  answer.asked_departure = at_s(1);
  medium.add_answer(answer);
  std::size_t ends = medium.advance_to(at_s(10)).size();
  medium.add_answer(answer);
  ends += medium.advance_to(at_s(19)).size();
  EXPECT_EQ(ends, 1u);
}

}  // namespace
}  // namespace halocline::channel_server

// Long random runs through the medium: nothing is lost, nothing is counted twice, and the order in which
// messages came does not matter.
#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "channel_server/packet_medium.h"
#include "core/random.h"
#include "tests/channel_server/channel_fixtures.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;
using testing::for_s;
using testing::name_of;
using testing::quick_modem;

constexpr VehicleId kVehicles = 8;
constexpr double kRunS = 120;

double draw(const char* purpose, std::uint32_t who, std::uint64_t which) {
  return uniform_at({.seed = 5, .purpose = purpose_of(purpose), .who = who, .which = which});
}

struct HeardState {
  VehicleId id;
  StampedState state;
};

// Vehicles on circles of their own; vehicle 3 falls silent from second 40 to 60, vehicle 4 for good at 80.
std::vector<HeardState> all_states() {
  std::vector<HeardState> states;
  for (VehicleId id = 1; id <= kVehicles; ++id) {
    const double radius = 300.0 * id, rate = 3.0 / radius;
    for (int tick = 0; tick < static_cast<int>(kRunS + 30) * 5; ++tick) {
      const double t = tick * 0.2, angle = id + rate * t;
      if ((id == 3 && t > 40 && t < 60) || (id == 4 && t > 80)) continue;
      states.push_back({id,
                        {at_s(t),
                         {radius * std::cos(angle), radius * std::sin(angle), 40.0 + 5 * id},
                         {-3 * std::sin(angle), 3 * std::cos(angle), 0}}});
    }
  }
  return states;
}

std::vector<SendRequest> all_requests() {
  std::vector<SendRequest> requests;
  for (std::uint64_t i = 0; i < 600; ++i) {
    const auto source = static_cast<VehicleId>(1 + draw("source", 0, i) * kVehicles);
    auto request = testing::request_of(source, draw("start", 0, i) * kRunS, static_cast<std::int64_t>(i),
                                       static_cast<std::size_t>(draw("bytes", 0, i) * 70));
    request.destination_id = static_cast<VehicleId>(draw("to", 0, i) * (kVehicles + 1));
    requests.push_back(request);
  }
  return requests;
}

template <class Item>
void shuffle(std::vector<Item>& items, std::uint32_t turn) {
  for (std::size_t i = items.size(); i > 1; --i) {
    std::swap(items[i - 1],
              items[static_cast<std::size_t>(draw("shuffle", turn, i) * static_cast<double>(i))]);
  }
}

VehicleModem weak_modem() {
  VehicleModem modem = quick_modem();
  modem.modem.source_level = {115};  // some links fall below the cut-off
  return modem;
}

// Everything is heard before time runs, in an order that `turn` decides; time runs in steps of its own length.
std::vector<MediumEvent> run(std::uint32_t turn, double step_s) {
  Fleet fleet({for_s(0.05), for_s(5)}, {weak_modem(), {}});
  StraightPropagation propagation(testing::even_water());
  PacketMedium medium(fleet, propagation, {for_s(10), for_s(kRunS + 1)});
  auto states = all_states();
  auto requests = all_requests();
  if (turn > 0) shuffle(states, turn), shuffle(requests, turn);
  for (const auto& heard : states) fleet.hear_state(name_of(heard.id), heard.id, heard.state);
  for (const auto& request : requests) medium.transmit(request, SimTime());
  std::vector<MediumEvent> events;
  for (double t = 0; t < kRunS + 30; t += step_s) {
    for (auto& event : medium.advance_to(at_s(t))) events.push_back(std::move(event));
  }
  EXPECT_EQ(medium.packets_in_flight(), 0u);
  return events;
}

using Line = std::tuple<std::int64_t, int, int, std::int64_t, int, double, double>;
std::vector<Line> lines_of(const std::vector<MediumEvent>& events) {
  std::vector<Line> lines;
  for (const auto& event : events) {
    if (const auto* receipt = std::get_if<Receipt>(&event.what)) {
      lines.push_back({event.at.nanoseconds(), 0, static_cast<int>(receipt->result), receipt->packet_sequence,
                       0, receipt->duration.seconds(), 0});
    } else {
      const auto& end = std::get<PacketEnd>(event.what);
      lines.push_back({event.at.nanoseconds(), end.receiver_id, static_cast<int>(end.fate),
                       end.packet->request.packet_sequence, end.deliver, end.travel_time_s,
                       end.budget.received_level.value});
    }
  }
  return lines;
}

TEST(PacketMediumConservation, EveryAcceptedPacketEndsOnceAtEveryPossibleReceiver) {
  const auto events = run(0, 0.01);
  Fleet fleet({for_s(0.05), for_s(5)}, {weak_modem(), {}});
  for (const auto& heard : all_states()) fleet.hear_state(name_of(heard.id), heard.id, heard.state);

  std::map<std::int64_t, std::set<VehicleId>> expected, found;
  for (const auto& receipt : testing::receipts_in(events)) {
    if (receipt.result != SendResult::kAccepted) continue;
    for (const VehicleId id : fleet.present(receipt.start)) {
      if (name_of(id) != receipt.vehicle) expected[receipt.packet_sequence].insert(id);
    }
  }
  const auto ends = testing::ends_in(events);
  for (const auto& end : ends) {
    EXPECT_TRUE(found[end.packet->request.packet_sequence].insert(end.receiver_id).second) << "ended twice";
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(testing::receipts_in(events).size(), all_requests().size());
  // The run is worth something: every fate and most refusals occur.
  std::map<PacketFate, int> fates;
  for (const auto& end : ends) ++fates[end.fate];
  EXPECT_GT(fates[PacketFate::kReceived], 100);
  EXPECT_GT(fates[PacketFate::kBelowCutoff], 100);
  EXPECT_GT(fates[PacketFate::kReceiverGone], 0);
}

TEST(PacketMediumConservation, TheOrderOfArrivalChangesNothing) {
  const auto expected = lines_of(run(0, 0.05));
  for (std::uint32_t turn = 1; turn <= 3; ++turn) EXPECT_EQ(lines_of(run(turn, 0.05)), expected);
}

TEST(PacketMediumConservation, TheLengthOfTheStepsChangesNothing) {
  EXPECT_EQ(lines_of(run(0, 0.003)), lines_of(run(0, 7.0)));
}

TEST(PacketMediumConservation, EventsComeInTheOrderOfTheirInstants) {
  const auto events = run(0, 1.0);
  EXPECT_TRUE(std::is_sorted(events.begin(), events.end(),
                             [](const MediumEvent& a, const MediumEvent& b) { return a.at < b.at; }));
}

}  // namespace
}  // namespace halocline::channel_server

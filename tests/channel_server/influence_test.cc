// Change it and it moves: each physical input turned alone moves the numbers of link and packet that it should, in
// the right direction, by the right amount, and no other.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "acoustics/noise.h"
#include "bus/event_log.h"
#include "tests/channel_server/node_bench.h"

namespace halocline::channel_server {
namespace {

using testing::FlatBottom;
using testing::NodeBench;

constexpr double kAt = 3;  // s: table and packet
constexpr double kBottomM = 200;

struct World {
  acoustics::Environment water = testing::even_water();
  bool rays = false;
  RayModel model;
  VehicleModem modem = testing::quick_modem();
  Vec3 a{0, 0, 50}, b{800, 0, 50}, velocity_of_b = Vec3::Zero();  // at kAt
};

// Of the link from 1 to 2 and a packet of ten bytes that leaves at kAt.
using Numbers = std::map<std::string, double>;

Numbers numbers_of(const World& world) {
  bus::set_log_level(bus::LogLevel::kSilent);
  NodeBench bench({}, {world.modem, {}},
                  world.rays ? ray_model(world.water, world.model, {}) : straight_model(world.water));
  FlatBottom bottom(bench.lcm(), kBottomM);
  for (double t = 0; t <= 8; t += 0.25) {
    bench.state(1, t, world.a);
    bench.state(2, t, world.b + (t - kAt) * world.velocity_of_b, world.velocity_of_b);
  }
  bench.send(1, kAt, 0, 10);
  bench.run_to(kAt);
  const link_t row = bench.last_table(1).peers.at(0);
  bench.run_to(7);
  const packet_outcome_t& packet = bench.outcomes.at(0);
  return {{"delay", row.delay_s},
          {"loss", row.transmission_loss_db},
          {"level", row.received_level_db},
          {"noise", row.noise_level_db},
          {"snr", row.snr_db},
          {"capacity", row.capacity_bps},
          {"doppler", row.doppler_factor},
          {"spread", row.delay_spread_s},
          {"range", row.range_m},
          {"paths", row.num_paths},
          {"packet travel", packet.travel_time_s},
          {"packet duration", packet.duration_s},
          {"packet level", packet.received_level_db}};
}

struct Move {
  std::string number;
  double by;         // expected change; NaN: see `sign`
  double tolerance;  // on it
  int sign = 0;      // of the change, where its amount has no closed form
};
constexpr double kUp = 1, kDown = -1;
Move towards(const std::string& number, double sign) { return {number, NAN, 0, static_cast<int>(sign)}; }

struct Turn {
  std::string input;
  World before;
  std::function<void(World&)> turn;
  std::vector<Move> moves;  // all that may move
};

void PrintTo(const Turn& turn, std::ostream* out) { *out << turn.input; }

class Influence : public ::testing::TestWithParam<Turn> {};

TEST_P(Influence, MovesWhatItShouldAndNothingElse) {
  const Turn& turn = GetParam();
  World turned = turn.before;
  turn.turn(turned);
  const Numbers before = numbers_of(turn.before), after = numbers_of(turned);
  Numbers rest = before;
  for (const Move& move : turn.moves) {
    rest.erase(move.number);
    const double change = after.at(move.number) - before.at(move.number);
    if (std::isnan(move.by)) {
      EXPECT_GT(move.sign * change, 0) << move.number;
    } else {
      EXPECT_NEAR(change, move.by, move.tolerance) << move.number;
    }
  }
  for (const auto& [number, value] : rest) EXPECT_EQ(after.at(number), value) << number;
}

World with_rays() {
  World world;
  world.rays = true;
  return world;
}
World in_real_water() {
  World world;
  world.water = acoustics::Environment{};
  return world;
}
World uniform_water(double temperature_degc, double salinity_psu) {
  World world;
  world.water.profile = acoustics::SoundSpeedProfile::from_water(
      {{0, temperature_degc, salinity_psu}}, acoustics::SoundSpeedModel::kMackenzie1981, to_radians(45));
  world.water.absorption_model = acoustics::AbsorptionModel::kThorp1967;  // of frequency alone
  return world;
}
double noise_db(const acoustics::NoiseSources& sources) {
  return acoustics::noise_level_over_band(22'500, 27'500, sources).value;
}
double speed_in(const World& world) { return world.water.profile.sound_speed_mps(50); }
double delay_change(const World& before, const World& after) {
  return 800 / speed_in(after) - 800 / speed_in(before);
}

std::vector<Turn> turns() {
  std::vector<Turn> all;
  const double windy = noise_db({0.5, 10}) - noise_db({0.5, 0});
  all.push_back({"wind",
                 {},
                 [](World& w) { w.water.noise.wind_mps = 10; },
                 {{"noise", windy, 1e-9}, {"snr", -windy, 1e-9}, towards("capacity", kDown)}});
  const double busy = noise_db({1, 0}) - noise_db({0.5, 0});
  all.push_back({"shipping",
                 {},
                 [](World& w) { w.water.noise.shipping = 1; },
                 {{"noise", busy, 1e-9}, {"snr", -busy, 1e-9}, towards("capacity", kDown)}});
  all.push_back(
      {"source level",
       {},
       [](World& w) { w.modem.modem.source_level = {175}; },
       {{"level", -10, 1e-9}, {"packet level", -10, 1e-9}, {"snr", -10, 1e-9}, towards("capacity", kDown)}});
  const double warmer = delay_change(uniform_water(10, 35), uniform_water(20, 35));
  all.push_back({"temperature",
                 uniform_water(10, 35),
                 [](World& w) { w.water = uniform_water(20, 35).water; },
                 {{"delay", warmer, 1e-9}, {"packet travel", warmer, 1e-6}}});
  const double saltier = delay_change(uniform_water(10, 35), uniform_water(10, 39));
  all.push_back({"salinity",
                 uniform_water(10, 35),
                 [](World& w) { w.water = uniform_water(10, 39).water; },
                 {{"delay", saltier, 1e-9}, {"packet travel", saltier, 1e-6}}});
  all.push_back({"depth in real water",
                 in_real_water(),
                 [](World& w) { w.a.z() = w.b.z() = 150; },
                 {towards("delay", kUp), towards("packet travel", kUp),  // colder, so slower
                  // Colder, so magnesium sulfate relaxes nearer to 25 kHz and absorbs more.
                  towards("loss", kUp), towards("level", kDown), towards("packet level", kDown),
                  towards("snr", kDown), towards("capacity", kDown)}});
  all.push_back({"bandwidth",
                 {},
                 [](World& w) { w.modem.modem.bandwidth_hz = 2'500; },
                 {towards("noise", kDown), towards("snr", kUp), towards("capacity", kDown)}});
  all.push_back({"centre frequency",
                 {},
                 [](World& w) { w.modem.modem.centre_frequency_hz = 50'000; },
                 {towards("loss", kUp), towards("level", kDown), towards("packet level", kDown),
                  towards("noise", kDown), towards("snr", kDown), towards("capacity", kDown)}});
  const double spread_db = 0.5 * 10 * std::log10(800.0);
  all.push_back({"spreading",
                 {},
                 [](World& w) { w.water.spreading_exponent = 2; },
                 {{"loss", spread_db, 1e-9},
                  {"level", -spread_db, 1e-9},
                  {"packet level", -spread_db, 1e-9},
                  {"snr", -spread_db, 1e-9},
                  towards("capacity", kDown)}});
  all.push_back({"bit rate",
                 {},
                 [](World& w) { w.modem.modem.bit_rate_bps *= 2; },
                 {{"packet duration", -0.05, 1e-9}}});  // 80 bits at 800 and 1600 bit/s
  for (const double speed : {-2.0, 2.0}) {              // towards, away
    const double still_s = 800 / testing::kSpeedMps;
    const double meets_s = 800 / (testing::kSpeedMps - speed);
    all.push_back({speed < 0 ? "speed towards" : "speed away",
                   {},
                   [speed](World& w) {
                     w.velocity_of_b = {speed, 0, 0};
                   },
                   {{"doppler", -speed / testing::kSpeedMps, 1e-12},
                    {"packet travel", meets_s - still_s, 1e-6},
                    towards("packet level", -speed)}});
  }
  all.push_back({"speed across",
                 {},
                 [](World& w) {
                   w.velocity_of_b = {0, 2, 0};
                 },
                 {{"packet travel", 0, 1e-6}, {"packet level", 0, 1e-4}}});
  all.push_back(
      {"sediment",
       with_rays(),
       [](World& w) { w.model.bottom = *acoustics::sediment("Clay"); },
       {towards("loss", kUp), towards("level", kDown), towards("packet level", kDown), towards("snr", kDown),
        towards("capacity", kDown), towards("paths", kDown), towards("spread", kDown)}});
  all.push_back({"wind under rays: the surface takes more",
                 with_rays(),
                 [](World& w) { w.water.noise.wind_mps = 10; },
                 {towards("loss", kUp),
                  towards("level", kDown),
                  towards("packet level", kDown),
                  {"noise", windy, 1e-9},
                  towards("snr", kDown),
                  towards("capacity", kDown),
                  towards("paths", kDown),
                  towards("spread", kDown)}});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Inputs, Influence, ::testing::ValuesIn(turns()), [](const auto& turn) {
  std::string name;
  for (const char c : turn.param.input) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

}  // namespace
}  // namespace halocline::channel_server

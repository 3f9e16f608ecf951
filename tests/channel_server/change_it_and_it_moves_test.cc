// SPDX-License-Identifier: BSD-3-Clause
// Change it and it moves: each physical input turned alone moves the numbers of a link and of a packet that
// it should, in the right direction, by the right amount where there is a closed form, and leaves every other
// to the last bit.
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "acoustics/modem/beam_pattern.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/noise/place_noise.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/sim_time.h"
#include "tests/channel_server/change_it.h"

namespace halocline::channel_server {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)

// One input turned alone, in the water of `before`; `moves` holds all that may move.
struct Turn {
  std::string input;
  World before;
  std::function<void(World&)> turn;
  Moves moves;
};
void PrintTo(const Turn& turn, std::ostream* out) { *out << turn.input; }

class ChangeIt : public ::testing::TestWithParam<Turn> {};

TEST_P(ChangeIt, AndItMovesAndNothingElse) {
  const Turn& turn = GetParam();
  World turned = turn.before;
  turn.turn(turned);
  const Numbers before = numbers_of(turn.before), after = numbers_of(turned);
  Numbers rest = before;
  for (const Move& move : turn.moves) {
    int found = 0;
    for (const std::string& name : {move.output, "link " + move.output, "packet " + move.output}) {
      if (rest.erase(name) == 0) continue;
      SCOPED_TRACE(name);
      move.check(before.at(name), after.at(name));
      ++found;
    }
    EXPECT_GT(found, 0) << move.output << " is no output, or moves twice";
  }
  for (const auto& [name, value] : rest) EXPECT_EQ(after.at(name), value) << name;
}

acoustics::Environment uniform_water(double temperature_degc, double salinity_psu,
                                     acoustics::AbsorptionModel absorption) {
  acoustics::Environment water = testing::even_water();
  water.profile = acoustics::SoundSpeedProfile::from_water(
      {{0, temperature_degc, salinity_psu}}, acoustics::SoundSpeedModel::kMackenzie1981, to_radians(45));
  water.absorption_model = absorption;
  return water;
}

// Inputs that move the same numbers, whichever way sound goes.
void add_common(std::vector<Turn>& all, const World& world) {
  const auto add = [&](const std::string& input, std::function<void(World&)> turn, const Moves& moves) {
    all.push_back({(world.rays ? "rays: " : "line: ") + input, world, std::move(turn), moves});
  };
  add(
      "cut-off", [](World& w) { w.modem.modem.min_receivable_level = {120}; },
      undecided() +
          Moves{becomes("receivable", 0), becomes("cutoff", 120),
                becomes("outcome", packet_outcome_t::BELOW_CUTOFF)} +
          (world.rays ? Moves{becomes("interference", kSilence.value)} : Moves{}));
  add("error model", [](World& w) { w.modem.modem.error_model = acoustics::ErrorModel::kBpsk; },
      {rises("success")});
  // A loss of the receiver is noise; by rays late echoes remain as they are.
  add(
      "loss of the receiver", [](World& w) { w.modem.modem.receiver_loss = {0.1}; },
      Moves{world.rays ? falls("sinr") : moves_by("sinr", -0.1), falls("acquisition"), falls("success")});
  add("hydrophones", [](World& w) { w.modem.modem.receiver_channels = 2; },
      {moves_by("sinr", 10 * std::log10(2)), rises("acquisition"), rises("success")});
  add("Doppler tolerance of a pair at rest", [](World& w) { w.modem.modem.doppler_tolerance = 1e-9; }, {});
  const SimDuration preamble = for_s(preamble_s(world.rays));
  add(
      "preamble",
      [=](World& w) { w.modem.modem.preamble = w.modem.modem.packet_overhead = preamble + preamble; },
      Moves{moves_by("duration", preamble.seconds()), rises("acquisition")} +
          (world.rays ? Moves{changes("interference"), changes("sinr"), changes("success")} : Moves{}));
  // An approaching sender shortens its packet at the receiver, so that late echoes meet less of it.
  for (const double speed : {-kMoving, kMoving}) {
    const auto nearing = [=](const std::string& output) { return speed > 0 ? rises(output) : falls(output); };
    const auto parting = [=](const std::string& output) { return speed > 0 ? falls(output) : rises(output); };
    const Moves echoes{parting("interference"), nearing("sinr"), nearing("success")};
    add(
        speed > 0 ? "transmitter towards" : "transmitter away",
        [=](World& w) { w.velocity_of_a = Vec3(speed, 0, 0); },
        Moves{moves_by("doppler", kSpeedMps / (kSpeedMps - speed) - 1, 1e-12)} +
            (world.rays ? echoes : Moves{}));
  }
}

void add_water_of_the_line(std::vector<Turn>& all) {
  const auto add = [&](const std::string& input, const World& before, std::function<void(World&)> turn,
                       const Moves& moves) {
    all.push_back({"line: " + input, before, std::move(turn), moves});
  };
  add(
      "wind", World(), [](World& w) { w.water.noise.wind_mps = 10; },
      Moves{moves_by("noise", kWindyDb)} + ratio_by(-kWindyDb) + not_acquired());
  add(
      "shipping", World(), [](World& w) { w.water.noise.shipping = 1; },
      Moves{moves_by("noise", kBusyDb)} + ratio_by(-kBusyDb) + dimmer());
  acoustics::NoiseSources harbour = World().water.noise;
  harbour.place = acoustics::NoisePlace::kHarbour;
  const double harbour_db = noise_db(harbour) - noise_db(World().water.noise);
  add(
      "noise of the place", World(), [=](World& w) { w.water.noise.place = harbour.place; },
      Moves{moves_by("noise", harbour_db)} + ratio_by(-harbour_db) + not_acquired());
  acoustics::Environment turbid = World().water;
  turbid.load = {.particles_kg_m3 = 0.01};
  add(
      "load of the water", World(), [=](World& w) { w.water.load = turbid.load; },
      loss_by(absorbed_db(turbid) - absorbed_db(World().water)) + dimmer());
  // Thorp's absorption knows neither temperature nor salinity; Francois and Garrison's knows both.
  using Absorption = acoustics::AbsorptionModel;
  for (const auto& [input, temperature, salinity] :
       {std::tuple("temperature", 20, 35), std::tuple("salinity", 10, 39)}) {
    const auto cool = uniform_water(10, 35, Absorption::kThorp1967);
    const auto other = uniform_water(temperature, salinity, Absorption::kThorp1967);
    add(
        input, in_water(World(), cool), [=](World& w) { w.water = other; },
        delay_by(delay_s(other) - delay_s(cool)));
    const auto cool_fg = uniform_water(10, 35, Absorption::kFrancoisGarrison1982);
    const auto other_fg = uniform_water(temperature, salinity, Absorption::kFrancoisGarrison1982);
    const double more_db = absorbed_db(other_fg) - absorbed_db(cool_fg);
    add(
        input + std::string(" that absorbs"), in_water(World(), cool_fg),
        [=](World& w) { w.water = other_fg; },
        delay_by(delay_s(other_fg) - delay_s(cool_fg)) + loss_by(more_db) +
            (more_db < 0 ? clearer() : dimmer()));
  }
  const auto alkaline = uniform_water(10, 35, Absorption::kFrancoisGarrison1982);
  auto acid = alkaline;
  acid.ph = 7.7;  // less borate, which absorbs
  add(
      "acidity", in_water(World(), alkaline), [=](World& w) { w.water = acid; },
      loss_by(absorbed_db(acid) - absorbed_db(alkaline)) + clearer());
  add(
      "spreading", World(), [](World& w) { w.water.spreading_exponent = 2; },
      loss_by(5 * std::log10(kRangeM)) + not_acquired());
  // The sea rises by 1 m: the ends are 1 m deeper.
  const acoustics::Environment real;
  add(
      "sea surface", in_water(World(), real), [](World& w) { w.water.sea_surface_z_m = -1; },
      delay_by(delay_s(real, 51) - delay_s(real)) + loss_by(absorbed_db(real, 51) - absorbed_db(real)) +
          dimmer());
  add("sediment", World(), [](World& w) { w.model.bottom = *acoustics::sediment("Clay"); }, {});
  add("bottom depth", World(), [](World& w) { w.bottom_z_m = 150; }, {});
}

void add_ends_of_the_line(std::vector<Turn>& all) {
  const auto add = [&](const std::string& input, std::function<void(World&)> turn, const Moves& moves) {
    all.push_back({"line: " + input, World(), std::move(turn), moves});
  };
  const double slant_m = std::hypot(kRangeM, 100);
  add(
      "depth of the transmitter", [](World& w) { w.a.z() = 150; },
      delay_by((slant_m - kRangeM) / kSpeedMps) + dimmer() +
          Moves{moves_by("range", slant_m - kRangeM), rises("loss"), falls("level"), falls("snr"),
                falls("sinr"), moves_by("elevation", -std::atan2(100, kRangeM))});
  // The receiver is met where it is by then.
  for (const double speed : {-kMoving, kMoving}) {
    const double travel_s = kRangeM / (kSpeedMps - speed);
    const auto away = [=](const std::string& output) { return speed > 0 ? rises(output) : falls(output); };
    const auto nearer = [=](const std::string& output) { return speed > 0 ? falls(output) : rises(output); };
    add(speed < 0 ? "receiver towards" : "receiver away",
        [=](World& w) {
          w.velocity_of_b = {speed, 0, 0};
        },
        {moves_by("doppler", -speed / kSpeedMps, 1e-12),
         moves_by("packet delay", travel_s - kRangeM / kSpeedMps, 3e-9),
         moves_by("packet range", speed * travel_s, 3e-9), away("packet loss"), nearer("packet level"),
         nearer("packet snr"), nearer("sinr"), nearer("acquisition"), nearer("success")});
  }
}

void add_modems_of_the_line(std::vector<Turn>& all) {
  const auto add = [&](const std::string& input, std::function<void(World&)> turn, const Moves& moves) {
    all.push_back({"line: " + input, World(), std::move(turn), moves});
  };
  const acoustics::Environment water = testing::even_water();
  const double narrower_db = noise_db({0.5, 0}, 23'750, 26'250) - noise_db({0.5, 0});
  // The same power over half of the noise; the ratio of their densities at the centre is a little better.
  add(
      "bandwidth", [](World& w) { w.modem.modem.bandwidth_hz = 2'500; },
      Moves{moves_by("noise", narrower_db), falls("capacity"), rises("acquisition"), rises("success")} +
          ratio_by(-narrower_db));
  const double higher_db = noise_db({0.5, 0}, 47'500, 52'500) - noise_db({0.5, 0});
  const double more_db = absorbed_db(water, 50, 50) - absorbed_db(water);
  add(
      "centre frequency", [](World& w) { w.modem.modem.centre_frequency_hz = 50'000; },
      Moves{moves_by("noise", higher_db), moves_by("loss", more_db), moves_by("level", -more_db)} +
          ratio_by(-more_db - higher_db) + not_acquired());
  add(
      "source level", [](World& w) { w.modem.modem.source_level.value += kDoubleDb; },
      Moves{moves_by("level", kDoubleDb)} + ratio_by(kDoubleDb) + clearer());
  add(
      "directivity", [](World& w) { w.modem.modem.directivity_index = {kDoubleDb}; },
      ratio_by(kDoubleDb) + clearer());
  add(
      "beams",
      [](World& w) {
        w.modem.modem.beam = acoustics::BeamPattern({{0, kDoubleDb / 2}});
      },
      loss_by(kDoubleDb) + not_acquired());
  add("guard time", [](World& w) { w.modem.modem.guard_time = for_s(0.1); }, {});
  add("bit rate", [](World& w) { w.modem.modem.bit_rate_bps *= 2; },
      {moves_by("duration", -8 * kBytes / bit_rate_bps(false) / 2), falls("success"),
       becomes("outcome", packet_outcome_t::BIT_ERRORS)});
  add("packet length", [](World& w) { w.bytes = 2 * kBytes; },
      {moves_by("duration", 8 * kBytes / bit_rate_bps(false)),
       {"success", [](double once, double twice) { EXPECT_NEAR(twice, once * once, 1e-12); }},
       becomes("outcome", packet_outcome_t::BIT_ERRORS)});
  all.push_back({"line: Doppler tolerance of a receiver under way",
                 with_receiver_at(World(), {kMoving, 0, 0}),
                 [](World& w) { w.modem.modem.doppler_tolerance = 0.001; },
                 undecided() + Moves{becomes("outcome", packet_outcome_t::DOPPLER)}});
}

// By rays: the level is a sum over paths, and late echoes disturb.
Moves all_levels(const std::function<Move(const std::string&)>& with_loss,
                 const std::function<Move(const std::string&)>& with_level) {
  return {with_loss("loss"), with_level("level"), with_level("snr"), with_level("capacity")};
}

void add_water_of_rays(std::vector<Turn>& all) {
  const auto add = [&](const std::string& input, const World& before, std::function<void(World&)> turn,
                       const Moves& moves) {
    all.push_back({"rays: " + input, before, std::move(turn), moves});
  };
  const World world(true);
  // Bubbles take the paths off the surface, among them late echoes.
  add(
      "wind", world, [](World& w) { w.water.noise.wind_mps = 10; },
      Moves{moves_by("noise", kWindyDb), falls("paths"), falls("spread"), falls("interference"),
            falls("sinr"), falls("acquisition"), falls("success"),
            becomes("outcome", packet_outcome_t::NOT_ACQUIRED)} +
          all_levels(rises, falls));
  add(
      "shipping", world, [](World& w) { w.water.noise.shipping = 1; },
      Moves{moves_by("noise", kBusyDb), moves_by("snr", -kBusyDb), falls("sinr")} + dimmer());
  // Pressure bends the direct path: its delay is less than the line's by (g r / c)^2 / 24, 3e-6 of it; g is
  // the gradient, 0.016 1/s.
  const auto cool = uniform_water(10, 35, acoustics::AbsorptionModel::kThorp1967);
  for (const auto& [input, temperature, salinity] :
       {std::tuple("temperature", 20, 35), std::tuple("salinity", 10, 39)}) {
    const auto other = uniform_water(temperature, salinity, acoustics::AbsorptionModel::kThorp1967);
    const double sooner_s = delay_s(other) - delay_s(cool);
    add(
        input, in_water(world, cool), [=](World& w) { w.water = other; },
        Moves{moves_by("delay", sooner_s, 2e-7), falls("spread"), changes("elevation"),
              changes("interference"), changes("sinr"), changes("acquisition"), changes("success")} +
            all_levels(changes, changes));
  }
  add("spreading", world, [](World& w) { w.water.spreading_exponent = 2; }, {});
  add(
      "sea surface", world, [](World& w) { w.water.sea_surface_z_m = -1; },
      Moves{changes("spread"), changes("interference"), changes("sinr"), changes("acquisition"),
            changes("success")} +
          all_levels(changes, changes));
  add(
      "sediment", world, [](World& w) { w.model.bottom = *acoustics::sediment("Clay"); },
      Moves{falls("paths"), falls("spread"), falls("interference"), rises("sinr"), rises("success")} +
          all_levels(rises, falls));
  add(
      "bottom depth", world, [](World& w) { w.bottom_z_m = 150; },
      Moves{changes("spread"), rises("interference"), falls("sinr"), falls("success"),
            becomes("outcome", packet_outcome_t::BIT_ERRORS)} +
          all_levels(falls, rises));
}

void add_ends_of_rays(std::vector<Turn>& all) {
  const auto add = [&](const std::string& input, std::function<void(World&)> turn, const Moves& moves) {
    all.push_back({"rays: " + input, World(true), std::move(turn), moves});
  };
  const double slant_m = std::hypot(kRangeM, 100);
  add(
      "depth of the transmitter", [](World& w) { w.a.z() = 150; },
      delay_by((slant_m - kRangeM) / kSpeedMps) +
          Moves{moves_by("range", slant_m - kRangeM), moves_by("elevation", -std::atan2(100, kRangeM)),
                changes("spread"), changes("interference"), changes("sinr"), falls("acquisition"),
                becomes("success", 0), becomes("outcome", packet_outcome_t::NOT_ACQUIRED)} +
          all_levels(changes, changes));
  for (const double speed : {-kMoving, kMoving}) {
    const double travel_s = kRangeM / (kSpeedMps - speed);
    add(speed < 0 ? "receiver towards" : "receiver away",
        [=](World& w) {
          w.velocity_of_b = {speed, 0, 0};
        },
        {moves_by("doppler", -speed / kSpeedMps, 1e-12),
         moves_by("packet delay", travel_s - kRangeM / kSpeedMps, 3e-9),
         moves_by("packet range", speed * travel_s, 3e-9), changes("packet spread"), changes("packet loss"),
         changes("packet level"), changes("packet snr"), changes("interference"), changes("sinr"),
         changes("acquisition"), changes("success")});
  }
}

void add_modems_of_rays(std::vector<Turn>& all) {
  const auto add = [&](const std::string& input, std::function<void(World&)> turn, const Moves& moves) {
    all.push_back({"rays: " + input, World(true), std::move(turn), moves});
  };
  const double narrower_db = noise_db({0.5, 0}, 23'750, 26'250) - noise_db({0.5, 0});
  add("bandwidth", [](World& w) { w.modem.modem.bandwidth_hz = 2'500; },
      {moves_by("noise", narrower_db), moves_by("snr", -narrower_db), falls("capacity"), rises("sinr"),
       changes("acquisition"), falls("success"), becomes("outcome", packet_outcome_t::BIT_ERRORS)});
  const double higher_db = noise_db({0.5, 0}, 47'500, 52'500) - noise_db({0.5, 0});
  add(
      "centre frequency", [](World& w) { w.modem.modem.centre_frequency_hz = 50'000; },
      Moves{moves_by("noise", higher_db), falls("spread"), falls("interference"), falls("sinr"),
            falls("acquisition"), falls("success"), becomes("outcome", packet_outcome_t::NOT_ACQUIRED)} +
          all_levels(rises, falls));
  add(
      "source level", [](World& w) { w.modem.modem.source_level.value += kDoubleDb; },
      Moves{moves_by("level", kDoubleDb), moves_by("snr", kDoubleDb), moves_by("interference", kDoubleDb),
            rises("sinr")} +
          clearer());
  add(
      "directivity", [](World& w) { w.modem.modem.directivity_index = {kDoubleDb}; },
      Moves{moves_by("snr", kDoubleDb), rises("sinr")} + clearer());
  add(
      "beams",
      [](World& w) {
        w.modem.modem.beam = acoustics::BeamPattern({{0, kDoubleDb / 2}});
      },
      Moves{moves_by("loss", kDoubleDb), moves_by("level", -kDoubleDb), moves_by("snr", -kDoubleDb),
            moves_by("interference", -kDoubleDb), falls("sinr")} +
          not_acquired());
  add("guard time", [](World& w) { w.modem.modem.guard_time = for_s(0.1); },
      {falls("interference"), rises("sinr"), rises("acquisition"), rises("success")});
  add("share of late echoes", [](World& w) { w.modem.modem.late_echo_share = 0.5; },
      {falls("interference"), rises("sinr"), rises("success")});
  add("late echoes cancelled", [](World& w) { w.modem.modem.echo_cancelled = 0.5; },
      {falls("interference"), rises("sinr"), rises("success")});
  // An echo that comes late by a fixed time is missing from more of a shorter packet.
  add("bit rate", [](World& w) { w.modem.modem.bit_rate_bps *= 2; },
      {moves_by("duration", -8 * kBytes / bit_rate_bps(true) / 2), falls("interference"), rises("sinr"),
       falls("success"), becomes("outcome", packet_outcome_t::BIT_ERRORS)});
  add("packet length", [](World& w) { w.bytes = 2 * kBytes; },
      {moves_by("duration", 8 * kBytes / bit_rate_bps(true)), rises("interference"), falls("sinr"),
       falls("success"), becomes("outcome", packet_outcome_t::BIT_ERRORS)});
}

std::vector<Turn> turns() {
  std::vector<Turn> all;
  add_common(all, World(false));
  add_common(all, World(true));
  for (const auto add : {add_water_of_the_line, add_ends_of_the_line, add_modems_of_the_line,
                         add_water_of_rays, add_ends_of_rays, add_modems_of_rays}) {
    add(all);
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Inputs, ChangeIt, ::testing::ValuesIn(turns()), [](const auto& turn) {
  std::string name;
  for (const char c : turn.param.input) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

}  // namespace
}  // namespace halocline::channel_server

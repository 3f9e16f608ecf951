// SPDX-License-Identifier: BSD-3-Clause
// Waveforms through whole scenarios, against the link's own numbers.
#include "simulation/waveform/received_waveform.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/link/link_budget.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/environment.h"
#include "acoustics/waveform/analytic_signal.h"
#include "bus/transport/event_log.h"
#include "channel_server/propagation/propagation.h"
#include "channel_server/water_model.h"
#include "core/check.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "simulation/composition.h"
#include "simulation/link_survey.h"
#include "simulation/vehicle_track.h"
#include "simulation/waveform/wav_file.h"
#include "tests/support/channel_file.h"

namespace halocline::clients {
namespace {

using acoustics::Samples;
using std::numbers::pi;
constexpr double kRate = 96'000, kTone = 25'000;

class WaveformTest : public ::testing::Test {
 protected:
  WaveformTest() { bus::set_log_level(bus::LogLevel::kSilent); }
  static ScenarioConfig load(const std::string& file, const std::vector<std::string>& overrides) {
    return load_scenario(std::string(HALOCLINE_SOURCE_DIR) + "/" + file, overrides);
  }
  static SentWaveform tone_from(const std::string& vehicle, double begin_s, double seconds,
                                double frequency_hz = kTone) {
    SentWaveform sent{vehicle, {begin_s, kRate, {}}, Decibels{185}};
    for (int n = 0; n < seconds * kRate; ++n)
      sent.sound.values.push_back(std::sin(2 * pi * frequency_hz * n / kRate));
    return sent;
  }
  // The tone of one frequency in `samples` from `begin` on: amplitude and phase.
  static std::complex<double> line(const Samples& samples, double begin_s, double seconds,
                                   double frequency_hz) {
    std::complex<double> sum = 0;
    const auto first = static_cast<std::size_t>((begin_s - samples.begin_s) * kRate);
    const auto count = static_cast<std::size_t>(seconds * kRate);
    for (std::size_t n = first; n < first + count; ++n)
      sum += samples.values.at(n) *
             std::polar(1.0, -2 * pi * frequency_hz * (samples.begin_s + static_cast<double>(n) / kRate));
    return 2.0 / static_cast<double>(count) * sum;
  }
  static double level_db(double amplitude) { return 20 * std::log10(amplitude / std::numbers::sqrt2); }
};

// A straight way, both ends under way. Received frequency over sent: (c - v_to) / (c - v_from) along the way;
// the phase of a tone at the sent frequency turns by the difference.
TEST_F(WaveformTest, AToneOfAMovingLinkHasItsLevelAndItsDopplerShift) {
  const ScenarioConfig config = load("tests/data/scenarios/two_vehicles.toml",
                                     {"propagation.model=\"straight\"", "scenario.duration_s=20"});
  const Recording run = record_run(config, make_terrain(config), SimTime::from_seconds(14));
  const VehicleTrack from(run, "alpha"), to(run, "bravo");
  const Samples heard =
      received_waveform(config, make_terrain(config), run, {tone_from("alpha", 10, 1)},
                        {.receiver = "bravo", .begin_s = 10, .sensitivity = Decibels{0}, .has_noise = false});
  const auto there = to.at(SimTime::from_seconds(10.7)), here = from.at(SimTime::from_seconds(10.5));
  LinkSurveyEnd sender = link_end(config, "alpha"), receiver = link_end(config, "bravo");
  sender.position_ned_m = here.position_ned_m;
  receiver.position_ned_m = there.position_ned_m;
  const acoustics::LinkBudget link = survey_link(config, sender, receiver).reception.budget;
  const Vec3 way = (there.position_ned_m - here.position_ned_m).normalized();
  const double c = link.mean_sound_speed_mps;
  const double doppler = (c - there.velocity_ned_mps.dot(way)) / (c - here.velocity_ned_mps.dot(way));
  ASSERT_GT(std::abs(doppler - 1), 3e-4);
  // Halves of half a second about the middle.
  const auto first = line(heard, 10.45, 0.25, kTone * doppler),
             second = line(heard, 10.7, 0.25, kTone * doppler);
  EXPECT_NEAR(level_db(std::abs(first)), link.received_level.value, 0.05);
  EXPECT_LT(std::abs(std::arg(second / first)) / (2 * pi * 0.25) / kTone,
            2e-6);  // of the frequency; speeds change by 1 mm/s
}

// A sweep between moored ends in even water over a flat bottom: where the echoes of the matched filter stand.
TEST_F(WaveformTest, EchoesOfASweepStandAtTheArrivalsOfTheLink) {
  const ScenarioConfig config =
      load("scenarios/ranging.toml",
           {"propagation.fading=\"none\"", "terrain.kind=\"flat\"", "terrain.flat.depth_m=120"});
  SentWaveform sweep{"west", {5, kRate, {}}, Decibels{185}};
  constexpr double kSeconds = 0.1, kLow = 20'000, kHigh = 30'000;
  for (int n = 0; n < kSeconds * kRate; ++n) {
    const double t = n / kRate;
    sweep.sound.values.push_back(std::sin(2 * pi * (kLow + (kHigh - kLow) / kSeconds / 2 * t) * t));
  }
  const Recording run = record_run(config, make_terrain(config), SimTime::from_seconds(8));
  const Samples heard = received_waveform(config, make_terrain(config), run, {sweep},
                                          {.receiver = "east", .begin_s = 5, .has_noise = false});
  const LinkSurvey link = survey_link(config, link_end(config, "west"), link_end(config, "east"));
  std::vector<channel_server::Arrival> paths = link.reception.paths;
  ASSERT_GT(paths.size(), 4u);
  std::sort(paths.begin(), paths.end(), [](const auto& a, const auto& b) { return a.level > b.level; });
  // Correlated with the sweep and its Hilbert transform, at the delay of each of the strongest that is apart
  // from the others by five times the resolution, whose sidelobes are 25 dB down there: 0.5 dB.
  const acoustics::AnalyticSignal replica(kRate, sweep.sound.values);
  const auto match = [&](double delay_s) {
    std::complex<double> sum = 0;
    for (std::size_t n = 0; n < sweep.sound.values.size(); ++n) {
      const auto at = static_cast<std::size_t>(std::llround(delay_s * kRate)) + n;
      const double offset_s = static_cast<double>(at) / kRate - delay_s;
      sum += heard.values.at(at) * std::conj(replica.at(offset_s));
    }
    return std::abs(sum) * 2 / static_cast<double>(sweep.sound.values.size());
  };
  int compared = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(paths.size(), 10); ++i) {
    const bool apart = std::all_of(paths.begin(), paths.end(), [&](const auto& other) {
      return &other == &paths[i] || std::abs(other.delay_s - paths[i].delay_s) > 5e-4 ||
             other.level < paths[i].level - Decibels{25};
    });
    if (!apart) continue;
    ++compared;
    const double pressure = match(paths[i].delay_s) / std::pow(10, -190 / 20.0);
    EXPECT_NEAR(level_db(pressure),
                paths[i].level.value - link_end(config, "west").modem.modem.source_level.value + 185, 0.5)
        << i;
    for (const double off_s : {-2e-5, 2e-5})
      EXPECT_LT(match(paths[i].delay_s + off_s), match(paths[i].delay_s)) << i;
  }
  EXPECT_GE(compared, 3);
}

TEST_F(WaveformTest, SendersAddUp) {
  const ScenarioConfig config =
      load("scenarios/ranging.toml", {"propagation.model=\"straight\"", "propagation.fading=\"none\""});
  const Recording run = record_run(config, make_terrain(config), SimTime::from_seconds(4));
  const WaveformRules rules{.receiver = "auv-1", .begin_s = 1, .tail_s = 1, .has_noise = false};
  const SentWaveform west = tone_from("west", 1, 0.2), east = tone_from("east", 1.3, 0.2, 22'000);
  const Samples both = received_waveform(config, make_terrain(config), run, {west, east}, rules);
  const Samples first = received_waveform(config, make_terrain(config), run, {west}, rules),
                second = received_waveform(config, make_terrain(config), run, {east}, rules);
  for (std::size_t n = 0; n < first.values.size(); ++n)
    ASSERT_NEAR(both.values[n], first.values[n] + (n < second.values.size() ? second.values[n] : 0), 1e-15)
        << n;
}

// 10 log10 of the power that absorption takes: alpha times the range. Half way between the ends
// represents the depths between them.
TEST_F(WaveformTest, AbsorptionTakesMoreOfAHigherFrequency) {
  const ScenarioConfig config =
      load("scenarios/ranging.toml", {"propagation.model=\"straight\"", "propagation.fading=\"none\""});
  const Recording run = record_run(config, make_terrain(config), SimTime::from_seconds(4));
  const auto heard_db = [&](double frequency_hz) {
    const Samples heard =
        received_waveform(config, make_terrain(config), run, {tone_from("west", 1, 0.3, frequency_hz)},
                          {.receiver = "east", .begin_s = 1, .sensitivity = Decibels{0}, .has_noise = false});
    return level_db(std::abs(line(
        heard, heard.begin_s + static_cast<double>(heard.values.size()) / kRate - 0.7, 0.1, frequency_hz)));
  };
  const double range_m =
      survey_link(config, link_end(config, "west"), link_end(config, "east")).reception.budget.range_m;
  const auto water = channel_server::make_water_model(config.channel_server, config.scenario);
  const double depth_m =
      (link_end(config, "west").position_ned_m.z() + link_end(config, "east").position_ned_m.z()) / 2;
  const auto alpha = acoustics::absorption_spectrum_at(water.propagation->environment(SimTime()), depth_m);
  const double expected_db =
      (alpha.components_at(20'000).total_db_per_km - alpha.components_at(30'000).total_db_per_km) * range_m /
      1000;
  ASSERT_LT(expected_db, -1);
  EXPECT_NEAR(heard_db(30'000) - heard_db(20'000), expected_db, 0.1);
}

// Nothing is sent: what is left is the noise of the sea, in its band as a table of links states it.
TEST_F(WaveformTest, NoiseHasTheLevelThatLinksState) {
  const ScenarioConfig config =
      load("scenarios/ranging.toml", {"propagation.model=\"straight\"", "propagation.fading=\"none\""});
  const Recording run = record_run(config, make_terrain(config), SimTime::from_seconds(4));
  SentWaveform silence{"west", {0, kRate, std::vector<double>(96'000, 0.0)}, Decibels{185}};
  const Samples heard = received_waveform(config, make_terrain(config), run, {silence},
                                          {.receiver = "auv-1", .sensitivity = Decibels{0}});
  // 5 kHz about 25 kHz in lines of 100 Hz over spectra of 10 ms: 100 spectra of 50 lines, 1.4 %.
  double power = 0;
  for (int s = 0; s < 100; ++s) {
    for (double f = 22'500; f < 27'500; f += 100)
      power += std::norm(line(heard, 0.01 * s, 0.01, f)) / 2 / 100;
  }
  const LinkSurvey link = survey_link(config, link_end(config, "west"), link_end(config, "auv-1"));
  EXPECT_NEAR(10 * std::log10(power), link.reception.budget.noise_level.value, 4 * 0.062);
  EXPECT_EQ(heard.values, received_waveform(config, make_terrain(config), run, {silence},
                                            {.receiver = "auv-1", .sensitivity = Decibels{0}})
                              .values);
}

// A vehicle 1 km away makes 140 dB re 1 uPa^2/Hz at 1 m at 25 kHz: less the loss of the link, or at its own
// hydrophone less 20 dB. The sea is more than 30 dB below that. 5 kHz in 100 spectra of 50 lines: 0.062 dB is
// a standard deviation.
TEST_F(WaveformTest, VehiclesAreHeardByTheirNoise) {
  const std::string path = ::testing::TempDir() + "halocline-noise-" + std::to_string(getpid()) + ".toml";
  std::ofstream(path) << R"([scenario]
duration_s = 10
[terrain]
kind = "flat"
[terrain.flat]
depth_m = 200.0
[environment]
profile = "isovelocity"
[propagation]
model = "straight"
fading = "none"
[[vehicle]]
name = "loud"
id = 1
model = "fixed"
start_ned_m = [0.0, 0.0, 50.0]
[vehicle.noise]
frequency_khz = [25.0]
level_db = [140.0]
varies_with = "nothing"
own_loss_db = 20.0
[[vehicle]]
name = "quiet"
id = 2
model = "fixed"
start_ned_m = [1000.0, 0.0, 50.0]
)";
  const ScenarioConfig config = load_scenario(path, {});
  std::filesystem::remove(path);
  const Recording run = record_run(config, make_terrain(config), SimTime::from_seconds(5));
  const auto heard_db = [&](const std::string& from, const std::string& by) {
    const SentWaveform silence{from, {1, kRate, std::vector<double>(96'000, 0.0)}, Decibels{185}};
    const Samples heard = received_waveform(config, make_terrain(config), run, {silence},
                                            {.receiver = by, .begin_s = 1, .sensitivity = Decibels{0}});
    double power = 0;
    for (int s = 0; s < 100; ++s) {
      for (double f = 22'500; f < 27'500; f += 100)
        power += std::norm(line(heard, 1 + 0.01 * s, 0.01, f)) / 2 / 100;
    }
    return 10 * std::log10(power);
  };
  const double band_db = 10 * std::log10(5000.0);
  const auto link = survey_link(config, link_end(config, "loud"), link_end(config, "quiet"));
  EXPECT_NEAR(heard_db("loud", "quiet"), 140 + band_db - link.reception.budget.transmission_loss.value, 0.3);
  EXPECT_NEAR(heard_db("quiet", "loud"), 140 + band_db - 20, 0.25);
}

// h is pressure at the receiver over that at 1 m: 0.01 for half a second, then 0.02, with a tenth of a second
// between.
TEST_F(WaveformTest, AMeasuredChannelTakesThePlaceOfThePaths) {
  auto file = halocline::testing::channel_file(10, 1, 1);
  for (std::size_t i = 0; i < 10; ++i) file.at(i, 0, 0) = i < 5 ? 0.01 : 0.02;
  const std::string path = halocline::testing::write_channel_file(file, "waveform.mat");
  const ScenarioConfig config =
      load("scenarios/ranging.toml",
           {"propagation.model=\"straight\"", "propagation.large_scale_fading_db=0",
            "propagation.slow_fading_db=0", "propagation.tidal_fading_db=0", "propagation.daily_fading_db=0",
            "propagation.replay=\"" + path + "\"", "propagation.replay_level=\"file\""});
  const Recording run = record_run(config, make_terrain(config), SimTime::from_seconds(4));
  const Samples heard =
      received_waveform(config, make_terrain(config), run, {tone_from("west", 1, 2)},
                        {.receiver = "east", .begin_s = 1, .sensitivity = Decibels{0}, .has_noise = false});
  const double end_s = heard.begin_s + static_cast<double>(heard.values.size()) / kRate - 0.5;
  double least_db = 300, most_db = 0;
  for (double t_s = end_s - 1.9; t_s < end_s - 0.1; t_s += 0.05) {
    const double at_db = level_db(std::abs(line(heard, t_s, 0.02, kTone)));
    least_db = std::min(least_db, at_db);
    most_db = std::max(most_db, at_db);
  }
  EXPECT_NEAR(least_db, 185 - 40, 0.05);
  EXPECT_NEAR(most_db, 185 - 40 + 20 * std::log10(2.0), 0.05);
}

TEST_F(WaveformTest, RefusesSendersThatCannotBe) {
  const ScenarioConfig config = load("scenarios/ranging.toml", {});
  const Recording run = record_run(config, make_terrain(config), SimTime::from_seconds(1));
  const SentWaveform sent = tone_from("west", 0, 0.01);
  EXPECT_THROW(received_waveform(config, make_terrain(config), run, {}, {.receiver = "east"}),
               InvalidArgument);
  EXPECT_THROW(received_waveform(config, make_terrain(config), run, {sent}, {.receiver = "west"}),
               InvalidArgument);
  EXPECT_THROW(received_waveform(config, make_terrain(config), run, {sent}, {.receiver = "nobody"}),
               InvalidArgument);
  SentWaveform other = sent;
  other.vehicle = "auv-1";
  other.sound.rate_hz = 48'000;
  EXPECT_THROW(received_waveform(config, make_terrain(config), run, {sent, other}, {.receiver = "east"}),
               InvalidArgument);
}

TEST(WavFile, IsReadAsItWasWritten) {
  const std::string path = ::testing::TempDir() + "halocline-" + std::to_string(getpid()) + ".wav";
  const Samples sound{0, 48'000, {0.5, -0.25, 1.5}};
  write_wav(path, sound);
  const Samples read = read_sound(path);
  EXPECT_EQ(read.rate_hz, sound.rate_hz);
  EXPECT_EQ(read.values, sound.values);
  std::ofstream(path) << "no sound";
  EXPECT_THROW(read_sound(path), InvalidArgument);
  EXPECT_THROW(read_sound(path + ".missing"), InvalidArgument);
  EXPECT_THROW(write_wav("/nowhere/x.wav", sound), InvalidArgument);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace halocline::clients

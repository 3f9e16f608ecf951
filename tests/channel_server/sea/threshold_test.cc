// SPDX-License-Identifier: BSD-3-Clause
// A link at rest near its threshold: how wide the transition is, and how losses hang together in time.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "channel_server/modems/modem_config.h"
#include "tests/channel_server/sea/still_link.h"
#include "tests/support/doc_table.h"

namespace halocline::channel_server {
namespace {

using acoustics::Arrival;
using testing::StillLink;

constexpr acoustics::FadingModel kSea{.enabled = true};

// A direct path and one off the surface, in a breeze.
Reception reception() {
  Arrival direct{{.delay_s = 0.5, .identity = {.branch = 1}}, {100}};
  direct.fading = path_fading(kSea, 5, 25'000, 0, 0);
  Arrival surface{{.delay_s = 0.5012, .phase_rad = 3.14159, .surface_bounces = 1, .identity = {.branch = 2}},
                  {97}};
  surface.fading = path_fading(kSea, 5, 25'000, 0.01, 0);
  Reception reception;
  reception.paths = {direct, surface};
  return reception;
}

// Mean over 120 places of the sea, each at times as far apart as its large-scale fading.
double mean_delivery(const acoustics::Modem& modem, double noise_db) {
  double sum = 0;
  const int links = 120, times = 10;
  for (std::uint32_t pair = 0; pair < links; ++pair) {
    const StillLink link(reception(), modem, 32, kSea, pair, {noise_db});
    for (int i = 0; i < times; ++i) sum += link.delivery(100 + 300.0 * i);
  }
  return sum / (links * times);
}

// The noise, dB, at which the mean delivery is `target`.
double noise_for(const acoustics::Modem& modem, double target) {
  double low = 80, high = 140;
  for (int i = 0; i < 12; ++i) {
    const double middle = (low + high) / 2;
    (mean_delivery(modem, middle) > target ? low : high) = middle;
  }
  return low;
}

class Threshold : public ::testing::TestWithParam<const char*> {};

TEST_P(Threshold, IsMoreThanSixDecibelsWide) {
  const acoustics::Modem modem = load_modem(GetParam()).modem;
  const double width_db = noise_for(modem, 0.1) - noise_for(modem, 0.9);
  halocline::testing::doc_row("threshold",
                              {GetParam(), "from 10 to 90 %", "> 6 dB", fmt::format("{:.1f} dB", width_db)});
  EXPECT_GT(width_db, 6);
  EXPECT_LT(width_db, 13);  // what is measured at sea
}

TEST_P(Threshold, LosesPacketsInBursts) {
  const acoustics::Modem modem = load_modem(GetParam()).modem;
  const double noise_db = noise_for(modem, 0.5);
  double ones = 0, both = 0;
  int count = 0;
  for (std::uint32_t pair = 500; pair < 560; ++pair) {
    const StillLink link(reception(), modem, 32, kSea, pair, {noise_db});
    bool last = link.delivers(0);
    for (int i = 1; i < 60; ++i) {
      const bool now = link.delivers(10.0 * i);
      ones += now;
      both += now && last;
      last = now;
      ++count;
    }
  }
  const double mean = ones / count, correlation = (both / count - mean * mean) / (mean * (1 - mean));
  halocline::testing::doc_row(
      "threshold", {GetParam(), fmt::format("correlation of losses 10 s apart, {:.2f} received", mean),
                    "> 0.15", fmt::format("{:.2f}", correlation)});
  EXPECT_GT(correlation, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Modems, Threshold, ::testing::Values("micromodem-fsk", "janus", "micromodem-psk-1"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace halocline::channel_server

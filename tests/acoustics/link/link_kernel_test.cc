// SPDX-License-Identifier: BSD-3-Clause
// The kernel against LinkModel, which follows the formulas as they stand; link_budget_test.cc holds the
// physics.
#include "acoustics/link/link_kernel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/link/link_budget.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/noise/noise_spectrum.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/elementary.h"
#include "core/hash.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

struct Case {
  std::string name;
  Environment sea;
  Modem modem;
};

Modem modem_of(double low_hz, double high_hz) {
  return generic_modem({185}, {70}, (low_hz + high_hz) / 2, high_hz - low_hz);
}

std::vector<Case> cases() {
  std::vector<Case> all{{"default", {}, {}}, {"deep JANUS", {}, modem_of(9440, 13'600)}};
  for (const AbsorptionModel model : kAbsorptionModels) {
    all.push_back({std::string(to_name(model)), {}, modem_of(300, 900)});
    all.back().sea.absorption_model = model;
    // Above 20 degrees Francois and Garrison's formula steps.
    if (model != AbsorptionModel::kFrancoisGarrison1982)
      all.back().sea.profile = SoundSpeedProfile::harris_zorzi();
  }
  all.push_back({"thermocline of 20 degrees in 5 m", {}, {}});
  all.back().sea.profile = SoundSpeedProfile::from_water(
      {{0, 25, 35}, {10, 24, 35}, {15, 4, 33}, {80, 3, 34}}, SoundSpeedModel::kMackenzie1981, 0.8);
  all.push_back({"Munk", {}, modem_of(100, 200)});
  all.back().sea.profile = SoundSpeedProfile::munk({4, 35});
  all.push_back({"windy, cylindrical, tide", {}, modem_of(20'000, 60'000)});
  all.back().sea.noise.wind_mps = 12;
  all.back().sea.spreading_exponent = 1;
  all.back().sea.sea_surface_z_m = -2.5;
  all.push_back({"three decades", {}, modem_of(50, 60'000)});
  all.push_back({"a beam", {}, {}});
  all.back().modem.beam = BeamPattern({{-1, 20}, {0, 0}, {1, 12}});
  return all;
}

double uniform(std::uint64_t which, double low, double high) {
  return low + (high - low) * uniform_at({.seed = 3, .which = which});
}

struct Ends {
  Vec3 from, to;
};

// Ranges from 1 m to 100 km, depths shallow and deep; a third level, a third nearly.
Ends ends_of(std::uint64_t i) {
  const double deepest_m = i % 2 == 0 ? 120 : 4500;
  Ends ends{{0, 0, uniform(4 * i, 0, deepest_m)}, {0, 0, uniform(4 * i + 1, 0, deepest_m)}};
  if (i % 3 == 0) ends.to.z() = ends.from.z();
  if (i % 3 == 1) ends.to.z() = ends.from.z() + elementary::exp10(uniform(4 * i + 2, -12, 1));
  ends.to.x() = elementary::exp10(uniform(4 * i + 3, 0, 5));
  return ends;
}

constexpr std::uint64_t kLinks = 600;

TEST(LinkKernel, IsTheLinkModel) {
  for (const Case& c : cases()) {
    const LinkKernel kernel(c.sea, c.modem, c.modem);
    const LinkModel model(c.sea, c.modem, c.modem);
    double delay = 0, level = 0, capacity = 0;
    for (std::uint64_t i = 0; i < kLinks; ++i) {
      const auto [from, to] = ends_of(i);
      const LinkBudget fast = kernel.budget(from, to, Capacity::kComputed), slow = model.budget(from, to);
      ASSERT_EQ(fast.range_m, slow.range_m);
      EXPECT_EQ(fast.noise_level, slow.noise_level);
      delay = std::max(delay, std::abs(fast.delay_s / slow.delay_s - 1));
      level = std::max(level, std::abs((fast.received_level - slow.received_level).value));
      EXPECT_NEAR(fast.snr.value, slow.snr.value, tolerance(1e-9)) << c.name;
      const double bits = std::max(slow.capacity_bps, 1.0);
      capacity = std::max(capacity, std::abs(fast.capacity_bps - slow.capacity_bps) / bits);
    }
    EXPECT_LT(delay, tolerance(1e-12)) << c.name;
    EXPECT_LT(level, tolerance(1e-9)) << c.name;
    EXPECT_LT(capacity, tolerance(1e-11)) << c.name << ", " << kernel.frequencies() << " frequencies";
  }
}

TEST(LinkKernel, PathsOfAGivenLossAreThoseOfTheLinkModel) {
  for (const Case& c : cases()) {
    const LinkKernel kernel(c.sea, c.modem, c.modem);
    const LinkModel model(c.sea, c.modem, c.modem);
    for (std::uint64_t i = 0; i < 50; ++i) {
      const auto [from, to] = ends_of(i);
      const double length_m = uniform(i, 1, 1.2) * (to - from).norm();
      const Decibels loss = model.budget(from, to).transmission_loss + Decibels{uniform(i + 1, -20, 40)};
      const LinkBudget slow = model.budget_of_path(from, to, loss, length_m);
      const LinkBudget fast = kernel.budget_of_path(from, to, loss, length_m, Capacity::kComputed);
      EXPECT_EQ(fast.received_level, slow.received_level);
      EXPECT_NEAR(fast.capacity_bps, slow.capacity_bps, tolerance(1e-11) * std::max(slow.capacity_bps, 1.0))
          << c.name;
    }
  }
}

// A table that lies 12 dB higher at all frequencies.
TEST(LinkKernel, NoiseAboveAmbientIsThatOfASeaThatIsSoMuchLouder) {
  const auto table = [](double more_db) {
    return std::make_shared<const NoiseSpectrum>(std::vector<double>{1e3, 2e5},
                                                 std::vector<double>{60 + more_db, 20 + more_db});
  };
  for (const Case& c : cases()) {
    Environment quiet = c.sea, loud = c.sea;
    quiet.noise.table = table(0);
    loud.noise.table = table(12);
    const LinkKernel kernel(quiet, c.modem, c.modem), louder(loud, c.modem, c.modem);
    for (std::uint64_t i = 0; i < 50; ++i) {
      const auto [from, to] = ends_of(i);
      const LinkBudget is = kernel.budget(from, to, Capacity::kComputed, Decibels{12}),
                       expected = louder.budget(from, to, Capacity::kComputed);
      EXPECT_NEAR(is.noise_level.value, expected.noise_level.value, tolerance(1e-9)) << c.name;
      EXPECT_NEAR(is.snr.value, expected.snr.value, tolerance(1e-9));
      EXPECT_NEAR(is.snr_narrowband.value, expected.snr_narrowband.value, tolerance(1e-9));
      EXPECT_NEAR(is.capacity_bps, expected.capacity_bps,
                  tolerance(1e-9) * std::max(expected.capacity_bps, 1.0));
    }
  }
}

std::uint64_t hash_of(VectorInstructions instructions) {
  std::uint64_t sum = kFnvStart;
  for (const Case& c : cases()) {
    const LinkKernel kernel(c.sea, c.modem, c.modem, instructions);
    for (std::uint64_t i = 0; i < kLinks; ++i) {
      const auto [from, to] = ends_of(i);
      const LinkBudget link = kernel.budget(from, to, Capacity::kComputed);
      for (const double value : {link.delay_s, link.received_level.value, link.capacity_bps}) {
        const auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(double)>>(value);
        sum = fnv1a(bytes, sum);
      }
    }
  }
  return sum;
}

// On processors without AVX-512 or AVX2 the number is that of the others.
constexpr std::uint64_t kHash = 3623977414889254942u;
TEST(LinkKernel, GivesTheSameBitsWithAllVectorInstructions) {
  for (const VectorInstructions instructions : vector_instructions())
    EXPECT_EQ(hash_of(instructions), kHash) << static_cast<int>(instructions);
}

TEST(LinkKernel, IsTheSameBothWaysToTheLastBit) {
  const LinkKernel kernel({}, {}, {});
  for (std::uint64_t i = 0; i < kLinks; ++i) {
    const auto [from, to] = ends_of(i);
    const LinkBudget there = kernel.budget(from, to, Capacity::kComputed),
                     back = kernel.budget(to, from, Capacity::kComputed);
    EXPECT_EQ(there.delay_s, back.delay_s);
    EXPECT_EQ(there.received_level, back.received_level);
    EXPECT_EQ(there.capacity_bps, back.capacity_bps);
  }
}

TEST(LinkKernel, WithoutCapacityTheRestIsTheSame) {
  const LinkKernel kernel({}, {}, {});
  for (std::uint64_t i = 0; i < kLinks; ++i) {
    const auto [from, to] = ends_of(i);
    const LinkBudget all = kernel.budget(from, to, Capacity::kComputed),
                     levels = kernel.budget(from, to, Capacity::kLeftOut);
    EXPECT_EQ(all.delay_s, levels.delay_s);
    EXPECT_EQ(all.received_level, levels.received_level);
    EXPECT_EQ(all.snr_narrowband, levels.snr_narrowband);
    EXPECT_GT(all.capacity_bps, 0);
    EXPECT_EQ(levels.capacity_bps, 0);
  }
}

TEST(LinkKernel, TakesAsManyFrequenciesAsTheBandNeeds) {
  const auto frequencies = [](double low_hz, double high_hz) {
    return LinkKernel({}, modem_of(low_hz, high_hz), modem_of(low_hz, high_hz)).frequencies();
  };
  EXPECT_EQ(frequencies(24'900, 25'100), 8u);
  EXPECT_EQ(frequencies(22'500, 27'500), 16u);
  EXPECT_GT(frequencies(8'000, 16'000), 16u);
  EXPECT_GT(frequencies(50, 60'000), 64u);
}

TEST(LinkKernel, HasNoCapacityWhereBandsDoNotOverlap) {
  const LinkKernel kernel({}, modem_of(20'000, 25'000), modem_of(25'000, 30'000));
  const LinkBudget link = kernel.budget({0, 0, 50}, {100, 0, 50}, Capacity::kComputed);
  EXPECT_EQ(link.capacity_bps, 0);
  EXPECT_FALSE(link.receivable);
  EXPECT_GT(link.received_level.value, 100);
}

}  // namespace
}  // namespace halocline::acoustics

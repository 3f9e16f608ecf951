// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/bathymetry_messages.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "bathymetry/ray_service.h"
#include "core/frames.h"
#include "tests/bathymetry/ray_queries.h"

namespace halocline::bathymetry {
namespace {

// Encodes and decodes, as a bus does.
template <class Message>
Message over_the_wire(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  Message decoded;
  EXPECT_GT(decoded.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  return decoded;
}

TEST(BathymetryMessages, AQueryComesBackAsItWas) {
  const RayBatch batch{
      .mode = QueryMode::kDepthTiles,
      .expected_terrain = "0123456789abcdef",
      .sample_spacing_m = 2.5,
      .rays = {{{1000.5, 2000.25, 30}, {0.5, -0.25, 1}, 77}, {{999, 2001, -1}, {0, 0, 1}, 0}}};
  const ray_query_t message = over_the_wire(to_message({123'456, "alpha", 42}, batch, {1000, 2000, 0}));
  EXPECT_EQ(message.offset_m[0], (std::vector<double>{0.5, 0.25, 30}));
  const QueryHeader header = header_of(message);
  EXPECT_EQ(header.utime, 123'456);
  EXPECT_EQ(header.client_name, "alpha");
  EXPECT_EQ(header.request_id, 42);
  const RayBatch back = from_message(message);
  EXPECT_EQ(back.mode, batch.mode);
  EXPECT_EQ(back.expected_terrain, batch.expected_terrain);
  EXPECT_EQ(back.sample_spacing_m, batch.sample_spacing_m);
  ASSERT_EQ(back.rays.size(), 2u);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(back.rays[n].origin_ned_m, batch.rays[n].origin_ned_m);
    EXPECT_EQ(back.rays[n].direction, batch.rays[n].direction);
    EXPECT_EQ(back.rays[n].max_range_m, batch.rays[n].max_range_m);
  }
}

TEST(BathymetryMessages, AnImpossibleModeStaysImpossible) {
  ray_query_t message = to_message({0, "alpha", 1}, {.rays = {{}}}, Vec3::Zero());
  for (const int mode : {-1, -128, 4, 127}) {
    message.query_mode = static_cast<std::int8_t>(mode);
    EXPECT_GT(from_message(message).mode, QueryMode::kDepthTiles) << mode;
  }
}

TEST(BathymetryMessages, AReplyHasTheAnswers) {
  using enum RayStatus;
  const RayAnswers answers{Refusal::kNone,
                           "",
                           {kHit, kMiss, kOutside, kNoData, kStartedBelowBottom, kBadInput},
                           {60, 0, 0, 0, 0, 0}};
  const ray_reply_t message = to_message({123'456, "alpha", 42}, answers, "0123456789abcdef", 99);
  EXPECT_EQ(message.utime, 123'456);
  EXPECT_EQ(message.request_id, 42);
  EXPECT_EQ(message.session, 99);
  EXPECT_EQ(message.terrain_version, "0123456789abcdef");
  EXPECT_EQ(message.num_rays, 6);
  EXPECT_EQ(
      message.ray_status,
      (std::vector<std::int8_t>{ray_reply_t::HIT, ray_reply_t::MISS, ray_reply_t::OUTSIDE,
                                ray_reply_t::NO_DATA, ray_reply_t::BELOW_BOTTOM, ray_reply_t::BAD_INPUT}));
  EXPECT_EQ(message.result_m, answers.results_m);
}

TEST(BathymetryMessages, ARefusalHasItsReason) {
  const RayAnswers answers{Refusal::kOtherTerrain, "the terrain served is another", {}, {}};
  const ray_reply_t message = to_message({1, "alpha", 2}, answers, "v", 3);
  EXPECT_EQ(message.reply_status, ray_reply_t::REFUSED_OTHER_TERRAIN);
  EXPECT_EQ(message.refusal, answers.reason);
  EXPECT_EQ(message.num_rays, 0);
}

}  // namespace
}  // namespace halocline::bathymetry

// SPDX-License-Identifier: BSD-3-Clause
// The lines and units of UASP2, one by one, in both directions.
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "core/check.h"
#include "core/sim_time.h"
#include "core/text/base64.h"
#include "tests/clients/modem_gateway/fake_port.h"

namespace halocline::modem_gateway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Pressure n uPa at sample n.
struct FakeSound : SoundField {
  struct Emitted {
    SimTime begin;
    double rate_hz;
    std::vector<float> samples;
  };
  void emit(std::int32_t, SimTime begin, double rate_hz, std::span<const float> samples) override {
    emitted.push_back({begin, rate_hz, {samples.begin(), samples.end()}});
  }
  void silence(std::int32_t, SimTime from) override { silenced = from; }
  SimDuration lag() const override { return SimDuration::from_milliseconds(250); }
  std::vector<double> record(std::int32_t, double, std::int64_t first, std::size_t count) override {
    std::vector<double> pressure;
    for (std::size_t i = 0; i < count; ++i)
      pressure.push_back(static_cast<double>(first) + static_cast<double>(i));
    return pressure;
  }
  std::vector<Emitted> emitted;
  SimTime silenced;
};

// At 100 s of simulation time.
struct Uasp2 : ::testing::Test {
  FakeSound sound;
  testing::ProtocolBench bench{"uasp2", "sensitivity_db=-20", &sound};

  std::string ask(const std::string& line) { return bench.ask(line + "\n"); }
  static std::string unit(const std::vector<float>& samples, int channels = 1) {
    std::vector<std::uint8_t> bytes(12);
    const auto append = [&](std::uint32_t value, int size) {
      for (int shift = 8 * (size - 1); shift >= 0; shift -= 8)
        bytes.push_back(static_cast<std::uint8_t>(value >> shift));
    };
    append(static_cast<std::uint32_t>(samples.size()), 2);
    append(static_cast<std::uint32_t>(channels), 2);
    for (const float sample : samples) append(std::bit_cast<std::uint32_t>(sample), 4);
    return R"({"action":"odata","data":")" + base64_of(bytes) + R"("})";
  }
  // A number in a unit that was streamed.
  static std::uint64_t number(const std::string& bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes.at(at + i));
    return value;
  }
  static float sample(const std::string& bytes, std::size_t i) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(number(bytes, 16 + 4 * i, 4)));
  }
};

TEST_F(Uasp2, AnswersAreLinesOfJsonWithTheIdOfTheRequest) {
  EXPECT_THAT(ask(R"({"action":"version"})"), HasSubstr(R"("protocol":"0.2.0")"));
  EXPECT_EQ(ask(R"({"action":"get","param":"irate","id":"x1"})"),
            "{\"id\":\"x1\",\"param\":\"irate\",\"value\":96000}\n");
  EXPECT_EQ(ask(R"({"action":"get","param":"time"})"), "{\"param\":\"time\",\"value\":100000000}\n");
  for (const auto& [param, value] : {std::pair("irates", "[24000,48000,96000,192000]"),
                                     {"ichannels", "1"},
                                     {"igain", "0.0"},
                                     {"obufsize", "2880000"},
                                     {"ochannels", "1"},
                                     {"omute", "false"},
                                     {"iblksize", "256"},
                                     {"iseqno", "0"}})
    EXPECT_EQ(ask("{\"action\":\"get\",\"param\":\"" + std::string(param) + "\"}"),
              "{\"param\":\"" + std::string(param) + "\",\"value\":" + value + "}\n");
  // In pieces, and with either line end.
  EXPECT_EQ(bench.ask_in_pieces("{\"action\":\"get\",\"param\":\"iseqno\"}\r\n"),
            "{\"param\":\"iseqno\",\"value\":0}\n");
}

TEST_F(Uasp2, WhatIsWrongIsSaidAndChangesNothing) {
  for (const auto* line : {"x", "[]", "{\"action\":7}", "{}", "{\"action\":\"dance\"}",
                           "{\"action\":\"get\",\"param\":\"colour\"}",
                           "{\"action\":\"set\",\"param\":\"irate\",\"value\":12345}",
                           "{\"action\":\"set\",\"param\":\"ogain\"}",
                           "{\"action\":\"set\",\"param\":\"omute\",\"value\":1}", "{\"action\":\"istart\"}",
                           "{\"action\":\"istart\",\"port\":70000}", "{\"action\":\"odata\",\"data\":\"?\"}",
                           "{\"action\":\"odata\",\"data\":\"AAAA\"}", "{\"action\":\"ostart\",\"time\":-1}"})
    EXPECT_THAT(ask(line), HasSubstr("\"error\"")) << line;
  EXPECT_THAT(ask(unit({1}, 2)), HasSubstr("error"));
  EXPECT_THAT(ask(unit({1, std::numeric_limits<float>::infinity()})), HasSubstr("error"));
  EXPECT_EQ(ask(R"({"action":"odata","id":7,"data":")" + std::string(1'100'000, 'A') + "\"}"),
            "{\"error\":\"line too long\",\"id\":7}\n");
  EXPECT_EQ(ask(R"({"action":"quit"})"), "");
  EXPECT_TRUE(sound.emitted.empty());
  EXPECT_THROW(testing::ProtocolBench("uasp2", "rate=12345"), InvalidArgument);
}

TEST_F(Uasp2, PlaysItsBufferAtTheTimeAskedForAndSaysSo) {
  EXPECT_EQ(ask(unit({0.5F, -1})), "");
  EXPECT_EQ(ask(unit(std::vector<float>(9598, 0.25F))), "");  // 9600 together: 0.1 s
  EXPECT_EQ(ask(R"({"action":"ostart","time":101000000,"id":3})"), "");
  ASSERT_EQ(sound.emitted.size(), 1u);
  EXPECT_EQ(sound.emitted[0].begin, SimTime::from_seconds(101));
  EXPECT_EQ(sound.emitted[0].rate_hz, 96'000);
  EXPECT_EQ(sound.emitted[0].samples.size(), 9600u);
  EXPECT_EQ(sound.emitted[0].samples[1], -1);
  EXPECT_EQ(bench.wait(0.9), "");
  EXPECT_EQ(bench.wait(0.15), "{\"event\":\"ostart\",\"id\":3,\"time\":101000000}\n");
  EXPECT_EQ(bench.wait(0.1), "{\"event\":\"ostop\",\"id\":3,\"time\":101100000}\n");
  // The buffer is empty, a time in the past is now, and gain and mute hold for what is played next.
  ask(R"({"action":"set","param":"ogain","value":-20})");
  ask(unit({1}));
  ask(R"({"action":"ostart","time":5})");
  ask(R"({"action":"set","param":"omute","value":true})");
  ask(unit({1}));
  ask(R"({"action":"ostart"})");
  ASSERT_EQ(sound.emitted.size(), 3u);
  EXPECT_EQ(sound.emitted[1].begin, bench.port.at);
  EXPECT_THAT(sound.emitted[1].samples, ElementsAre(::testing::FloatNear(0.1F, 1e-7F)));
  EXPECT_GT(sound.emitted[2].begin, bench.port.at);  // one after the other
  EXPECT_THAT(sound.emitted[2].samples, ElementsAre(0));
}

TEST_F(Uasp2, StopsWhatItPlays) {
  ask(unit(std::vector<float>(19'200, 1)));
  ask(R"({"action":"ostart"})");
  EXPECT_THAT(bench.wait(0.05), HasSubstr("ostart"));
  EXPECT_EQ(ask(R"({"action":"ostop"})"), "{\"event\":\"ostop\",\"time\":100050000}\n");
  EXPECT_EQ(sound.silenced, SimTime::from_seconds(100.05));
  EXPECT_EQ(bench.wait(1), "");
  EXPECT_EQ(ask(R"({"action":"ostop"})"), "");
  ask(unit({1, 2}));
  ask(R"({"action":"oclear"})");
  ask(unit({3}));
  ask(R"({"action":"ostart"})");
  EXPECT_THAT(sound.emitted.back().samples, ElementsAre(3));
}

TEST_F(Uasp2, StreamsUnitsOneAfterAnotherWithTheTimesOfTheirSamples) {
  ask(R"({"action":"istart","port":8080})");
  bench.wait(2);
  const auto& units = bench.port.datagrams;
  // Of what is 0.25 s old, a tenth of a second at a time.
  ASSERT_GT(units.size(), (2 - 0.25 - 0.1) * 96'000 / 256 - 1);
  const std::uint64_t first_block = 37'500;  // 100 s
  for (std::size_t i = 0; i < units.size(); ++i) {
    ASSERT_EQ(units[i].first, 8080);
    ASSERT_EQ(units[i].second.size(), 16u + 4 * 256);
    EXPECT_EQ(number(units[i].second, 0, 8), (first_block + i) * 256 * 1'000'000 / 96'000);
    EXPECT_EQ(number(units[i].second, 8, 4), i);
    EXPECT_EQ(number(units[i].second, 12, 2), 256u);
    EXPECT_EQ(number(units[i].second, 14, 2), 1u);
    // 1 uPa is 0.1.
    EXPECT_FLOAT_EQ(sample(units[i].second, 255), 0.1F * static_cast<float>((first_block + i) * 256 + 255));
  }
  const auto count = units.size();
  ask(R"({"action":"istop"})");
  bench.wait(1);
  EXPECT_EQ(units.size(), count);
}

TEST_F(Uasp2, StreamsSoManyBlocksAndCountsAnewAfterAReset) {
  ask(R"({"action":"set","param":"irate","value":48000})");
  ask(R"({"action":"set","param":"igain","value":20})");
  ask(R"({"action":"istart","port":8080,"blocks":3})");
  bench.wait(1);
  const auto& units = bench.port.datagrams;
  ASSERT_EQ(units.size(), 3u);
  EXPECT_FLOAT_EQ(sample(units[0].second, 0), 18'750 * 256);  // at 100 s
  EXPECT_EQ(ask(R"({"action":"get","param":"iseqno"})"), "{\"param\":\"iseqno\",\"value\":3}\n");
  ask(R"({"action":"ireset"})");
  EXPECT_EQ(ask(R"({"action":"get","param":"time"})"), "{\"param\":\"time\",\"value\":0}\n");
  ask(R"({"action":"istart","port":8080,"blocks":1})");
  bench.wait(1);
  ASSERT_EQ(units.size(), 4u);
  EXPECT_EQ(number(units[3].second, 8, 4), 0u);
  EXPECT_LT(number(units[3].second, 0, 8), 6000u);  // from its reset on, at the next block
}

TEST_F(Uasp2, AHostThatLeavesTakesItsStreamWithIt) {
  ask(R"({"action":"istart","port":8080})");
  bench.protocol->on_closed(testing::ProtocolBench::kHost);
  EXPECT_EQ(bench.wait(1), "");
  EXPECT_TRUE(bench.port.datagrams.empty());
}

}  // namespace
}  // namespace halocline::modem_gateway

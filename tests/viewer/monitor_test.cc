// SPDX-License-Identifier: BSD-3-Clause
// The real program, on a bus of its own.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bus/bus.h"
#include "bus/messages/channels.h"
#include "bus/transport/transport.h"
#include "tests/runs/timeline/timeline_fixtures.h"
#include "tests/viewer/monitor_program.h"
#include "tests/viewer/web_client.h"

namespace halocline::monitor {
namespace {

using halocline::testing::frame;
using nlohmann::json;
using std::chrono::milliseconds;
using testing::Fleet;
using ::testing::HasSubstr;
using testing::Page;
using testing::Process;
using testing::Program;
using testing::WebClient;

TEST(Monitor, ShowsVehiclesThatMove) {
  Program program;
  const Fleet fleet(3);
  Page page(program.port());
  ASSERT_TRUE(page.opened());
  const json hello = page.await_type("hello");
  EXPECT_EQ(hello["source"], "bus");
  EXPECT_EQ(hello["may_command"], false);
  const json state =
      page.await([](const json& m) { return m["type"] == "state" && m["has_states"] == true; });
  EXPECT_EQ(state["bus"], "live");
  EXPECT_EQ(page.await([](const json& m) {
    return m["type"] == "run" && m["vehicles"].size() == 3;
  })["vehicles"][1]["name"],
            "auv-2");
  const double first_s = page.next_frame_s();
  ASSERT_GE(first_s, 0);
  double last_s = first_s;
  for (int i = 0; i < 20; ++i) last_s = page.next_frame_s();
  EXPECT_GT(last_s, first_s + 0.9);
  EXPECT_EQ(page.last_frame.size(), 12u + 3 * 36u);
}

TEST(Monitor, SilentBusIsNamed) {
  Program program;
  Page page(program.port());
  EXPECT_EQ(
      page.await([](const json& m) { return m["type"] == "state" && m["bus"] == "silent"; })["has_states"],
      false);
}

TEST(Monitor, EndsWithinASecondOfTheSignal) {
  Program program;
  Page page(program.port());
  ASSERT_TRUE(page.opened());
  program.process().signal(SIGTERM);
  EXPECT_EQ(program.process().wait(), 0);
}

TEST(Monitor, AStandardOutputThatIsFullOrClosedIsAFailure) {
  for (const std::string what :
       {"--help >/dev/full", "--version >/dev/full", "--help >&-", "--version >&-"}) {
    Process process({"/bin/sh", "-c", HALOCLINE_BIN_DIR "/halocline-monitor " + what});
    EXPECT_EQ(process.wait(), 1) << what;
  }
}

TEST(Monitor, AnotherAddressDemandsAToken) {
  Process open({std::string(HALOCLINE_BIN_DIR) + "/halocline-monitor", "--address", "0.0.0.0"});
  EXPECT_EQ(open.wait(), 2);
  EXPECT_THAT(open.output(), HasSubstr("--token"));
  Process weak({std::string(HALOCLINE_BIN_DIR) + "/halocline-monitor", "--token", "abc"});
  EXPECT_EQ(weak.wait(), 2);
}

TEST(Monitor, CommandsAreRefusedUnlessAllowed) {
  const Fleet fleet(2);
  const json command = {{"ask", "command"}, {"vehicle", 0},         {"propeller_rpm", 900},
                        {"rudder_rad", 0},  {"stern_plane_rad", 0}, {"for_s", 0.5}};
  {
    Program program;
    Page page(program.port());
    page.await([](const json& m) { return m["type"] == "run" && m["vehicles"].size() == 2; });
    EXPECT_THAT(page.ask(command)["error"], HasSubstr("--allow-commands"));
  }
  Program program({"--allow-commands"});
  Page page(program.port());
  page.await([](const json& m) { return m["type"] == "run" && m["vehicles"].size() == 2; });
  const auto lcm = bus::open_transport(bus::effective_url(""));
  bus::Bus bus(*lcm, {"vehicle", 1});
  int commands = 0, sends = 0;
  bus.subscribe<vehicle_command_t>(
      bus::channels::kCommand,
      [&](std::string_view, const vehicle_command_t& c) { commands += c.propeller_rpm == 900; });
  bus.subscribe<modem_send_t>(bus::channels::kSend,
                              [&](std::string_view, const modem_send_t& s) { sends += s.payload_size; });
  EXPECT_EQ(page.ask(command)["ok"], true);
  const json sent = page.ask({{"ask", "send"}, {"vehicle", 0}, {"destination", 1}, {"payload", "hello"}});
  EXPECT_EQ(sent["ok"], true);
  EXPECT_TRUE(sent["key"].is_string());
  for (int i = 0; i < 100 && (commands < 4 || sends < 5); ++i) lcm->handleTimeout(20);
  EXPECT_GE(commands, 4);
  EXPECT_EQ(sends, 5);
}

TEST(Monitor, HostileClientsCostOnlyThemselves) {
  Program program;
  const Fleet fleet(100);
  Page good(program.port());
  ASSERT_TRUE(good.opened());
  good.await([](const json& m) { return m["type"] == "run" && m["vehicles"].size() == 100; });
  const double before_mb = program.resident_mb();
  std::vector<std::unique_ptr<Page>> stalled;  // never read
  for (int i = 0; i < 4; ++i) stalled.push_back(std::make_unique<Page>(program.port()));
  for (const auto& page : stalled) {
    for (int i = 0; i < 300; ++i)
      page->client().send_message(R"({"ask":"tracks","id":1,"from_s":0,"to_s":1e6,"max_points":20000})");
  }
  std::atomic<bool> stop = false;
  std::thread flood([&] {  // reads what comes, and asks all the time
    Page page(program.port());
    while (!stop) {
      for (int i = 0; i < 20; ++i)
        page.client().send_message(R"({"ask":"vehicle","id":1,"vehicle":0,"from_s":0,"to_s":1e6})");
      while (page.client().next(milliseconds(1))) {
      }
    }
  });
  for (int round = 0; round < 30; ++round) {
    for (const char* bytes :
         {"{", "[]", "null", R"({"ask":1,"id":2})", R"({"ask":"link","id":1,"from":-1,"to":1e300})",
          R"({"ask":"seek","id":1,"time_s":1e308})"}) {
      Page page(program.port());
      if (!page.opened()) continue;
      page.client().send_message(bytes);
    }
    WebClient killed(program.port());
    killed.send("GET /ws HTTP/1.1\r\n");
    Page huge(program.port());
    if (huge.opened()) huge.client().send(frame(std::string(1'000'000, '['), 1));
    WebClient wrong(program.port());
    wrong.send("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  }
  std::vector<std::unique_ptr<WebClient>> many;
  for (int i = 0; i < 200; ++i) many.push_back(std::make_unique<WebClient>(program.port()));
  // Time and again the good page is shown what was published before it looked, and by few frames: none waits
  // in a queue.
  constexpr int kLooks = 20, kFramesAhead = 15;
  for (int look = 0; look < kLooks; ++look) {
    const double published_s = fleet.time_s();
    int frames = 0;
    for (double time_s = -1; time_s < published_s; ++frames) {
      time_s = good.next_frame_s();
      ASSERT_GE(time_s, 0) << "no frames any more";
    }
    EXPECT_LE(frames, kFramesAhead) << look;
  }
  stop = true;
  flood.join();
  EXPECT_LT(program.resident_mb() - before_mb, 150);
  EXPECT_TRUE(program.process().running());
  EXPECT_EQ(good.await_type("state")["messages_dropped"], 0);
}

class LogOfARun {
 public:
  LogOfARun() {
    folder_ = std::filesystem::temp_directory_path() / ("halocline_monitor_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    lcm::LogFile log(path(), "w");
    for (int s = 0; s <= 60; ++s) {
      for (int id = 1; id <= 2; ++id)
        write(log, "STATE.auv-" + std::to_string(id),
              clients::testing::state(id, s * 1'000'000, s, id * 500.0, 30));
    }
    write(log, "OUTCOME", clients::testing::outcome(1, 2, 0, 10'000'000));
    write(log, "ENVIRONMENT", water(0, 1500));
    write(log, "ENVIRONMENT", water(kChange_s * 1'000'000, 1450));
  }
  ~LogOfARun() { std::filesystem::remove_all(folder_); }
  LogOfARun(const LogOfARun&) = delete;
  LogOfARun& operator=(const LogOfARun&) = delete;

  static constexpr int kChange_s = 30;  // the water changes

  std::string path() const { return (folder_ / "run.lcm").string(); }
  void add_scenario() const {
    std::ofstream(folder_ / "run.toml")
        << "[scenario]\nname = \"pair\"\norigin_latitude_deg = 43.6\n"
           "[terrain]\nkind = \"flat\"\nsize_north_m = 4000\nsize_east_m = 4000\n[terrain.flat]\ndepth_m = "
           "100\n"
           "[[vehicle]]\nname = \"auv-1\"\nid = 1\nmodel = \"external\"\nstart_ned_m = [0.0, 0.0, 30.0]\n"
           "[[vehicle]]\nname = \"auv-2\"\nid = 2\nmodel = \"external\"\nstart_ned_m = [0.0, 500.0, 30.0]\n";
  }

 private:
  static environment_t water(std::int64_t utime, double surface_mps) {
    environment_t water{};
    water.utime = utime;
    water.num_layers = 2;
    water.layer_depth_m = {0, 100};
    water.layer_sound_speed_mps = {surface_mps, 1500};
    water.layer_temperature_degc = {12, 12};
    water.layer_salinity_psu = {35, 35};
    water.acidity_ph = 8;
    water.spreading_exponent = 2;
    return water;
  }
  template <class Message>
  static void write(lcm::LogFile& log, const std::string& channel, const Message& message) {
    bus::Bytes bytes = bus::encoded(message);
    lcm::LogEvent event{0, message.utime, channel, static_cast<std::int32_t>(bytes.size()), bytes.data()};
    log.writeEvent(&event);
  }
  std::filesystem::path folder_;
};

TEST(Monitor, LogPlaysAndSeeks) {
  const LogOfARun log;
  Program program({log.path()});
  Page page(program.port());
  const json hello = page.await_type("hello");
  EXPECT_EQ(hello["end_s"], 60);
  EXPECT_THAT(hello["limits"][0], HasSubstr("configuration"));
  EXPECT_EQ(page.next_frame_s(), 0);
  EXPECT_EQ(page.ask({{"ask", "seek"}, {"time_s", 30}})["ok"], true);
  EXPECT_EQ(page.next_frame_s(), 30);
  EXPECT_EQ(page.ask({{"ask", "speed"}, {"x", 10}})["ok"], true);
  EXPECT_EQ(page.ask({{"ask", "play"}})["ok"], true);
  EXPECT_EQ(page.await([](const json& m) { return m["type"] == "state" && m["playing"] == false; })["time_s"],
            60);
  EXPECT_EQ(page.ask({{"ask", "live"}})["ok"], false);
  EXPECT_THAT(page.ask({{"ask", "link"}, {"from", 0}, {"to", 1}, {"time_s", 10}})["notice"],
              HasSubstr("configuration"));
}

TEST(Monitor, LogWithItsScenarioHasRaysAndTerrain) {
  const LogOfARun log;
  log.add_scenario();
  Program program({log.path()});
  Page page(program.port());
  const json run = page.await([](const json& m) { return m["type"] == "run" && !m["terrain"].is_null(); });
  ASSERT_FALSE(run.is_null());
  EXPECT_EQ(run["name"], "pair");
  EXPECT_EQ(run["terrain"]["min_depth_m"], 100);
  const json link = page.ask({{"ask", "link"}, {"from", 0}, {"to", 1}, {"time_s", 10}});
  EXPECT_TRUE(link["notice"].is_null()) << link["notice"];
  ASSERT_GT(link["paths"].size(), 2u);
  EXPECT_EQ(link["paths"][0]["range_m"][0], 0);
  EXPECT_FALSE(link["budget"].empty());
  EXPECT_EQ(link["seabed"]["depth_m"][0], 100);
  EXPECT_TRUE(link["budget"].back()["limit"].is_number());
  const json later =
      page.ask({{"ask", "link"}, {"from", 0}, {"to", 1}, {"time_s", LogOfARun::kChange_s + 10}});
  EXPECT_NE(link["profile"]["sound_speed_mps"][0], 1450);
  EXPECT_EQ(later["profile"]["sound_speed_mps"][0], 1450);
  EXPECT_GT(later["paths"][0]["delay_s"], 0.33);
  EXPECT_EQ(page.ask({{"ask", "terrain"},
                      {"south_m", -100},
                      {"west_m", -100},
                      {"spacing_m", 10},
                      {"rows", 20},
                      {"columns", 20}})["ok"],
            true);
}

}  // namespace
}  // namespace halocline::monitor

// SPDX-License-Identifier: BSD-3-Clause
// Every program on a bus on which somebody sends datagrams that LCM, left alone, would write or read beyond
// its memory for. Runs inside a network namespace of its own (scripts/isolated).
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus/transport/datagram_filter.h"
#include "tests/bus/filtered_socket.h"
#include "tests/integration/bus_monitor.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using bus::testing::Fragment;
using testing::BusMonitor;
using testing::Process;

const char* const kScenario = HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml";
const char* const kNetwork = HALOCLINE_SOURCE_DIR "/scenarios/networks/one_hop.toml";

// Datagrams of one sender, one after the other.
using Attack = std::vector<std::string>;

std::vector<Attack> attacks_on(const std::string& channel) {
  const std::string whole = channel + std::string(1, 0), more(400, 0);
  const std::string begin = Fragment{.size = 1024, .count = 3, .part = whole + more}.datagram();
  const auto next = [](std::uint32_t offset, const std::string& part) {
    return Fragment{.size = 1024, .offset = offset, .number = 1, .count = 3, .part = part}.datagram();
  };
  std::vector<Attack> attacks{{begin, next(0xfffffff0, std::string(32, 'A'))},
                              {begin, next(0x80000000, std::string(32, 'A'))},
                              {begin, next(1000, more)},
                              {begin, begin, begin, begin}};
  for (std::size_t size = 8; size < 20; ++size) attacks.push_back({begin, next(300, "").substr(0, size)});
  // A channel that goes on in what is left of an earlier datagram.
  for (const std::uint32_t offset : {0u, 1u, 16u})
    attacks.push_back({begin, Fragment{.size = 9, .offset = offset, .part = channel}.datagram()});
  attacks.push_back({bus::testing::short_message(channel + "1", ""), "LC02" + std::string(4, 1) + channel});
  for (const std::uint32_t size : {bus::kMaxMessageBytes, 1u << 28, 0xffffffffu})
    attacks.push_back({Fragment{.size = size, .count = 1, .part = whole + more}.datagram()});
  return attacks;
}

void send(const Attack& attack, std::uint16_t port) {
  const int sender = socket(AF_INET, SOCK_DGRAM, 0);
  const int ttl = 0;
  setsockopt(sender, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  const sockaddr_in group{AF_INET, htons(port), {htonl(0xefff4c43)}, {}};
  for (const std::string& datagram : attack)
    EXPECT_GT(sendto(sender, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&group),
                     sizeof group),
              0);
  close(sender);
}

std::unique_ptr<Process> run(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{HALOCLINE_BIN_DIR "/" + program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return std::make_unique<Process>(words);
}

void expect_all_running(const std::vector<std::unique_ptr<Process>>& processes, const std::string& after) {
  for (const auto& process : processes) EXPECT_TRUE(process->running()) << after << ": " << process->output();
}

TEST(AttackedDatagrams, EndNoProgramOnTheBus) {
  std::vector<std::unique_ptr<Process>> processes;
  for (const char* program :
       {"halocline-conductor", "halocline-bathymetry", "halocline-vehicle-sim", "halocline-channel-server",
        "halocline-traffic", "halocline-autopilot", "halocline-localiser", "halocline-modem-gateway"})
    processes.push_back(run(program, {kScenario}));
  processes.push_back(run("halocline-network", {kNetwork}));
  processes.push_back(run("halocline-monitor", {"--port", "0"}));
  processes.push_back(run("echo-modem", {"alpha", "1"}));
  BusMonitor monitor;
  const auto outcomes_come = [&] {
    const std::size_t before = monitor.outcomes.size();
    return monitor.wait_until([&] { return monitor.outcomes.size() >= before + 4; });
  };
  ASSERT_TRUE(outcomes_come());
  for (const char* channel : {"STATE.alpha", "CLOCK", "HEARTBEAT.traffic", "REPAIR_REQUEST", "STATUS.traffic",
                              "SENSORS.alpha", "RECEIVE.alpha", "RECEIPT.alpha", "SEND.alpha", "ENVIRONMENT",
                              "RAY_QUERY", "COMMAND.alpha", "NETWORK_SEND.alpha", "LCM_SELF_TEST"}) {
    for (const Attack& attack : attacks_on(channel)) send(attack, 7667);
    monitor.dispatch_for(0.3);
    expect_all_running(processes, channel);
  }
  EXPECT_TRUE(outcomes_come());
  expect_all_running(processes, "afterwards");
}

// The commands as docs/reliability.md has them.
TEST(AttackedDatagrams, TheFirewallKeepsThemFromStockTools) {
  if (std::system("PATH=$PATH:/sbin:/usr/sbin; nft list tables >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "no nft here";
  std::ifstream page(HALOCLINE_SOURCE_DIR "/docs/reliability.md");
  int rules = 0;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("    nft add ")) continue;
    ASSERT_EQ(std::system(("PATH=$PATH:/sbin:/usr/sbin;" + line).c_str()), 0) << line;
    rules += line.find(" rule ") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(rules, 4);
  const std::string log = ::testing::TempDir() + "attacked_datagrams.lcm";
  Process logger({"/usr/bin/lcm-logger", "--lcm-url=udpm://239.255.76.67:7667?ttl=0", "-f", log});
  BusMonitor monitor;
  ASSERT_TRUE(monitor.wait_until([&] {
    monitor.lcm().publish("STATE.alpha", "x", 1);
    std::error_code error;
    return std::filesystem::file_size(log, error) > 0 && !error;
  })) << logger.output();
  for (const Attack& attack : attacks_on("STATE.alpha")) {
    if (attack.back().starts_with("LC03")) send(attack, 7667);
  }
  monitor.dispatch_for(0.5);
  EXPECT_TRUE(logger.running()) << logger.output();
  std::system("PATH=$PATH:/sbin:/usr/sbin; nft delete table inet lcm");
  std::filesystem::remove(log);
}

TEST(AttackedDatagrams, EndNoProgramInLockstep) {
  std::vector<std::unique_ptr<Process>> processes;
  processes.push_back(
      run("halocline-conductor", {kScenario, "--lockstep", "--expect", "away", "--bridge-bus"}));
  for (const char* program : {"halocline-bathymetry", "halocline-vehicle-sim", "halocline-channel-server"})
    processes.push_back(run(program, {kScenario, "--time-source", "lockstep"}));
  BusMonitor monitor;  // this program's bus is the ordinary one
  for (const auto& process : processes) {
    ASSERT_TRUE(monitor.wait_until([&] { return process->output().find("started") != std::string::npos; }))
        << process->output();
  }
  for (const char* channel : {"LOCKSTEP_GRANT", "LOCKSTEP_GRANT.vehicle-sim", "LOCKSTEP_NOTICE",
                              "LOCKSTEP_JOIN", "LOCKSTEP_ANSWER", "STATE.alpha", "LCM_SELF_TEST"}) {
    for (const Attack& attack : attacks_on(channel)) {
      for (const std::uint16_t port : {std::uint16_t{7667}, std::uint16_t{7677}, std::uint16_t{7678}})
        send(attack, port);
    }
    monitor.dispatch_for(0.3);
    expect_all_running(processes, channel);
  }
}

}  // namespace
}  // namespace halocline

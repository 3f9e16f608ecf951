// SPDX-License-Identifier: BSD-3-Clause
// Programs on the private bus of a running ./scripts/run --distributed (scripts/join), and what of them is
// reached from outside of it.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/process.h"
#include "tests/support/working_folder.h"
#include "tests/viewer/web_client.h"

namespace halocline::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;

std::string script(const std::string& name) { return std::string(HALOCLINE_SOURCE_DIR) + "/scripts/" + name; }

bool prints(const Process& process, const std::string& text) {
  const auto end = std::chrono::steady_clock::now() + kHangLimit;
  while (process.output().find(text) == std::string::npos && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(20ms);
  return process.output().find(text) != std::string::npos;
}

Words operator+(Words one, const Words& other) {
  one.insert(one.end(), other.begin(), other.end());
  return one;
}

// A run and those who join it leave their files in the working folder; perhaps as another user.
class Join : public ::testing::Test {
 protected:
  [[nodiscard]] std::unique_ptr<Process> start(const Words& words) const {
    const Words environment{"/usr/bin/env", "TMPDIR=" + here_, "HALOCLINE_BIN=" HALOCLINE_BIN_DIR};
    return std::make_unique<Process>(as_ + environment + words);
  }
  void start_run() {
    run_ = start({script("run_distributed"), HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml", "--duration",
                  "600", "--log", here_ + "/run.lcmlog"});
    ASSERT_TRUE(prints(*run_, "to join their bus: ./scripts/join")) << run_->output();
  }
  [[nodiscard]] std::unique_ptr<Process> join(const Words& words) const {
    return start(Words{script("join")} + words);
  }
  // A monitor of the run, which serves a page of one line.
  [[nodiscard]] std::unique_ptr<Process> join_monitor(const Words& options = {}) const {
    fs::create_directories("page");
    std::ofstream("page/index.html") << "the page of the test\n";
    return join(Words{"halocline-monitor", "--page", here_ + "/page"} + options);
  }
  void stop_run() {
    run_->signal(SIGTERM);
    EXPECT_EQ(run_->wait(), 0) << run_->output();
  }
  void expect_page_outside(Process& monitor);

  TemporaryFolder folder_;
  std::string here_ = fs::current_path().string();
  Words as_;
  std::unique_ptr<Process> run_;
};

// The address that it prints, once it does; empty for none.
std::string address_of(const Process& monitor) {
  if (!prints(monitor, "http://")) return "";
  static const std::regex address("http://127.0.0.1:([0-9]+)/?\n");
  const std::string output = monitor.output();
  std::smatch found;
  return std::regex_search(output, found, address) ? found[0].str() : "";
}

std::uint16_t port_of(const std::string& address) {
  return static_cast<std::uint16_t>(std::atoi(address.c_str() + address.rfind(':') + 1));
}

std::string fetched(const std::string& address) {
  Process python({"/usr/bin/python3", "-c",
                  "import sys, urllib.request; print(urllib.request.urlopen(sys.argv[1].strip(), "
                  "timeout=30).read().decode())",
                  address});
  EXPECT_EQ(python.wait(), 0) << python.output();
  return python.output();
}

// Whether the page gets messages of the run: the names of its vehicles.
bool shows_vehicles(std::uint16_t port) {
  WebClient client(port);
  client.open("/ws", host_of(port) + "Sec-WebSocket-Protocol: halocline.monitor.v1\r\n");
  const auto end = std::chrono::steady_clock::now() + kHangLimit;
  while (std::chrono::steady_clock::now() < end) {
    const auto message = client.next(5s);
    if (message && !message->binary && message->bytes.find("\"bravo\"") != std::string::npos) return true;
  }
  return false;
}

void Join::expect_page_outside(Process& monitor) {
  const std::string address = address_of(monitor);
  ASSERT_NE(address, "") << monitor.output();
  EXPECT_THAT(fetched(address), HasSubstr("the page of the test"));
  EXPECT_TRUE(shows_vehicles(port_of(address)));
  const std::string output = monitor.output();
  EXPECT_EQ(output.find("http://"), output.rfind("http://")) << output;
}

TEST_F(Join, AForeignVehicleJoinsADistributedRun) {
  start_run();
  const auto vehicle = join({"foreign-vehicle", "--name", "visitor", "--every", "1", "--north", "200"});
  EXPECT_TRUE(prints(*vehicle, "packet 0 accepted")) << vehicle->output();
  EXPECT_TRUE(prints(*vehicle, ": from vehicle ")) << vehicle->output();
  EXPECT_THAT(vehicle->output(), Not(HasSubstr("no CLOCK")));
  stop_run();
  const auto late = join({"/bin/true"});
  EXPECT_EQ(late->wait(), 2);
  EXPECT_THAT(late->output(), HasSubstr("no run: start one with ./scripts/run --distributed"));
}

TEST_F(Join, ThePageOfTheMonitorIsReachedFromOutsideAndEndsWithTheRun) {
  start_run();
  const auto monitor = join_monitor();
  expect_page_outside(*monitor);
  stop_run();
  EXPECT_EQ(monitor->wait(), 0) << monitor->output();
  EXPECT_THAT(monitor->output(), HasSubstr("the run has ended\n"));
}

TEST_F(Join, ThePageOfHaloclineViewIsReachedFromOutside) {
  start_run();
  fs::create_directories("page");
  std::ofstream("page/index.html") << "the page of the test\n";
  const auto view = join({"halocline", "view", "--page", here_ + "/page"});
  expect_page_outside(*view);
  stop_run();
  EXPECT_EQ(view->wait(), 0) << view->output();
}

TEST_F(Join, ARunIsFoundInAFolderWithABlankInItsName) {
  fs::create_directory("a folder");
  here_ += "/a folder";
  start_run();
  const auto joined = join({"/bin/echo", "on its bus"});
  EXPECT_EQ(joined->wait(), 0) << joined->output();
  EXPECT_THAT(joined->output(), HasSubstr("on its bus"));
  stop_run();
}

TEST_F(Join, TheMonitorEndsOnCtrlC) {
  start_run();
  const auto monitor = join_monitor();
  ASSERT_NE(address_of(*monitor), "") << monitor->output();
  monitor->signal(SIGINT);
  EXPECT_EQ(monitor->wait(), 0) << monitor->output();
  stop_run();
}

TEST_F(Join, APortThatIsTakenIsAnError) {
  start_run();
  const auto first = join_monitor();
  const std::string address = address_of(*first);
  ASSERT_NE(address, "") << first->output();
  const std::string port = std::to_string(port_of(address));
  const auto second = join_monitor({"--port", port});
  EXPECT_EQ(second->wait(), 2);
  EXPECT_THAT(second->output(),
              HasSubstr("cannot listen on 127.0.0.1, port " + port + ": Address already in use"));
  stop_run();
}

// Without root the network of a run lies in a namespace of users, where he is root, too: the folder of root's
// runs is not his.
TEST_F(Join, AUserWhoIsNotRootSeesThePageOfHisRun) {
  if (getuid() == 0) as_ = {"/usr/bin/setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"};
  const fs::path folder = "/tmp/halocline-join-" + std::to_string(getpid());  // which he reaches
  fs::create_directory(folder);
  fs::permissions(folder, fs::perms::all);
  fs::create_directory(folder / "halocline-runs-0");
  const WorkingFolder working(folder);
  here_ = folder.string();
  const auto possible = start({"/bin/sh", "-c", "test -x \"$HALOCLINE_BIN/halocline\" && unshare -rn true"});
  if (possible->wait() != 0) {  // this machine lets only root make networks, or read the tree
    fs::remove_all(folder);
    return;
  }
  start_run();
  const auto monitor = join_monitor();
  expect_page_outside(*monitor);
  stop_run();
  EXPECT_EQ(monitor->wait(), 0) << monitor->output();
  fs::remove_all(folder);
}

TEST_F(Join, ANetworkThatCannotBeEnteredIsAnError) {
  Process monitor({HALOCLINE_BIN_DIR "/halocline-monitor", "--network", "4194303"});
  EXPECT_EQ(monitor.wait(), 2);
  EXPECT_THAT(monitor.output(), HasSubstr("there is no such process"));
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_script(const std::string& path, const std::string& text) {
  fs::create_directories(fs::path(path).parent_path());
  std::ofstream(path) << "#!/bin/sh\n" << text << "\n";
  fs::permissions(path, fs::perms::all);
}

// A tree whose scripts install, build and run by the programs of a test, each of which notes its network.
TEST_F(Join, WhatScriptsInstallAndBuildTheyDoOutsideOfTheRun) {
  start_run();
  const std::string note = "readlink /proc/self/ns/net >>'" + here_ + "/networks'";
  for (const char* name : {"join", "monitor", "spy"}) {
    fs::create_directories("tree/scripts");
    fs::copy_file(script(name), std::string("tree/scripts/") + name);
  }
  write_script("tree/scripts/setup", note);
  write_script("tree/scripts/build", note);
  write_script("tree/scripts/types", note);
  write_script("tree/bin/npm", note +
                                   "\nmkdir -p ../../build/monitor/page node_modules\n"
                                   "echo the page of the test >../../build/monitor/page/index.html");
  write_script("tree/bin/java", "readlink /proc/self/ns/net >'" + here_ + "/network of the spy'");
  fs::create_directories("tree/viewer/page/src");
  for (const char* file : {"package-lock.json", "index.html", "page.ts", "page.js", ".npmrc", "src/page.ts"})
    std::ofstream(std::string("tree/viewer/page/") + file) << "{}";
  fs::create_directories("tree/build/release/bin");
  fs::create_symlink(HALOCLINE_BIN_DIR "/halocline-monitor", "tree/build/release/bin/halocline-monitor");
  const auto in_tree = [&](const std::string& program) {
    return std::make_unique<Process>(Words{"/usr/bin/env", "TMPDIR=" + here_, "HALOCLINE_BIN=",
                                           "PATH=" + here_ + "/tree/bin:" + std::getenv("PATH"),
                                           here_ + "/tree/scripts/join", here_ + "/tree/scripts/" + program});
  };
  const auto monitor = in_tree("monitor");
  expect_page_outside(*monitor);
  const auto spy = in_tree("spy");
  EXPECT_EQ(spy->wait(), 0) << spy->output();
  const std::string outside = fs::read_symlink("/proc/self/ns/net").string() + "\n";
  const std::string networks = text_of("networks");
  EXPECT_GE(networks.size(), 5 * outside.size());
  for (std::size_t at = 0; at < networks.size(); at += outside.size())
    EXPECT_EQ(networks.substr(at, outside.size()), outside);
  EXPECT_NE(text_of("network of the spy"), outside);
  EXPECT_NE(text_of("network of the spy"), "");
  stop_run();
}

// Two runs as scripts/join finds them: a process in a network of its own, and the file that names it.
class JoinOneOfTwo : public Join {
 protected:
  void SetUp() override {
    for (const char* scenario : {"one.toml", "two.toml"}) {
      runs_.push_back(start({script("isolated"), "/bin/sleep", "600"}));
      announce(runs_.back()->pid(), scenario);
    }
  }
  void announce(pid_t pid, const std::string& scenario) const {
    const std::string own = fs::read_symlink("/proc/self/ns/net").string(),
                      link = "/proc/" + std::to_string(pid) + "/ns/net";
    const auto end = std::chrono::steady_clock::now() + kHangLimit;
    while (fs::read_symlink(link).string() == own && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(20ms);
    const std::string folder = "halocline-runs-" + std::to_string(getuid());
    fs::create_directories(folder);
    std::ofstream(folder + "/" + std::to_string(pid))
        << fs::read_symlink(link).string() << " udpm://239.255.76.67:7667 " << scenario << "\n";
  }
  std::string pid_of(std::size_t run) const { return std::to_string(runs_.at(run)->pid()); }
  std::string network_of(std::size_t run) const {
    return fs::read_symlink("/proc/" + pid_of(run) + "/ns/net").string() + "\n";
  }

  std::vector<std::unique_ptr<Process>> runs_;
};

TEST_F(JoinOneOfTwo, WithoutATerminalTheyAreListedAndNoneIsTaken) {
  Process joined({"/bin/sh", "-c", "TMPDIR=. \"$0\" /bin/true </dev/null", script("join")});
  EXPECT_EQ(joined.wait(), 2);
  for (std::size_t run : {0u, 1u}) EXPECT_THAT(joined.output(), HasSubstr("--run " + pid_of(run)));
  EXPECT_THAT(joined.output(), HasSubstr("one.toml"));
  EXPECT_THAT(joined.output(), HasSubstr("join: which one? Say it by --run PID"));
}

TEST_F(JoinOneOfTwo, TheOneThatIsNamedIsTaken) {
  for (std::size_t run : {0u, 1u}) {
    const auto joined = join({"--run", pid_of(run), "readlink", "/proc/self/ns/net"});
    EXPECT_EQ(joined->wait(), 0) << joined->output();
    EXPECT_THAT(joined->output(), HasSubstr(network_of(run)));
  }
  const auto none = join({"--run", "1", "/bin/true"});
  EXPECT_EQ(none->wait(), 2);
  EXPECT_THAT(none->output(), HasSubstr("no run of process 1; ./scripts/join lists the runs"));
}

TEST_F(JoinOneOfTwo, OnATerminalOneIsAskedWhichOne) {
  const std::string command = "TMPDIR='" + here_ + "' " + script("join") + " readlink /proc/self/ns/net";
  Process joined({"/bin/sh", "-c", "printf '7\\n1\\n' | script -qec \"$0\" /dev/null", command});
  EXPECT_EQ(joined.wait(), 0) << joined.output();
  EXPECT_THAT(joined.output(), HasSubstr("which one (1 to 2)? "));
  const std::string latest = network_of(1);
  EXPECT_THAT(joined.output(), HasSubstr(latest.substr(0, latest.size() - 1)));
}

}  // namespace
}  // namespace halocline::testing

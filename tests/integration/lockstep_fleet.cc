// SPDX-License-Identifier: BSD-3-Clause
#include "tests/integration/lockstep_fleet.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <unistd.h>

namespace halocline::testing {
namespace {

std::string contents_of(const std::filesystem::path& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

bool eventually(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kHangLimit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

}  // namespace

LockstepFleet::LockstepFleet(std::string scenario, std::vector<std::string> settings, NetworkFaults faults,
                             int shards, int blocks)
    : shards_(shards),
      blocks_(blocks),
      participants_({"bathymetry", "autopilot", "traffic", "localiser"}),
      scenario_(HALOCLINE_TEST_DATA "/scenarios/" + std::move(scenario) + ".toml"),
      settings_(std::move(settings)),
      faults_(faults),
      folder_(::testing::TempDir() + "halocline-lockstep-" + std::to_string(getpid())) {
  add_parts("vehicle-sim", blocks);
  add_parts("channel-server", shards);
  std::filesystem::create_directories(folder_);
}

void LockstepFleet::add_parts(const std::string& program, int count) {
  for (int i = 0; i < count; ++i)
    participants_.push_back(count == 1 ? program : program + "-" + std::to_string(i));
}

LockstepFleet::~LockstepFleet() {
  processes_.clear();
  std::filesystem::remove_all(folder_);
}

std::vector<std::string> LockstepFleet::settings_as_options() const {
  std::vector<std::string> options;
  for (const std::string& setting : settings_) options.insert(options.end(), {"--set", setting});
  return options;
}

std::vector<std::string> LockstepFleet::command(const std::string& program, bool with_faults) const {
  std::vector<std::string> words;
  if (with_faults && faults_.loss + faults_.duplication + faults_.reordering > 0) {
    words = {"/usr/bin/env", "LD_PRELOAD=" HALOCLINE_LOSSY_UDP,
             "HALOCLINE_UDP_LOSS=" + std::to_string(faults_.loss),
             "HALOCLINE_UDP_DOUBLING=" + std::to_string(faults_.duplication),
             "HALOCLINE_UDP_REORDERING=" + std::to_string(faults_.reordering)};
  }
  words.push_back(HALOCLINE_BIN_DIR "/" + program);
  return words;
}

void LockstepFleet::start_conductor(const std::vector<std::string>& options) {
  auto words = command("halocline-conductor", true);
  words.insert(words.end(), {scenario_, "--lockstep", "--journal", (folder_ / "journal").string(), "--log",
                             (folder_ / "separate.lcm").string()});
  for (const std::string& option : settings_as_options()) words.push_back(option);
  std::string expected;
  for (const std::string& name : participants_) expected += (expected.empty() ? "" : ",") + name;
  const bool has_expected = std::find(options.begin(), options.end(), "--expect") != options.end();
  if (!has_expected) words.insert(words.end(), {"--expect", expected});
  words.insert(words.end(), options.begin(), options.end());
  conductor_options_ = options;
  if (processes_.contains("conductor")) earlier_output_ += at("conductor").output();
  processes_["conductor"] = std::make_unique<Process>(words);
}

void LockstepFleet::start(const std::string& participant) {
  const bool is_part = std::isdigit(static_cast<unsigned char>(participant.back())) != 0;
  const std::size_t dash = participant.rfind('-');
  auto words = command("halocline-" + (is_part ? participant.substr(0, dash) : participant), true);
  words.insert(words.end(), {scenario_, "--time-source", "lockstep"});
  if (is_part) {
    const bool is_shard = participant.starts_with("channel-server");
    words.insert(words.end(),
                 {is_shard ? "--shard" : "--block",
                  participant.substr(dash + 1) + "/" + std::to_string(is_shard ? shards_ : blocks_)});
  }
  for (const std::string& option : settings_as_options()) words.push_back(option);
  processes_[participant] = std::make_unique<Process>(words);
}

void LockstepFleet::start_all(const std::vector<std::string>& conductor_options) {
  start_conductor(conductor_options);
  for (const std::string& name : participants()) start(name);
}

void LockstepFleet::kill_and_restart(const std::string& name) {
  at(name).signal(SIGKILL);
  at(name).wait();
  name == "conductor" ? start_conductor(conductor_options_) : start(name);
}

bool LockstepFleet::run_to_the_end() {
  const auto end = std::chrono::steady_clock::now() + kHangLimit;
  while (std::chrono::steady_clock::now() < end) {
    for (const std::string& name : participants()) {
      const int code = at(name).wait(std::chrono::milliseconds(0));
      if (code > 0) start(name);
    }
    const int code = at("conductor").wait(std::chrono::milliseconds(5));
    if (code >= 0) return code == 0;
  }
  return false;
}

bool LockstepFleet::wait_for_log(std::size_t bytes) const {
  const std::filesystem::path log = folder_ / "separate.lcm";
  return eventually([&] { return std::filesystem::exists(log) && std::filesystem::file_size(log) >= bytes; });
}

bool LockstepFleet::wait_for_output(const std::string& text) {
  return eventually([&] { return conductor_output().find(text) != std::string::npos; });
}

void LockstepFleet::cut_log_in_half() const {
  const std::filesystem::path log = folder_ / "separate.lcm";
  std::filesystem::resize_file(log, std::filesystem::file_size(log) / 2);
}

std::string LockstepFleet::conductor_output() { return earlier_output_ + at("conductor").output(); }

std::string LockstepFleet::log_bytes() const { return contents_of(folder_ / "separate.lcm"); }

std::map<std::string, int> LockstepFleet::events_by_channel() const {
  lcm::LogFile log((folder_ / "separate.lcm").string(), "r");
  std::map<std::string, int> counts;
  for (const lcm::LogEvent* event = log.readNextEvent(); event != nullptr; event = log.readNextEvent())
    ++counts[event->channel];
  return counts;
}

std::string LockstepFleet::output_bytes() const { return output_of(folder_ / "separate.lcm"); }

std::string LockstepFleet::output_of_one_process(const std::vector<std::string>& more_settings) {
  log_of_one_process(more_settings);
  return output_of(folder_ / "one.lcm");
}

std::string LockstepFleet::output_of(const std::filesystem::path& log) const {
  auto words = command("halocline", false);
  const std::string output = log.string() + ".output";
  words.insert(words.end(), {"log", "output", log.string(), "--out", output});
  EXPECT_EQ(Process(words).wait(), 0);
  return contents_of(output);
}

std::string LockstepFleet::log_of_one_process(const std::vector<std::string>& more_settings) {
  auto words = command("halocline", false);
  const std::string log = (folder_ / "one.lcm").string();
  words.insert(words.end(),
               {"run", scenario_, "--quiet", "--no-csv", "--no-report", "--force", "--log", log});
  for (const std::string& option : settings_as_options()) words.push_back(option);
  for (const std::string& setting : more_settings) words.insert(words.end(), {"--set", setting});
  EXPECT_EQ(Process(words).wait(), 0);
  return contents_of(log);
}

}  // namespace halocline::testing

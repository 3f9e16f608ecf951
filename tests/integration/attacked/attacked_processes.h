// SPDX-License-Identifier: BSD-3-Clause
// Programs as separate processes on a bus that a test attacks. Runs inside a network namespace of its own
// (scripts/isolated).
#pragma once

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "bus/messages/message_codec.h"
#include "bus/messages/messages.h"
#include "bus/transport/transport.h"
#include "tests/integration/bus_monitor.h"
#include "tests/support/process.h"

namespace halocline::testing {

using namespace std::chrono_literals;

inline const char* const kAttackedScenario = HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml";

class AttackedProcesses : public ::testing::Test {
 protected:
  AttackedProcesses() {
    monitor_.lcm().subscribe(".*", &AttackedProcesses::on_any, this);
    for (const char* program : {"halocline-conductor", "halocline-bathymetry", "halocline-vehicle-sim",
                                "halocline-channel-server", "halocline-traffic"})
      processes_[program] = run(program);
  }
  static std::unique_ptr<Process> run(const std::string& program) {
    return std::make_unique<Process>(
        std::vector<std::string>{HALOCLINE_BIN_DIR "/" + program, kAttackedScenario});
  }
  Process& at(const std::string& program) { return *processes_.at(program); }

  bool outcomes_come(std::size_t count) {
    const std::size_t before = monitor_.outcomes.size();
    return monitor_.wait_until([&] { return monitor_.outcomes.size() >= before + count; });
  }
  bool status_shows(const std::string& node, const std::function<bool(const node_status_t&)>& what) {
    return monitor_.wait_until([&] {
      const auto status = monitor_.last_status.find(node);
      return status != monitor_.last_status.end() && what(status->second);
    });
  }
  void expect_all_running() {
    for (const auto& [program, process] : processes_)
      EXPECT_TRUE(process->running()) << program << process->output();
  }
  // They end, with less than a second of work: a busy machine may let them wait for it.
  void expect_all_obey_sigterm() {
    std::map<std::string, double> before_s;
    for (const auto& [program, process] : processes_) before_s[program] = process->processor_s();
    for (const auto& [program, process] : processes_) process->signal(SIGTERM);
    for (const auto& [program, process] : processes_) {
      EXPECT_EQ(process->wait(), 0) << program << process->output();
      EXPECT_LT(process->processor_s() - before_s[program], 1) << program;
    }
  }
  template <class Message>
  void publish(const std::string& channel, const Message& message) {
    const bus::Bytes bytes = bus::encoded(message);
    monitor_.lcm().publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
  }
  static sim_clock_t clock_at(std::int64_t utime, std::int64_t session) {
    sim_clock_t clock{};
    clock.utime = utime;
    clock.session = session;
    clock.clock_rate = 1;
    clock.clock_step_us = 100'000;
    return clock;
  }

  // A datagram of the bus, as lcm-logger has it.
  struct Datagram {
    std::int64_t stamp_us = 0;
    std::string channel;
    bus::Bytes bytes;
  };
  void publish(const Datagram& datagram) {
    monitor_.lcm().publish(datagram.channel, datagram.bytes.data(),
                           static_cast<unsigned>(datagram.bytes.size()));
  }
  void write_log(const std::string& path) const {
    lcm::LogFile log(path, "w");
    for (const Datagram& datagram : recorded_) {
      lcm::LogEvent event{};
      event.timestamp = datagram.stamp_us;
      event.channel = datagram.channel;
      event.datalen = static_cast<std::int32_t>(datagram.bytes.size());
      bus::Bytes bytes = datagram.bytes;
      event.data = bytes.data();
      log.writeEvent(&event);
    }
  }
  static std::unique_ptr<Process> play(const std::string& log) {
    return std::make_unique<Process>(
        std::vector<std::string>{"/usr/bin/lcm-logplayer", "--lcm-url=" + bus::effective_url(""), log});
  }
  bool time_passes(double seconds) {
    const std::int64_t end = latest_clock_utime_ + static_cast<std::int64_t>(seconds * 1e6);
    return monitor_.wait_until([&] { return latest_clock_utime_ >= end; });
  }
  // Every packet of the two senders from its first accepted one has one outcome, none is left out; copies of
  // a message count once. Returns how many there are.
  std::size_t expect_outcomes_whole(const std::set<std::int64_t>& foreign_sessions = {}) {
    std::map<std::pair<std::int64_t, std::int64_t>, packet_outcome_t> by_number;
    for (const packet_outcome_t& outcome : monitor_.outcomes) {
      if (!foreign_sessions.contains(outcome.session))
        by_number.emplace(std::pair(outcome.session, outcome.sequence), outcome);
    }
    std::map<std::int64_t, std::vector<std::int64_t>> packets;  // by the sender's session
    for (const auto& [number, outcome] : by_number) {
      packets[outcome.send_session].push_back(outcome.packet_sequence);
      EXPECT_NE(outcome.outcome, packet_outcome_t::RECEIVER_GONE) << outcome.utime;
    }
    EXPECT_EQ(packets.size(), 2u);
    for (auto& [session, sequences] : packets) {
      EXPECT_FALSE(foreign_sessions.contains(session));
      std::ranges::sort(sequences);
      for (std::size_t i = 0; i < sequences.size(); ++i)
        EXPECT_EQ(sequences[i], sequences.front() + static_cast<std::int64_t>(i)) << session;
    }
    return by_number.size();
  }
  // The vehicles' time is that of CLOCK, to some seconds: a busy machine may take them.
  bool vehicles_keep_time() const { return latest_clock_utime_ - last_state_.utime < 5'000'000; }

  BusMonitor monitor_;
  std::vector<Datagram> recorded_;
  bool records_ = false;
  std::int64_t latest_clock_utime_ = 0;
  std::map<std::string, Datagram> first_of_;  // by channel
  std::set<std::int64_t> sessions_;           // those of all OUTCOMEs and SENDs so far
  std::map<std::string, std::unique_ptr<Process>> processes_;
  std::int64_t clock_session_ = 0;  // of the last CLOCK
  vehicle_state_t last_state_{};    // STATE.alpha

 private:
  void on_any(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    const std::span bytes(static_cast<const std::uint8_t*>(buffer->data), buffer->data_size);
    const Datagram datagram{buffer->recv_utime, channel, {bytes.begin(), bytes.end()}};
    first_of_.emplace(channel, datagram);
    if (records_) recorded_.push_back(datagram);
    modem_send_t send;
    packet_outcome_t outcome;
    if (bus::decode(bytes, send).empty()) sessions_.insert(send.session);
    if (bus::decode(bytes, outcome).empty()) sessions_.insert(outcome.session);
    if (channel == "CLOCK") {
      sim_clock_t clock;
      if (bus::decode(bytes, clock).empty()) clock_session_ = clock.session;
      if (clock.utime < latest_clock_utime_ + 60'000'000)  // not made up
        latest_clock_utime_ = std::max(latest_clock_utime_, clock.utime);
    } else if (channel == "STATE.alpha") {
      vehicle_state_t state;
      if (bus::decode(bytes, state).empty() && state.utime >= last_state_.utime) last_state_ = state;
    }
  }
};

}  // namespace halocline::testing

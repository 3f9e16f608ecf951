// SPDX-License-Identifier: BSD-3-Clause
// A host that talks to a Micromodem as Goby's driver does: one line at a time, released by its echo, each
// written again after five seconds; a clock that the modem must show within a second; and receptions that are
// handed on when their statistics come.
//
// The formats, orders and time-outs are those of GobySoft/goby3, Micromodem driver at 00acfc02. Its clock is
// simulation time, somewhat ahead.
#pragma once

#include <cstddef>
#include <deque>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "tests/clients/modem_gateway/host.h"

namespace halocline::modem_gateway::testing {

// What the driver hands on with one CACST, or with SNTTA.
struct GobyReception {
  std::string type;  // DATA, ACK, PING, MINI, FLEXIBLE, RANGES
  int source = 0, destination = 0;
  std::vector<std::string> frames;  // hexadecimal as it came
  std::vector<int> acknowledged;    // frames from 0
  std::vector<std::string> times;   // as they came
  std::vector<double> one_way_s;    // by the fraction of the time of arrival
  std::size_t bad_frames = 0;
};

class GobyDriver {
 public:
  // Data for frames that the modem asks for, in hexadecimal.
  std::vector<std::string> data;

  GobyDriver(Host& host, int id, double ahead_s) : host_(host), id_(id), ahead_s_(ahead_s) {}

  bool is_started() const { return state_ == State::kStarted && out_.empty(); }
  int clock_settings() const { return clock_settings_; }
  int repeated() const { return repeated_; }
  int major() const { return major_; }
  std::size_t unanswered() const { return out_.size(); }
  std::vector<GobyReception> take() { return std::exchange(received_, {}); }
  int transmissions() const { return transmissions_; }

  void start(const std::vector<std::string>& settings);
  void configure(const std::string& setting) { push("CCCFG," + setting); }
  void push(const std::string& body) { out_.push_back(body); }
  // A data cycle from here, or of another that is polled.
  void cycle(int source, int destination, int rate, bool wants_ack, std::size_t frames);

  // Called ten times a second or oftener. `text`: what was read since.
  void work(double now_s, std::string& text);

 private:
  enum class State { kNew, kConfiguring, kSettingClock, kStarted };
  static constexpr double kEpoch_s = 1.8e9;

  double clock_s() const { return now_s_ + ahead_s_ + kEpoch_s; }

  // Between 50 and 100 ms after a second, for the next one.
  void set_clock();

  void write();
  void pop();

  void obey(const NmeaSentence& s);

  void release(const NmeaSentence& s, const std::string& id);

  static int number(const NmeaSentence& s, std::size_t field);

  void revise(const NmeaSentence& s);

  // Half a second is thought to pass before the answer to TMQ.
  void check_clock(const NmeaSentence& s, const std::string& id);

  void begin_data(int destination);
  void give_data(const NmeaSentence& s);

  void begin_reception(const NmeaSentence& s);
  GobyReception& begin(const NmeaSentence& s, const std::string& type, std::size_t first);
  void take_frame(const NmeaSentence& s);
  void take_flexible(const NmeaSentence& s);
  void note_ack(const NmeaSentence& s);
  void take_ranges(const NmeaSentence& s);
  // The version, then 29 fields, or these alone.
  void end_reception(const NmeaSentence& s);

  Host& host_;
  int id_;
  double ahead_s_, now_s_ = 0, written_s_ = 0, sleeps_until_s_ = 0, kept_alive_s_ = 0;
  State state_ = State::kNew;
  std::deque<std::string> out_;
  bool is_waiting_ = false, is_clock_set_ = false, is_local_cycle_ = false, wants_ack_ = false;
  int clock_settings_ = 0, repeated_ = 0, major_ = 0, transmissions_ = 0;
  int expected_reports_ = 0, expected_statistics_ = 0, acknowledger_ = 0, next_frame_ = 0;
  std::set<int> awaited_, awaits_ack_;
  GobyReception reception_;
  std::vector<GobyReception> received_;
};

}  // namespace halocline::modem_gateway::testing

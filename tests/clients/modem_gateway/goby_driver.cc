// SPDX-License-Identifier: BSD-3-Clause
#include "tests/clients/modem_gateway/goby_driver.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/micromodem/modem_clock.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway::testing {
namespace {

constexpr double kAgain_s = 5, kRest_s = 2, kSkew_s = 1;

}  // namespace

void GobyDriver::start(const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) configure(setting);
  for (const std::string setting : {"CST,1", "AGC,0"}) configure(setting);
  configure("SRC," + std::to_string(id_));
  configure("REV,1");
  configure("RXP,1");
  push(fmt::format("CCMSC,{0},{0},0", id_));
  state_ = State::kConfiguring;
}

void GobyDriver::cycle(int source, int destination, int rate, bool wants_ack, std::size_t frames) {
  is_local_cycle_ = true;
  wants_ack_ = wants_ack;
  expected_reports_ = rate == 0 && source == id_ ? 1 : 0;
  if (source == id_) begin_data(destination);
  push(fmt::format("CCCYC,0,{},{},{},{},{}", source, destination, rate, wants_ack ? 1 : 0, frames));
}

void GobyDriver::work(double now_s, std::string& text) {
  now_s_ = now_s;
  if (now_s_ < sleeps_until_s_) return;
  if (state_ == State::kConfiguring && out_.empty()) state_ = State::kSettingClock;
  if (state_ == State::kSettingClock && is_clock_set_) state_ = State::kStarted;
  if (!is_clock_set_ && state_ != State::kConfiguring && out_.empty()) set_clock();
  if (state_ == State::kStarted && now_s_ >= kept_alive_s_ + 10) {
    kept_alive_s_ = std::floor(clock_s()) - ahead_s_;
    push(major_ >= 2 ? "CCTMQ,0" : "CCCFQ,SRC");
  }
  write();
  for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
    const std::string line = text.substr(0, end - 1);
    text.erase(0, end + 1);
    const NmeaSentence sentence = nmea_sentence(line);
    EXPECT_EQ(sentence.problem, NmeaSentence::Problem::kNone) << line;
    EXPECT_EQ(sentence.id.size(), 5u) << line;
    obey(sentence);
    if (now_s_ < sleeps_until_s_) return;
  }
}

void GobyDriver::set_clock() {
  const double fraction = clock_s() - std::floor(clock_s());
  if (fraction < 0.05 || fraction > 0.1) return;
  ++clock_settings_;
  const SimTime next = SimTime::from_seconds(std::floor(clock_s()) + 1);
  const ModemClock calendar(false);
  if (major_ >= 2) return push("CCTMS," + calendar.iso(next) + ",0");
  push("CCCLK," + calendar.comma_separated(next));
  write();
  sleeps_until_s_ = now_s_ + 1;
}

void GobyDriver::write() {
  if (out_.empty() || (is_waiting_ && now_s_ < written_s_ + kAgain_s)) return;
  if (is_waiting_) ++repeated_;
  host_.write(nmea_line(out_.front()));
  is_waiting_ = true;
  written_s_ = now_s_;
}

void GobyDriver::pop() {
  out_.pop_front();
  is_waiting_ = false;
  write();
}

void GobyDriver::obey(const NmeaSentence& s) {
  const std::string id(s.id.substr(2));
  if (id == "REV") revise(s);
  if (id == "CLK" || id == "TMS" || id == "TMQ") check_clock(s, id);
  if (id == "DRQ") give_data(s);
  if (id == "CYC") begin_reception(s);
  if (id == "RXD") take_frame(s);
  if (id == "XST" && expected_reports_-- <= 0) {
    ++transmissions_;
    expected_reports_ = 0;
  }
  if (id == "MSG" && s.field(0) == "BAD_CRC" && !awaited_.empty()) {
    ++reception_.bad_frames;
    awaited_.erase(awaited_.begin());
  }
  if (id == "ACK" && number(s, 1) == id_ && number(s, 0) == acknowledger_) note_ack(s);
  if (id == "MUA") begin(s, "MINI", 0).frames.emplace_back(s.field(2));
  if (id == "MPA") begin(s, "PING", 0);
  if (id == "MPR") begin(s, "PING", 0).times.emplace_back(s.field(2));
  if (id == "RDP") take_flexible(s);
  if (id == "TTA") take_ranges(s);
  if (id == "CST") end_reception(s);
  release(s, id);
}

void GobyDriver::release(const NmeaSentence& s, const std::string& id) {
  if (out_.empty()) return;
  const std::string line = "$" + out_.front();
  const NmeaSentence waiting = nmea_sentence(line);
  const std::string_view name = waiting.id.substr(2);
  const bool is_it = name == "CFG"   ? s.fields.size() == 2 && s.all_fields() == waiting.all_fields()
                     : name == "CFQ" ? id == "CFG"
                     : name == "MSC" ? id == "REV" || id == "MSC"
                                     : id == name;
  const bool is_refused = id == "ERR" && s.field(1) == "NMEA";
  EXPECT_FALSE(is_refused) << out_.front();
  if (is_it) pop();
}

int GobyDriver::number(const NmeaSentence& s, std::size_t field) {
  const auto value = integer_in(s.field(field), -1'000'000'000, 1'000'000'000);
  EXPECT_TRUE(value) << s.id << s.all_fields();
  return static_cast<int>(value.value_or(-1));
}

void GobyDriver::revise(const NmeaSentence& s) {
  if (s.field(1) == "INIT") {
    sleeps_until_s_ = now_s_ + kRest_s;
    is_clock_set_ = false;
  }
  if (s.field(1) != "AUV") return;
  const auto parts = fields_of(s.field(2), '.');
  EXPECT_TRUE(parts.size() == 3 || parts.size() == 4);
  major_ = static_cast<int>(integer_in(parts[0], 0, 100).value_or(-1));
}

void GobyDriver::check_clock(const NmeaSentence& s, const std::string& id) {
  if (out_.empty() || out_.front().substr(2, 3) != id) return;
  const auto shown = id == "CLK" ? calendar_seconds(number(s, 0), number(s, 1), number(s, 2), number(s, 3),
                                                    number(s, 4), number(s, 5))
                                 : calendar_seconds(s.field(id == "TMS" ? 1 : 0));
  ASSERT_TRUE(shown) << s.all_fields();
  const double shown_s = static_cast<double>(*shown) + (id == "TMQ" ? 0.5 : 0);
  is_clock_set_ = std::abs(shown_s - clock_s()) < kSkew_s;
}

void GobyDriver::begin_data(int destination) {
  awaits_ack_.clear();
  acknowledger_ = destination;
  next_frame_ = 0;
}

void GobyDriver::give_data(const NmeaSentence& s) {
  const auto frame = static_cast<std::size_t>(number(s, 5) - 1);
  std::string hex = frame < data.size() ? data[frame] : "";
  // Filled up with zeros.
  if (!hex.empty()) hex.resize(2 * static_cast<std::size_t>(number(s, 4)), '0');
  if (!hex.empty() && wants_ack_) awaits_ack_.insert(next_frame_++);
  push(fmt::format("CCTXD,{},{},{},{}", s.field(1), s.field(2), s.field(3), hex));
}

void GobyDriver::begin_reception(const NmeaSentence& s) {
  if (number(s, 1) == id_) {
    // Another polls this one.
    if (!std::exchange(is_local_cycle_, false)) begin_data(number(s, 2));
    return;
  }
  const bool is_echo = is_local_cycle_ && number(s, 3) != 0;
  expected_statistics_ = number(s, 3) == 0 && !is_local_cycle_ ? 1 : 0;
  is_local_cycle_ = false;
  if (is_echo) return;
  awaited_.clear();
  for (int i = 0; i < number(s, 5); ++i) awaited_.insert(i);
}

GobyReception& GobyDriver::begin(const NmeaSentence& s, const std::string& type, std::size_t first) {
  reception_.type = type;
  reception_.source = number(s, first);
  reception_.destination = number(s, first + 1);
  return reception_;
}

void GobyDriver::take_frame(const NmeaSentence& s) {
  begin(s, "DATA", 0).frames.emplace_back(s.field(4));
  awaited_.erase(number(s, 3) - 1);
}

void GobyDriver::take_flexible(const NmeaSentence& s) {
  begin(s, "FLEXIBLE", 0);
  EXPECT_EQ(s.fields.size(), 7u);
  const auto triplets = fields_of(s.field(6), ';');
  std::string hex;
  for (std::size_t i = 0; i + 2 < triplets.size(); i += 3) {
    if (triplets[i] != "1") ++reception_.bad_frames;
    hex += triplets[i + 2];
  }
  reception_.frames.push_back(hex);
}

void GobyDriver::note_ack(const NmeaSentence& s) {
  const int frame = number(s, 2) - 1;
  if (awaits_ack_.erase(frame) == 0) return;
  begin(s, "ACK", 0).acknowledged.push_back(frame);
}

void GobyDriver::take_ranges(const NmeaSentence& s) {
  GobyReception ranges;
  ranges.type = "RANGES";
  ranges.source = id_;
  for (std::size_t i = 0; i < 4; ++i) ranges.times.emplace_back(s.field(i));
  EXPECT_EQ(s.field(4).size(), 9u) << "hhmmss.ss";
  received_.push_back(ranges);
}

void GobyDriver::end_reception(const NmeaSentence& s) {
  const std::size_t shift = number(s, 0) == 6 ? 1 : 0;
  EXPECT_EQ(s.fields.size(), 29 + shift);
  const std::string time(s.field(1 + shift));
  const int mode = number(s, 2 + shift);
  const bool is_synchronised = major_ >= 2 ? mode >> 2 == 3 : mode >= 2;
  if (is_synchronised)
    reception_.one_way_s.push_back(number_in("0" + time.substr(time.find('.')), 0, 1).value_or(-1));
  if (expected_statistics_ > 0) {
    --expected_statistics_;
    return;
  }
  received_.push_back(std::exchange(reception_, {}));
}

}  // namespace halocline::modem_gateway::testing

// SPDX-License-Identifier: BSD-3-Clause
// Vehicle with a modem that uses LCM and the message types alone. It circles, announces its modem, sends
// packets, and prints their outcomes and what it receives. By hand from the root of the tree:
//
//   $ mkdir -p build/mine && lcm-gen --cpp --cpp-std c++11 --cpp-hpath build/mine lcmtypes/*.lcm
//   $ g++ -std=c++17 -I build/mine clients/examples/cpp/foreign_vehicle.cc -llcm -o build/mine/vehicle_cpp
//   $ ./scripts/join build/mine/vehicle_cpp --name visitor --id 77 --to 1
#include <chrono>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include <lcm/lcm-cpp.hpp>

#include <halocline/modem_config_t.hpp>
#include <halocline/modem_receipt_t.hpp>
#include <halocline/modem_receive_t.hpp>
#include <halocline/modem_send_t.hpp>
#include <halocline/packet_outcome_t.hpp>
#include <halocline/sim_clock_t.hpp>
#include <halocline/vehicle_state_t.hpp>

namespace halocline {
namespace {
constexpr const char* kUsage =
    "usage: [--name N] [--id N] [--to ID] [--north M] [--depth M] [--every S] [--family F] [--center-hz F]\n";
struct Options {
  std::string name = "visitor", family = "generic";
  std::map<std::string, double> numbers{{"--id", 77},    {"--to", 0},     {"--north", 0},
                                        {"--depth", 50}, {"--every", 10}, {"--center-hz", 25000}};
};
constexpr double kRadiusM = 100, kSpeedMps = 1.5, kRepeatS = 0.5;
constexpr const char* kOutcomes[] = {  // indexed by the number in packet_outcome_t
    "received",     "below cutoff", "receiver gone", "shadow",       "blocked",
    "out of band",  "collided",     "half duplex",   "doppler",      "bit errors",
    "not acquired", "foreign",      "too weak",      "too steep",    "out of reach",
    "asleep",       "extra loss",   "no power",      "out of water", "no terrain"};
constexpr std::int64_t kStatePeriodUs = 100'000, kModemPeriodUs = 10'000'000;

double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Returns false for a message that cannot be decoded; an invalid count makes decode() throw.
template <class Message>
bool decode(const lcm::ReceiveBuffer* buffer, Message& message) {
  try {
    return message.decode(buffer->data, 0, static_cast<int>(buffer->data_size)) >= 0;
  } catch (const std::exception&) {
    return false;
  }
}

// Returns true once in each `period`, and after time has jumped.
bool due(std::int64_t now, std::int64_t period, std::int64_t& next) {
  if (period == 0 || (now < next && next - now <= period)) return false;
  next = (next > 0 && std::abs(now - next) < period ? next : now) + period;
  return true;
}

class Vehicle {
 public:
  Vehicle(lcm::LCM& lcm, const Options& options) : lcm_(lcm), options_(options) {
    if (!lcm_.good()) return;
    lcm_.subscribe("CLOCK|OUTCOME|(RECEIPT|RECEIVE)\\." + options_.name, &Vehicle::on_message, this)
        ->setQueueCapacity(0);
  }

  // Does what is due. Simulation time is that of the last CLOCK, extrapolated by the wall clock at its rate.
  void step() {
    if (clock_s_ == 0 && ++idle_steps_ == 300)  // 300 steps of 10 ms
      std::cerr << "no CLOCK for 3 s: start this by ./scripts/join" << std::endl;
    if (clock_s_ == 0) return;
    const std::int64_t now = clock_.utime + std::llround((wall_s() - clock_s_) * clock_.clock_rate * 1e6);
    if (due(now, kStatePeriodUs, next_state_)) publish_state(now);
    if (due(now, kModemPeriodUs, next_modem_)) publish_modem(now);
    if (!pending_ && states_ > 10 && due(now, std::llround(number("--every") * 1e6), next_packet_))
      prepare_packet(now);
    if (pending_ && wall_s() - sent_s_ > kRepeatS) {
      lcm_.publish("SEND." + options_.name, &*pending_);  // unchanged until its RECEIPT: transmitted once
      sent_s_ = wall_s();
    }
  }

 private:
  double number(const std::string& option) const { return options_.numbers.at(option); }
  std::int32_t id() const { return static_cast<std::int32_t>(number("--id")); }

  void publish_state(std::int64_t now) {
    const double rate = kSpeedMps / kRadiusM, pi = std::acos(-1.0);  // clockwise: angle = speed / radius * t
    const double angle = std::remainder(now * 1e-6 * rate, 2 * pi), heading = angle + pi / 2;
    const vehicle_state_t state{
        now,
        session_,
        states_++,
        id(),
        {number("--north") + kRadiusM * std::cos(angle), kRadiusM * std::sin(angle), number("--depth")},
        {std::cos(heading / 2), 0, 0, std::sin(heading / 2)},
        {kSpeedMps * std::cos(heading), kSpeedMps * std::sin(heading), 0},
        {0, 0, rate}};  // in the order of vehicle_state_t.lcm
    lcm_.publish("STATE." + options_.name, &state);
  }

  void publish_modem(std::int64_t now) {
    modem_config_t modem{};
    modem.utime = now;
    modem.family = options_.family;
    modem.modem_profile = "generic";
    modem.source_level_db = 185;
    modem.center_frequency_hz = number("--center-hz");
    modem.bandwidth_hz = 5000;
    modem.bit_rate_bps = 640;
    modem.packet_overhead_s = 0.1;
    modem.max_payload_bytes = 256;
    modem.guard_time_s = 0.02;
    modem.doppler_tolerance = modem.doppler_correction = 0.1;
    modem.error_model = modem_config_t::ERRORS_JANUS;
    lcm_.publish("MODEM." + options_.name, &modem);
  }

  void prepare_packet(std::int64_t now) {
    const std::string text = "hello " + std::to_string(packets_) + " from " + options_.name;
    sent_s_ = 0;
    pending_ = modem_send_t{};
    pending_->utime = now;
    pending_->session = session_;
    pending_->packet_sequence = packets_++;
    pending_->source_id = id();
    pending_->destination_id = static_cast<std::int32_t>(number("--to"));
    pending_->stamped = 1;
    pending_->payload_size = static_cast<std::int32_t>(text.size());
    pending_->payload.assign(text.begin(), text.end());
  }

  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    if (channel == "CLOCK") {
      if (decode(buffer, clock_)) clock_s_ = wall_s();
    } else if (packet_outcome_t outcome; channel == "OUTCOME") {
      if (!decode(buffer, outcome) || outcome.send_session != session_ || outcome.source_id != id()) return;
      const auto number = static_cast<std::size_t>(outcome.outcome);
      print(outcome.utime) << "packet " << outcome.packet_sequence << " at vehicle " << outcome.receiver_id
                           << ": " << (number < std::size(kOutcomes) ? kOutcomes[number] : "?") << std::endl;
    } else if (modem_receipt_t receipt; channel == "RECEIPT." + options_.name) {
      if (!decode(buffer, receipt) || receipt.send_session != session_) return;
      if (pending_ && receipt.packet_sequence == pending_->packet_sequence) pending_.reset();
      print(receipt.utime) << "packet " << receipt.packet_sequence
                           << (receipt.start_utime != 0 ? " accepted" : " refused") << ", receipt "
                           << +receipt.receipt_result << ", " << receipt.duration_s << " s long" << std::endl;
    } else if (modem_receive_t packet; decode(buffer, packet)) {
      std::string text(packet.payload.begin(), packet.payload.end());
      for (char& c : text) c = c < 32 || c == 127 ? '.' : c;
      print(packet.utime) << "from vehicle " << packet.source_id << ", " << packet.snr_db
                          << " dB SNR: " << text << std::endl;
    }
  }
  static std::ostream& print(std::int64_t utime) { return std::cout << utime * 1e-6 << " s: "; }

  lcm::LCM& lcm_;
  Options options_;
  std::int64_t session_ = std::random_device()() + 1LL;  // differs at each start
  std::int64_t states_ = 0, packets_ = 0, next_state_ = 0, next_modem_ = 0, next_packet_ = 0;
  sim_clock_t clock_{};
  std::optional<modem_send_t> pending_;  // waits for its RECEIPT
  double clock_s_ = 0, sent_s_ = 0;      // times of the wall clock
  int idle_steps_ = 0;
};

}  // namespace
}  // namespace halocline

int main(int argc, char** argv) {
  halocline::Options options;
  try {
    for (int i = 1; i < argc; i += 2) {
      const std::string option = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
      if (option == "--name" || option == "--family") {
        (option == "--name" ? options.name : options.family) = value;
      } else {
        options.numbers.at(option) = std::stod(value);
      }
    }
  } catch (const std::logic_error&) {  // no such option, or no number
    std::cerr << halocline::kUsage;
    return 2;
  }
  std::cout << std::fixed << std::setprecision(3);
  lcm::LCM lcm;
  halocline::Vehicle vehicle(lcm, options);
  while (lcm.good() && lcm.handleTimeout(10) >= 0) vehicle.step();
  std::cerr << "LCM cannot be opened, or cannot receive: see LCM_DEFAULT_URL\n";
  return 69;
}

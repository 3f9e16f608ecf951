// A vehicle of your own: all it takes to swim with Halocline is LCM and the types in lcmtypes/.
//
// Publishes its pose ten times a second (that alone makes it a vehicle), sends a packet now and then, and
// prints what the water brings it. It swims a circle. No Halocline library is used; build it by hand with
//   lcm-gen --cpp ../../lcmtypes/*.lcm && g++ -std=c++17 -I. foreign_vehicle.cc -llcm -o foreign-vehicle
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include <lcm/lcm-cpp.hpp>

#include <halocline/modem_receipt_t.hpp>
#include <halocline/modem_receive_t.hpp>
#include <halocline/modem_send_t.hpp>
#include <halocline/sim_clock_t.hpp>
#include <halocline/vehicle_state_t.hpp>

namespace {

constexpr const char* kUsage =
    "usage: foreign-vehicle [--name NAME] [--id ID] [--north M] [--east M] [--depth M] [--radius M] [--speed "
    "MPS]\n"
    "                       [--every S] [--to ID] [--lcm-url URL]\n"
    "Swims a circle of --radius (m, default 100) at --speed (m/s, default 1.5) around --north, --east at "
    "--depth\n"
    "(m, default 0 0 50), and sends a packet every --every seconds (default 10; 0 never) to vehicle --to "
    "(default\n"
    "0: all). Ends on SIGINT or SIGTERM. Exit code 0, or 1 when LCM cannot be opened, 2 for a wrong command "
    "line.\n"
    "Example: foreign-vehicle --name visitor --id 77 --depth 60 --every 5\n";

struct Settings {
  std::string name = "visitor", lcm_url;
  std::int32_t id = 77, to = 0;
  double north_m = 0, east_m = 0, depth_m = 50, radius_m = 100, speed_mps = 1.5, every_s = 10;
};

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int) { stop_requested = 1; }

double wall_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr double kSilenceS = 3;

void report_silence(const char* what) {
  std::fprintf(
      stderr,
      "foreign-vehicle: %s for %.0f s: the run is on another bus, or none is running. LCM_DEFAULT_URL and\n"
      "--lcm-url choose the bus; ./scripts/join foreign-vehicle joins that of ./scripts/run --distributed.\n",
      what, kSilenceS);
}

// Simulation time: the conductor's CLOCK, extrapolated by the wall clock at its rate; the wall clock's
// Unix time where there is no conductor.
class Clock {
 public:
  void on_clock(const lcm::ReceiveBuffer*, const std::string&, const halocline::sim_clock_t* clock) {
    received_s_ = wall_s();
    utime_ = clock->utime;
    rate_ = clock->clock_rate;
    known_ = true;
  }
  bool known() const { return known_; }
  std::int64_t utime() const {
    return utime_ + static_cast<std::int64_t>((wall_s() - received_s_) * rate_ * 1e6);
  }
  void use_wall_time() {
    const auto unix_time = std::chrono::system_clock::now().time_since_epoch();
    utime_ = std::chrono::duration_cast<std::chrono::microseconds>(unix_time).count();
    received_s_ = wall_s();
    rate_ = 1;
    known_ = true;
  }

 private:
  std::int64_t utime_ = 0;
  double received_s_ = 0, rate_ = 1;
  bool known_ = false;
};

class Vehicle {
 public:
  Vehicle(lcm::LCM& lcm, const Settings& settings, std::int64_t session)
      : lcm_(lcm), settings_(settings), session_(session) {
    lcm_.subscribe("RECEIVE\\." + settings_.name, &Vehicle::on_packet, this);
    lcm_.subscribe("RECEIPT\\." + settings_.name, &Vehicle::on_receipt, this);
  }

  // A circle, clockwise: angle = speed / radius * t.
  void publish_state(std::int64_t utime) {
    const double rate = settings_.speed_mps / settings_.radius_m;
    const double angle = std::remainder(static_cast<double>(utime) * 1e-6 * rate, 2 * std::acos(-1.0));
    const double heading = angle + std::acos(-1.0) / 2;
    halocline::vehicle_state_t state{};
    state.utime = utime;
    state.session = session_;
    state.sequence = states_++;
    state.vehicle_id = settings_.id;
    state.position_ned_m[0] = settings_.north_m + settings_.radius_m * std::cos(angle);
    state.position_ned_m[1] = settings_.east_m + settings_.radius_m * std::sin(angle);
    state.position_ned_m[2] = settings_.depth_m;
    state.orientation_wxyz[0] = std::cos(heading / 2);
    state.orientation_wxyz[3] = std::sin(heading / 2);
    state.velocity_ned_mps[0] = settings_.speed_mps * std::cos(heading);
    state.velocity_ned_mps[1] = settings_.speed_mps * std::sin(heading);
    state.angular_velocity_body_radps[2] = rate;
    lcm_.publish("STATE." + settings_.name, &state);
  }

  void send(std::int64_t utime) {
    const std::string text = "hello " + std::to_string(packets_) + " from " + settings_.name;
    halocline::modem_send_t packet{};
    packet.utime = utime;
    packet.session = session_;
    packet.packet_sequence = packets_++;
    packet.source_id = settings_.id;
    packet.destination_id = settings_.to;
    packet.stamped = 1;
    packet.payload_size = static_cast<std::int32_t>(text.size());
    packet.payload.assign(text.begin(), text.end());
    lcm_.publish("SEND." + settings_.name, &packet);
    if (unanswered_since_s_ == 0) unanswered_since_s_ = wall_s();
  }

  // States once that nobody answers.
  void watch_silence() {
    if (reported_ || unanswered_since_s_ == 0 || wall_s() - unanswered_since_s_ < kSilenceS) return;
    reported_ = true;
    report_silence("no RECEIPT of my packets");
  }

 private:
  void on_packet(const lcm::ReceiveBuffer*, const std::string&, const halocline::modem_receive_t* packet) {
    std::string text;
    for (const unsigned char c : packet->payload) text += c >= 32 && c < 127 ? static_cast<char>(c) : '.';
    char travel[48] = "";
    if (packet->stamped != 0) std::snprintf(travel, sizeof travel, " after %.3f s", packet->travel_time_s);
    std::printf("%.3f s: packet %lld from vehicle %d%s, %.1f dB: %s\n",
                static_cast<double>(packet->utime) * 1e-6, static_cast<long long>(packet->packet_sequence),
                packet->source_id, travel, packet->received_level_db, text.c_str());
    std::fflush(stdout);
  }
  // LCM takes no const handler. NOLINTNEXTLINE(readability-make-member-function-const)
  void on_receipt(const lcm::ReceiveBuffer*, const std::string&, const halocline::modem_receipt_t* receipt) {
    if (receipt->send_session != session_) return;
    unanswered_since_s_ = 0;
    const bool accepted = receipt->receipt_result == halocline::modem_receipt_t::ACCEPTED ||
                          receipt->receipt_result == halocline::modem_receipt_t::QUEUED;
    std::printf(
        "%.3f s: my packet %lld was %s\n", static_cast<double>(receipt->utime) * 1e-6,
        static_cast<long long>(receipt->packet_sequence),
        accepted ? "accepted" : ("refused, reason " + std::to_string(receipt->receipt_result)).c_str());
    std::fflush(stdout);
  }

  lcm::LCM& lcm_;
  Settings settings_;
  std::int64_t session_, states_ = 0, packets_ = 0;
  double unanswered_since_s_ = 0;  // 0: nothing is unanswered
  bool reported_ = false;
};

bool set(Settings& s, const std::string& option, const char* value) {
  if (option == "--name") return s.name = value, true;
  if (option == "--lcm-url") return s.lcm_url = value, true;
  char* end = nullptr;
  const double number = std::strtod(value, &end);
  if (end == value || *end != '\0' || !std::isfinite(number)) return false;
  if (option == "--id") return s.id = static_cast<std::int32_t>(number), s.id >= 1;
  if (option == "--to") return s.to = static_cast<std::int32_t>(number), s.to >= 0;
  if (option == "--north") return s.north_m = number, true;
  if (option == "--east") return s.east_m = number, true;
  if (option == "--depth") return s.depth_m = number, true;
  if (option == "--radius") return s.radius_m = number, number > 0;
  if (option == "--speed") return s.speed_mps = number, true;
  if (option == "--every") return s.every_s = number, number >= 0;
  return false;
}

// 0: go on; otherwise the exit code plus 1.
int parse(int argc, char** argv, Settings& settings) {
  for (int i = 1; i < argc; i += 2) {
    if (std::strcmp(argv[i], "--help") == 0) return std::fputs(kUsage, stdout), 1;
    if (i + 1 == argc || !set(settings, argv[i], argv[i + 1])) {
      std::fprintf(stderr, "foreign-vehicle: %s: unknown, or its value is impossible\n%s", argv[i], kUsage);
      return 3;
    }
  }
  return 0;
}

void swim(lcm::LCM& lcm, const Settings& settings) {
  constexpr std::int64_t kStatePeriodUs = 100'000;
  std::random_device random;
  Vehicle vehicle(lcm, settings, static_cast<std::int64_t>(random()) + 1);
  Clock clock;
  lcm.subscribe("CLOCK", &Clock::on_clock, &clock);
  const double started_s = wall_s();
  const auto every_us = static_cast<std::int64_t>(settings.every_s * 1e6);
  std::int64_t next_state = 0, next_send = 0;
  while (stop_requested == 0) {
    lcm.handleTimeout(10);
    if (!clock.known() && wall_s() - started_s > kSilenceS) {
      report_silence("no CLOCK");
      clock.use_wall_time();
    }
    if (!clock.known()) continue;
    vehicle.watch_silence();
    const std::int64_t now = clock.utime();
    if (next_send == 0) next_send = now + every_us;
    if (now >= next_state || next_state - now > kStatePeriodUs) {  // the second: time jumped back
      vehicle.publish_state(now);
      next_state = now - now % kStatePeriodUs + kStatePeriodUs;
    }
    if (every_us > 0 && (now >= next_send || next_send - now > every_us)) {
      vehicle.send(now);
      next_send = now + every_us;
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  if (const int verdict = parse(argc, argv, settings)) return verdict - 1;
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  if (settings.lcm_url.empty()) {
    settings.lcm_url = from_environment != nullptr ? from_environment : "udpm://239.255.76.67:7667?ttl=0";
  }
  lcm::LCM lcm(settings.lcm_url);
  if (!lcm.good())
    return std::fprintf(stderr, "foreign-vehicle: LCM cannot open %s\n", settings.lcm_url.c_str()), 1;
  swim(lcm, settings);
  return 0;
}

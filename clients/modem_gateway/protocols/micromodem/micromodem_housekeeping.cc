// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/micromodem/micromodem_housekeeping.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_settings.h"
#include "clients/modem_gateway/protocols/micromodem/modem_clock.h"

namespace halocline::modem_gateway {
namespace {

constexpr SimDuration kRevisionPeriod = SimDuration::from_milliseconds(5000);
constexpr SimDuration kRebootTime = SimDuration::from_milliseconds(300);
constexpr int kNoiseValues = 14;
constexpr std::size_t kMaxSettings = 1000;
// Commands for test sounds, which are not packets, so that the simulated medium cannot carry them.
constexpr std::array<std::string_view, 3> kSounds{"CCSWP", "CCMSQ", "CCRSP"};
// Command levels of the generations, numbered as in pyacomms: CCTMS and CCTMQ are known from level 11 on.
constexpr int kFirstLevel = 1, kSecondLevel = 11;

}  // namespace

bool MicromodemHousekeeping::obey(ClientId client, const NmeaSentence& sentence) {
  const std::string_view id = sentence.id;
  if (id == "CCCFG")
    configure(client, sentence);
  else if (id == "CCCFQ")
    query(client, sentence);
  else if (id == "CCCLK")
    set_clock(client, sentence);
  else if (id == "CCTMS")
    set_time(client, sentence);
  else if (id == "CCTMQ")
    query_time(client);
  else if (id == "CCCLQ")
    core_.say(client, "CACLQ," + core_.clock().comma_separated(core_.reading()));
  else if (id == "CCALQ")
    query_level(client);
  else if (id == "CCCFR")
    query_noise(client, sentence);
  else if (std::find(kSounds.begin(), kSounds.end(), id) != kSounds.end())
    core_.refuse(client, NmeaError::kUnknown, "no sound of " + std::string(id) + " is simulated");
  else
    return false;
  return true;
}

void MicromodemHousekeeping::configure(ClientId client, const NmeaSentence& sentence) {
  const std::string_view name = sentence.field(0), value = sentence.field(1);
  MicromodemSettings& settings = core_.settings();
  const bool has_room = settings.all().size() < kMaxSettings || settings.all().contains(name);
  if (name.empty() || sentence.fields.size() != 2 || !has_room)
    return core_.refuse_argument(client, sentence);
  if (name == "SRC") {
    const auto address = integer_in(value, 0, MicromodemCore::kHighestAddress);
    if (!address) return core_.refuse_argument(client, sentence);
    core_.take_address(static_cast<std::int32_t>(*address));
  }
  if (name == "ALL")
    core_.reset_settings();
  else
    settings.set(name, value);
  core_.note_stored();
  if (name == "REV") next_revision_ = core_.now() + kRevisionPeriod;
  core_.echo(client, sentence);
}

void MicromodemHousekeeping::query(ClientId client, const NmeaSentence& sentence) const {
  const std::string_view name = sentence.field(0);
  if (name.empty()) return core_.refuse_argument(client, sentence);
  const MicromodemSettings& settings = core_.settings();
  const auto answer = [&](std::string_view key) {
    const std::string value = key == "SRC"                     ? std::to_string(core_.own_address())
                              : key == "info.firmware_version" ? core_.revision()
                                                               : settings.value(key);
    core_.say(client, fmt::format("CACFG,{},{}", key, value));
  };
  if (name != "ALL" && name != "TOP") return answer(name);
  for (const auto& [key, value] : settings.all()) answer(key);
  if (!settings.all().contains("SRC")) answer("SRC");
}

void MicromodemHousekeeping::sleep(std::int64_t minutes) {
  const SimTime wakes = core_.now() + SimDuration::from_milliseconds(60'000) * minutes;
  if (minutes > 0 || is_asleep_) core_.port().sleep_until(wakes);
  is_asleep_ = minutes > 0;
  reboots_ = wakes + kRebootTime;
}

void MicromodemHousekeeping::set_clock(ClientId client, const NmeaSentence& sentence) {
  const auto n = sentence.numbers<6>();
  const auto time = n ? calendar_seconds((*n)[0], (*n)[1], (*n)[2], (*n)[3], (*n)[4], (*n)[5]) : std::nullopt;
  if (!time) return core_.refuse_argument(client, sentence);
  core_.clock().set(core_.reading(), *time);
  core_.note_stored();
  // The answer shows the time as of the next pulse, because hosts compare it with their own clock a second
  // later.
  core_.say(client, "CACLK," + ModemClock::comma_separated_of(*time));
}

void MicromodemHousekeeping::query_level(ClientId client) const {
  core_.say(client, fmt::format("CAALQ,AUV,{}", core_.is_second_generation() ? kSecondLevel : kFirstLevel));
}

void MicromodemHousekeeping::set_time(ClientId client, const NmeaSentence& sentence) {
  const auto time = calendar_seconds(sentence.field(0));
  if (!time) return core_.refuse_argument(client, sentence);
  core_.clock().set(core_.reading(), *time);
  core_.note_stored();
  core_.say(client, "CATMS,0," + std::string(sentence.field(0)));
}

void MicromodemHousekeeping::query_time(ClientId client) const {
  const ModemClock& clock = core_.clock();
  core_.say(client, fmt::format("CATMQ,{},{},{}", clock.iso(core_.reading()),
                                clock.is_set() ? "USER" : "NONE", clock.has_pps() ? "EXT" : "NONE"));
}

// Handles CCCFR,ms: reports the noise after that delay. All values are those of the modem's one band.
void MicromodemHousekeeping::query_noise(ClientId client, const NmeaSentence& sentence) {
  const auto wait = sentence.numbers<1>();
  if (!wait) return core_.refuse_argument(client, sentence);
  core_.echo(client, sentence);
  noise_due_ = core_.now() + SimDuration::from_milliseconds(wait->front());
}

void MicromodemHousekeeping::report_noise() {
  noise_due_ = SimTime::never();
  std::string body = "SNCFR";
  for (int i = 0; i < kNoiseValues; ++i) body += fmt::format(",{:.0f}", last_noise_db_);
  core_.say_all(body);
}

void MicromodemHousekeeping::say_revision(const char* who) const {
  core_.say_all(fmt::format("CAREV,{},{},{}", core_.clock().hhmmss(core_.reading()), who, core_.revision()));
}

SimTime MicromodemHousekeeping::next() const {
  const SimTime revision = core_.settings().is_on("REV") ? next_revision_ : SimTime::never();
  return std::min({revision, reboots_, noise_due_});
}

void MicromodemHousekeeping::step() {
  const SimTime now = core_.now();
  if (now >= reboots_) {
    reboots_ = SimTime::never();
    is_asleep_ = false;
    say_revision("INIT");
    say_revision("AUV");
  }
  if (core_.settings().is_on("REV") && now >= next_revision_) {
    next_revision_ = now + kRevisionPeriod;
    say_revision("AUV");
  }
  if (now >= noise_due_) report_noise();
}

}  // namespace halocline::modem_gateway

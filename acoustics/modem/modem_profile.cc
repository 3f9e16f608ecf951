#include "acoustics/modem/modem_profile.h"

#include <algorithm>

#include "core/check.h"

namespace halocline::acoustics {
namespace {

// Letters and numbers in brackets are those of the header.
constexpr double kSourceLevelDb = 185;                                         // [a]
constexpr double kCutoffDb = 45;                                               // [b]
constexpr SimDuration kHalfChip = SimDuration::from_microseconds(3'125);       // [5]
constexpr double kFiveMetresASecond = 5.0 / 1500;                              // [6], [i]
constexpr SimDuration kProbe = SimDuration::from_milliseconds(100);            // [c]
constexpr SimDuration kProbeAndSilence = SimDuration::from_milliseconds(300);  // [3]

struct PskRate {
  int number;
  std::int32_t frame_bytes, max_frames;
  double bit_rate_bps;
  ErrorModel error_model;
};

constexpr std::array kRates = {
    PskRate{1, 64, 3, 250, ErrorModel::kBpsk},
    PskRate{2, 64, 3, 500, ErrorModel::kBpsk},
    PskRate{4, 256, 2, 1300, ErrorModel::kBpskBch64},
    PskRate{5, 256, 8, 5300, ErrorModel::kBpskHamming14},
};

Modem real_modem(ModemProfile profile, double centre_frequency_hz, double bandwidth_hz) {
  Modem modem = generic_modem({kSourceLevelDb}, {kCutoffDb}, centre_frequency_hz, bandwidth_hz);
  modem.profile = profile;
  modem.doppler_tolerance = kFiveMetresASecond;
  return modem;
}

Modem janus() {
  Modem modem = real_modem(ModemProfile::kJanus, 11'520, 4'160);
  modem.bit_rate_bps = 80;
  modem.preamble = SimDuration::from_milliseconds(200);
  modem.preamble_pieces = 32;
  modem.packet_overhead = modem.preamble;
  modem.layout = {.header_bits = 64, .tail_bits = 8, .max_bytes = 4096};
  modem.error_model = ErrorModel::kJanus;
  modem.guard_time = kHalfChip;
  return modem;
}

Modem micromodem(ModemProfile profile, double bandwidth_hz) {
  Modem modem = real_modem(profile, 25'000, bandwidth_hz);
  modem.preamble = kProbe;
  modem.packet_overhead = kProbeAndSilence;
  return modem;
}

Modem micromodem_fsk() {
  Modem modem = micromodem(ModemProfile::kMicromodemFsk, 4'000);
  modem.bit_rate_bps = 80;
  modem.layout = {.frame_bytes = 32, .max_frames = 1};
  modem.error_model = ErrorModel::kJanus;
  modem.guard_time = kHalfChip;
  modem.doppler_tolerance = 80.0 / 25'000;  // [h]
  return modem;
}

Modem micromodem_psk(int psk_rate) {
  const auto rate = std::find_if(kRates.begin(), kRates.end(),
                                 [&](const PskRate& each) { return each.number == psk_rate; });
  require(rate != kRates.end(), "PSK rate is " + std::to_string(psk_rate) + "; allowed are 1, 2, 4 and 5");
  Modem modem = micromodem(ModemProfile::kMicromodemPsk, 5'000);
  modem.psk_rate = psk_rate;
  modem.bit_rate_bps = rate->bit_rate_bps;
  modem.layout = {.frame_bytes = rate->frame_bytes, .max_frames = rate->max_frames};
  modem.error_model = rate->error_model;
  modem.guard_time = SimDuration::from_milliseconds(10);  // [g]
  return modem;
}

}  // namespace

std::string_view to_name(ModemProfile profile) {
  switch (profile) {
    case ModemProfile::kGeneric:
      return "generic";
    case ModemProfile::kJanus:
      return "janus";
    case ModemProfile::kMicromodemFsk:
      return "micromodem-fsk";
    case ModemProfile::kMicromodemPsk:
      break;
  }
  return "micromodem-psk";
}

std::optional<ModemProfile> modem_profile_from_name(std::string_view name) {
  for (const ModemProfile profile : kModemProfiles) {
    if (to_name(profile) == name) return profile;
  }
  return std::nullopt;
}

Modem profile_modem(ModemProfile profile, int psk_rate) {
  switch (profile) {
    case ModemProfile::kGeneric:
      return {};
    case ModemProfile::kJanus:
      return janus();
    case ModemProfile::kMicromodemFsk:
      return micromodem_fsk();
    case ModemProfile::kMicromodemPsk:
      break;
  }
  return micromodem_psk(psk_rate);
}

void validate_profile(const Modem& modem) {
  if (modem.profile == ModemProfile::kGeneric) return;
  const Modem own = profile_modem(modem.profile, modem.psk_rate);
  const auto fixed = [&](bool same, const std::string& what) {
    require(same, what + " of profile " + std::string(to_name(modem.profile)) +
                      " is its own; only the generic profile has another");
  };
  fixed(modem.bit_rate_bps == own.bit_rate_bps, "bit rate");
  fixed(modem.packet_overhead == own.packet_overhead, "packet overhead");
  fixed(modem.preamble == own.preamble && modem.preamble_pieces == own.preamble_pieces, "preamble");
  fixed(modem.layout == own.layout, "layout of packets");
}

}  // namespace halocline::acoustics

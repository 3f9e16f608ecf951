// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/modem.h"

#include <algorithm>
#include <string>

#include "acoustics/modem/packet_format.h"
#include "acoustics/modem/preamble_detection.h"
#include "core/check.h"
#include "core/names.h"

namespace halocline::acoustics {
namespace {

constexpr double kMaxBits = 1e6;
constexpr double kMinShare = 1e-30;  // least share of a band in band_loss()

void validate(const FrameLayout& layout) {
  require_in_range(layout.header_bits, 0, kMaxBits, "header", "bits");
  require_in_range(layout.tail_bits, 0, kMaxBits, "tail of a coded block", "bits");
  require_in_range(layout.frame_bytes, 0, kMaxPayloadBytes, "frame", "bytes");
  require_in_range(layout.max_frames, layout.frame_bytes > 0 ? 1 : 0, kMaxFrames, "frames of a packet");
  require_in_range(layout.mini_packet_bits, 0, kMaxBits, "mini-packet", "bits");
  require_in_range(layout.application_bits, 0, layout.header_bits, "application's part of the header",
                   "bits");
}

void validate_hopping(const Modem& modem) {
  require_in_range(modem.chip.seconds(), 0, 10, "chip", "s");
  require_in_range(modem.hop_count, 0, 1024, "hop count", "pairs of tones");
  require_in_range(modem.hop_clearing.seconds(), 0, 60, "clearing time of the hop pattern", "s");
  require(hops_well(modem), "hopping needs a chip");
  require(modem.error_model != ErrorModel::kPulses || modem.chip > SimDuration(),
          "the error model of pulses needs a chip, the pulse");
}

void validate_receiver(const Modem& modem) {
  require_in_range(modem.receiver_loss.value, kMinReceiverLossDb, kMaxReceiverLossDb, "loss of the receiver",
                   "dB");
  require_in_range(modem.receiver_channels, 1, 64, "hydrophones of the receiver");
  require_in_range(modem.late_echo_share, 0, kMaxLateEchoShare, "share of late echoes that disturbs");
  require_in_range(modem.echo_cancelled, 0, 1, "share of late echoes that is cancelled");
  require_in_range(modem.impulse_loss.value, 0, 40, "loss in impulsive noise", "dB");
}

}  // namespace

void validate(const Modem& modem) {
  require(is_valid_name(modem.family),
          "family of the modem is '" + modem.family + "'; allowed is " + std::string(kNameRule));
  require_in_range(modem.source_level.value, 0, 250, "source level", "dB re 1 uPa at 1 m");
  require_in_range(modem.min_receivable_level.value, -200, 250, "least receivable level", "dB re 1 uPa");
  require_in_range(modem.centre_frequency_hz, 10, 1e6, "centre frequency", "Hz");
  require_finite(modem.bandwidth_hz, "bandwidth");
  require(modem.bandwidth_hz > 0 && modem.bandwidth_hz < 2 * modem.centre_frequency_hz,
          "bandwidth is " + std::to_string(modem.bandwidth_hz) +
              " Hz; allowed is above 0 and below twice the centre frequency of " +
              std::to_string(modem.centre_frequency_hz) + " Hz");
  require_in_range(modem.directivity_index.value, 0, 40, "directivity index", "dB");
  require_in_range(modem.bit_rate_bps, 1e-3, 1e7, "bit rate", "bit/s");
  require_in_range(modem.packet_overhead.seconds(), 0, 60, "packet overhead", "s");
  require_in_range(modem.preamble.seconds(), 0, modem.packet_overhead.seconds(),
                   "preamble (part of the packet overhead)", "s");
  require_in_range(modem.preamble_pieces, 1, 256, "pieces of the preamble");
  require_in_range(modem.guard_time.seconds(), 0, 10, "guard time", "s");
  require_in_range(modem.guard_taper_or_default().seconds(), 0, 10, "taper after the guard time", "s");
  require_in_range(modem.doppler_tolerance, 0, 1, "Doppler tolerance");
  require_in_range(modem.doppler_correction, 0, 1, "Doppler correction");
  require_in_range(modem.time_quantum.seconds(), 0, 1, "quantum of the time of arrival", "s");
  validate_hopping(modem);
  validate_receiver(modem);
  validate(modem.layout);
}

Modem generic_modem(Decibels strength, Decibels cut_off, double centre_frequency_hz, double bandwidth_hz) {
  Modem modem;
  modem.source_level = strength;
  modem.min_receivable_level = cut_off;
  modem.centre_frequency_hz = centre_frequency_hz;
  modem.bandwidth_hz = bandwidth_hz;
  validate(modem);
  return modem;
}

PacketTiming packet_timing(const Modem& modem, std::size_t payload_bytes) {
  return packet_timing(modem, data_format(modem, payload_bytes));
}

std::size_t max_payload_bytes(const Modem& modem) {
  const FrameLayout& layout = modem.layout;
  const std::int64_t most = layout.frame_bytes > 0 ? std::int64_t{layout.frame_bytes} * layout.max_frames
                                                   : std::int64_t{kMaxPayloadBytes};
  return static_cast<std::size_t>(most);
}

double acquisition_probability(const Modem& modem, PowerRatio sinr) {
  require(sinr.value >= 0, "a signal-to-noise ratio must not be negative or NaN");
  if (modem.preamble == SimDuration()) return 1;
  // Ratio of the preamble's energy to the noise density: T B SNR.
  const double time_bandwidth = modem.preamble.seconds() * modem.bandwidth_hz;
  return detection_probability(modem.preamble_pieces, kFalseAlarmProbability, {time_bandwidth * sinr.value});
}

PowerRatio bit_energy(const Modem& modem, PowerRatio sinr) {
  // Eb / N0 = SNR B T, T the pulse of a pulse code, else 1 / R.
  if (modem.error_model == ErrorModel::kPulses)
    return {sinr.value * modem.bandwidth_hz * modem.chip.seconds()};
  return {sinr.value * modem.bandwidth_hz / modem.bit_rate_bps};
}

PowerRatio least_mean_square_error(PowerRatio sinr) {
  require(sinr.value >= 0, "a signal-to-noise ratio must not be negative or NaN");
  return {1 / (1 + sinr.value)};
}

double bit_error_rate(const Modem& modem, PowerRatio sinr) {
  return bit_error_rate(modem.error_model, bit_energy(modem, sinr));
}

bool hops_well(const Modem& modem) { return modem.hop_count == 0 || modem.chip > SimDuration(); }

double Modem::window_s() const {
  return receiver == ReceiverKind::kStrongestPath ? 1 / bandwidth_hz : guard_time.seconds();
}

double Modem::window_taper_s() const {
  return receiver == ReceiverKind::kStrongestPath ? 1 / bandwidth_hz : guard_taper_or_default().seconds();
}

double noise_factor(const Modem& receiver) {
  return to_power_ratio(receiver.receiver_loss).value / receiver.receiver_channels;
}

Decibels receiver_gain(const Modem& receiver) { return -to_decibels(PowerRatio{noise_factor(receiver)}); }

bool same_family(const Modem& sender, const Modem& receiver) { return sender.family == receiver.family; }

Decibels band_loss(const Modem& sender, const Modem& receiver) {
  const double share = band_share(sender.band(), receiver.band());
  return share == 1 ? Decibels{} : -to_decibels(PowerRatio{std::max(share, kMinShare)});
}

}  // namespace halocline::acoustics

// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/error_model.h"

#include "acoustics/modem/bit_error.h"
#include "acoustics/modem/block_code.h"
#include "acoustics/modem/convolutional_code.h"
#include "acoustics/modem/orthogonal_symbols.h"
#include "acoustics/modem/preamble_detection.h"
#include "core/check.h"

namespace halocline::acoustics {
namespace {

constexpr double kConvolutionalRate = 0.5;  // a chip carries half of the energy of an information bit

template <Modulation modulation, Fading fading>
double uncoded(PowerRatio eb_over_n0) {
  return bit_error_rate(modulation, fading, eb_over_n0);
}

double janus(PowerRatio eb_over_n0) { return janus_error_events({kConvolutionalRate * eb_over_n0.value}); }
double janus_rayleigh(PowerRatio eb_over_n0) {
  return janus_error_events_rayleigh({kConvolutionalRate * eb_over_n0.value});
}

double never(PowerRatio) { return 0; }
double bch64(PowerRatio eb_over_n0) { return coded_bit_error_rate(bch_64_10(), eb_over_n0); }
double orthogonal16(PowerRatio eb_over_n0) { return orthogonal16_bit_error_rate(eb_over_n0); }

constexpr double kPulseFalseAlarm = 1e-3;
// A pulse in noise alone is there by a false alarm only: a code is not guessed as bits are.
double pulses(PowerRatio pulse_over_n0) {
  return 1 - detection_probability(1, kPulseFalseAlarm, pulse_over_n0);
}

double hamming14(PowerRatio eb_over_n0) { return coded_bit_error_rate(hamming_14_9(), eb_over_n0); }

// An error model with its name and formula.
struct Known {
  ErrorModel model;
  std::string_view name;
  double (*bit_error_rate)(PowerRatio);
};

constexpr Known kKnown[] = {
    {ErrorModel::kNone, "none", never},
    {ErrorModel::kBfsk, "bfsk", uncoded<Modulation::kNoncoherentBfsk, Fading::kNone>},
    {ErrorModel::kBfskRayleigh, "bfsk-rayleigh", uncoded<Modulation::kNoncoherentBfsk, Fading::kRayleigh>},
    {ErrorModel::kBpsk, "bpsk", uncoded<Modulation::kBpsk, Fading::kNone>},
    {ErrorModel::kBpskRayleigh, "bpsk-rayleigh", uncoded<Modulation::kBpsk, Fading::kRayleigh>},
    {ErrorModel::kDbpsk, "dbpsk", uncoded<Modulation::kDbpsk, Fading::kNone>},
    {ErrorModel::kDbpskRayleigh, "dbpsk-rayleigh", uncoded<Modulation::kDbpsk, Fading::kRayleigh>},
    {ErrorModel::kJanus, "janus", janus},
    {ErrorModel::kJanusRayleigh, "janus-rayleigh", janus_rayleigh},
    {ErrorModel::kBpskBch64, "bpsk-bch64", bch64},
    {ErrorModel::kBpskHamming14, "bpsk-hamming14", hamming14},
    {ErrorModel::kOrthogonal16, "orthogonal16", orthogonal16},
    {ErrorModel::kPulses, "pulses", pulses},
};

const Known& known(ErrorModel model) {
  const auto place = static_cast<std::size_t>(model);
  ensure(place < std::size(kKnown) && kKnown[place].model == model, "an error model without a formula");
  return kKnown[place];
}

}  // namespace

std::string_view to_name(ErrorModel model) { return known(model).name; }

bool is_coded_frequency_shift_keying(ErrorModel model) {
  return model == ErrorModel::kJanus || model == ErrorModel::kJanusRayleigh;
}

bool is_frequency_shift_keying(ErrorModel model) {
  return is_coded_frequency_shift_keying(model) || model == ErrorModel::kNone || model == ErrorModel::kBfsk ||
         model == ErrorModel::kBfskRayleigh || model == ErrorModel::kPulses;
}

double bit_error_rate(ErrorModel model, PowerRatio eb_over_n0) {
  return known(model).bit_error_rate(eb_over_n0);
}

}  // namespace halocline::acoustics

// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/vehicles/modem_rates.h"

namespace halocline::channel_server {
namespace {

using acoustics::Modem;

Modem of_same_family(const Modem& rate, const Modem& own) {
  Modem modem = own;
  modem.bit_rate_bps = rate.bit_rate_bps;
  modem.packet_overhead = rate.packet_overhead;
  modem.preamble = rate.preamble;
  modem.preamble_pieces = rate.preamble_pieces;
  modem.error_model = rate.error_model;
  modem.layout = rate.layout;
  return modem;
}

Modem of_other_family(const Modem& rate, const Modem& own) {
  Modem modem = rate;
  modem.source_level = own.source_level;
  modem.min_receivable_level = own.min_receivable_level;
  modem.directivity_index = own.directivity_index;
  modem.beam = own.beam;
  return modem;
}

}  // namespace

RateSet rates_in_vehicle(const RateSet& rates, const Modem& profile, const Modem& own) {
  if (rates.all().empty()) return {};
  std::vector<ModemRate> composed(rates.all().begin(), rates.all().end());
  for (ModemRate& rate : composed) {
    rate.modem =
        same_family(rate.modem, profile) ? of_same_family(rate.modem, own) : of_other_family(rate.modem, own);
  }
  return RateSet(std::move(composed));
}

}  // namespace halocline::channel_server

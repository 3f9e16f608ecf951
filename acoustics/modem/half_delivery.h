// SPDX-License-Identifier: BSD-3-Clause
// The ratio of signal to noise and interference at which half of a modem's packets arrive: the threshold of
// what it needs.
//
// In noise that does not fade: the preamble is detected and all information bits are right (modem.h), each by
// itself. In a sea that fades, half arrive at a higher mean ratio.
#pragma once

#include <cstddef>
#include <optional>

#include "acoustics/modem/modem.h"
#include "core/units.h"

namespace halocline::acoustics {

// Of packets of `payload_bytes`, over the modem's band, -60..60 dB. None where it lies beyond, as for a modem
// whose packets are always received. Throws InvalidArgument as packet_timing().
std::optional<Decibels> half_delivery_sinr(const Modem& modem, std::size_t payload_bytes);

}  // namespace halocline::acoustics

// SPDX-License-Identifier: BSD-3-Clause
// The ratio of signal to noise and interference at which a modem delivers half of its packets: its threshold.
//
// The threshold is for noise without fading: the preamble has to be detected and all information bits have to
// be right (modem.h), independently. With fading, half of the packets arrive at a higher mean ratio.
#pragma once

#include <cstddef>
#include <optional>

#include "acoustics/modem/modem.h"
#include "core/units.h"

namespace halocline::acoustics {

// The threshold for packets of `payload_bytes`, over the modem's band, -60..60 dB. nullopt when it is outside
// of that range, as for a modem whose packets are always received. Throws InvalidArgument under the
// conditions of packet_timing().
std::optional<Decibels> half_delivery_sinr(const Modem& modem, std::size_t payload_bytes);

}  // namespace halocline::acoustics

// SPDX-License-Identifier: BSD-3-Clause
// The protocols that there are, by the kind that a door names.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "clients/modem_gateway/protocols/protocol.h"

namespace halocline::modem_gateway {

// All kinds, in alphabetical order.
std::vector<std::string> protocol_kinds();

// Whether it is a door of waveforms, not of packets (sound_field.h).
bool needs_sound(std::string_view kind);

// Throws InvalidArgument for a kind that there is not, and for options that it does not have.
std::unique_ptr<Protocol> make_protocol(std::string_view kind, ProtocolContext context);

// One file each.
std::unique_ptr<Protocol> make_ahoi(ProtocolContext context);
std::unique_ptr<Protocol> make_evologics(ProtocolContext context);
std::unique_ptr<Protocol> make_micromodem(ProtocolContext context);
std::unique_ptr<Protocol> make_nm3(ProtocolContext context);
std::unique_ptr<Protocol> make_uasp2(ProtocolContext context);
std::unique_ptr<Protocol> make_unet(ProtocolContext context);

}  // namespace halocline::modem_gateway

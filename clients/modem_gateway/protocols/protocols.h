// SPDX-License-Identifier: BSD-3-Clause
// Registry of the modem protocols by the kind that a modem interface names.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "clients/modem_gateway/protocols/protocol.h"

namespace halocline::modem_gateway {

// Returns all kinds, in alphabetical order.
std::vector<std::string> protocol_kinds();

// Returns true for a kind that exchanges waveforms instead of packets (sound_field.h).
bool needs_sound(std::string_view kind);

// Makes a protocol. Throws InvalidArgument for an unknown kind or option.
std::unique_ptr<Protocol> make_protocol(std::string_view kind, ProtocolContext context);

// Constructors of the protocols, one source file each.
std::unique_ptr<Protocol> make_ahoi(ProtocolContext context);
std::unique_ptr<Protocol> make_evologics(ProtocolContext context);
std::unique_ptr<Protocol> make_micromodem(ProtocolContext context);
std::unique_ptr<Protocol> make_nm3(ProtocolContext context);
std::unique_ptr<Protocol> make_uasp2(ProtocolContext context);
std::unique_ptr<Protocol> make_unet(ProtocolContext context);

}  // namespace halocline::modem_gateway

// SPDX-License-Identifier: BSD-3-Clause
// The configuration of modems in TOML: [modem] and [vehicle.modem] of a scenario, and the files of
// models/modems.
//
// `profile` names a modem whose parameters are used when a scenario gives no others; every other key then
// overrides one of them. The generic modem's chips follow `bit_rate_bps`. A vehicle's table starts from the
// scenario's modem, or from the profile it names when that is a different one. A profile is a file: one of
// models/modems by its name ("janus"), any other by its path ("my_modem.toml"). It holds the keys of [modem]
// except `profile` and `when_busy`, and in addition those of framing, hopping and rates, which a scenario
// cannot change; a key that is left out has the generic modem's value. Unknown keys, wrong types and
// impossible values are errors that state file, line, key and what is allowed. docs/packets.md explains the
// parameters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acoustics/modem/modem.h"
#include "bus/config/config.h"
#include "channel_server/vehicles/modem_schedule.h"
#include "core/files/file_path.h"
#include "core/sim_time.h"

namespace halocline::channel_server {

// Visits the keys of [modem] or [vehicle.modem].
void visit_modem(bus::ConfigVisitor& v, VehicleModem& modem);

// Visits the one key of [modem] that only modems with events use.
void visit_carrier_threshold(bus::ConfigVisitor& v, Listening& listening);

// Gives a vehicle's modem the rates of its profile. Throws InvalidArgument, naming the field, when it differs
// from the profile in bit rate, packet overhead or preamble. Levels, band, family, guard time, Doppler limits
// and error model may differ.
void set_rates_of(const VehicleModem& profile, VehicleModem& vehicle);

// Convert the taper after the guard time from and to its form in files and messages: seconds, negative for a
// taper as long as the guard time (empty).
std::optional<SimDuration> taper_from(double seconds);
double seconds_of(std::optional<SimDuration> taper);

// Returns the names of the files of models/modems, in alphabetical order. They are compiled in, so they are
// known wherever a program runs.
const std::vector<std::string>& built_in_modems();

// Returns a modem of models/modems by name, or from a file (ending in .toml). Throws bus::ConfigErrors for
// errors in the file, InvalidArgument for an unknown name.
VehicleModem load_modem(const FilePath& profile);

// Returns one of built_in_modems() at its own rate only, without its other rates: this is cheaper than
// load_modem(). Throws InvalidArgument for an unknown name.
acoustics::Modem built_in_modem(const std::string& profile);

// Returns a modem as load_modem() does, but from text. `name_for_errors` is used as the name of the file and
// of the profile.
VehicleModem parse_modem(const std::string& text, const std::string& name_for_errors);

}  // namespace halocline::channel_server

// SPDX-License-Identifier: BSD-3-Clause
// Modems in TOML: [modem] and [vehicle.modem] of a scenario, and the files of models/modems.
//
// `profile` names a modem whose numbers hold where a scenario gives no others; every other key then changes
// one of them. A vehicle's table starts from the scenario's modem, or from the profile it names where that is
// another. A profile is a file: one of models/modems by its name ("janus"), any other by its path
// ("my_modem.toml"). It holds the keys of [modem] but `profile` and `when_busy`, and those of framing,
// hopping and rates, which a scenario leaves as they are; a key that is left out is the generic modem's.
// Unknown keys, wrong types and impossible values are errors with file, line, key and what is allowed.
// docs/packets.md explains the parameters.
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

void visit_modem(bus::ConfigVisitor& v, VehicleModem& modem);

// Gives a vehicle's modem the rates of its profile. Throws InvalidArgument, naming the field, where it
// differs from the profile in the form of packets. Levels, band, family, guard time, Doppler and error model
// are free.
void set_rates_of(const VehicleModem& profile, VehicleModem& vehicle);

// The taper after the guard time, in files and messages: seconds, below 0 for one more guard time.
std::optional<SimDuration> taper_from(double seconds);
double seconds_of(std::optional<SimDuration> taper);

// The names of the files of models/modems, in alphabetical order: they are known wherever a program runs.
const std::vector<std::string>& built_in_modems();

// A modem of models/modems by name, or a file (ending in .toml). Throws
// bus::ConfigErrors with what is wrong in the file, InvalidArgument for a name that is none.
VehicleModem load_modem(const FilePath& profile);

// What one of built_in_modems() transmits by itself, without the other rates that it names: cheaper.
acoustics::Modem built_in_modem(const std::string& profile);

// The same from text; `name_for_errors` stands for the file and is the profile's name.
VehicleModem parse_modem(const std::string& text, const std::string& name_for_errors);

}  // namespace halocline::channel_server

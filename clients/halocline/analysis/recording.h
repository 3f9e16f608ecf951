// SPDX-License-Identifier: BSD-3-Clause
// The messages of a recorded log that are replayed: states, transmissions, modems and changes of the
// environment, each at its time.
//
// With `what` kWithEquipment also GPS, BATTERY and SENSORS, by which the clocks, batteries and propellers of
// vehicles go.
//
// Answers in the log (LINKS, RECEIPT, OUTCOME, ...) are not replayed. Times depend on the recorder:
//
// - A lockstep run stamps its log with simulation time: messages are played at their stamps, in their order.
//   A stamp that breaks their order was damaged and counts as the one before it.
// - Any other log (lcm-logger's, one recorded at sea) goes by the messages' own utime: STATE, MODEM, LISTEN
//   and SET_ENVIRONMENT when they hold, SEND when it starts. A utime more than 30 days from the median of all
//   states' comes from another clock (or from none: 0): such a message is played at the latest valid utime
//   that the log had reached. When no state has a time, all go by the stamps.
// - Such a log whose first message is later than a day (Unix time, a machine's uptime) is shifted: its first
//   whole second becomes 0, `zero` is what it was, and every utime of what is played shifts with it.
//
// Fields that a foreign vehicle leaves out are filled in: a vehicle_id or source_id of 0 is the scenario's
// for that name, otherwise the least that is free; an orientation of all zeros is level and towards north.
// Modems are the scenario's, its standard one for other names. All of it is counted.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bus/logs/log_reader.h"
#include "bus/messages.h"
#include "bus/runtime/scenario.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct Recording {
  struct Event {
    SimTime at;
    std::string channel;
    std::variant<vehicle_state_t, modem_send_t, modem_config_t, modem_listen_t, environment_change_t,
                 vehicle_gps_t, vehicle_battery_t, vehicle_sensors_t>
        message;
  };
  std::vector<Event> events;  // by time; of one time, in the log's order
  SimTime end;                // of the run, as far as the log shows
  SimDuration zero;           // what was taken off every time
  bool stamped_with_simulation_time = false;
  std::int64_t outcomes = 0;      // that the log holds of its own channel server
  std::int64_t ignored = 0;       // answers, foreign and undecodable events
  std::int64_t without_time = 0;  // played when they were logged
  std::int64_t without_id = 0;    // a vehicle's id was given to them
  std::int64_t without_orientation = 0;
  std::vector<std::pair<std::string, std::int32_t>> ids_given;  // by vehicle
};

enum class Played { kStatesAndPackets, kWithEquipment };

// `scenario` gives ids to vehicles whose messages have none.
Recording read_recording(LogReader& log, const bus::Scenario& scenario = {},
                         Played what = Played::kStatesAndPackets);

// A line for each thing that had to be filled in or moved; none for a log of our own.
void print_repairs(std::ostream& out, const Recording& recording);

}  // namespace halocline::clients

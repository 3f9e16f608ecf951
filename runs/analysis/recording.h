// SPDX-License-Identifier: BSD-3-Clause
// Messages of a recorded log that are replayed: states, transmissions, modem settings and changes of the
// environment, each at its time.
//
// kWithEquipment adds GPS, BATTERY and SENSORS, which determine the clocks, batteries and propellers of
// vehicles.
//
// Answers in the log (LINKS, RECEIPT, OUTCOME, ...) are not replayed. The times depend on the recorder:
//
// - A lockstep run stamps its log with simulation time: messages are replayed at their stamps, in order. A
//   stamp that breaks the order is damaged and is replaced by the one before it.
// - Any other log (by lcm-logger, or recorded at sea) is replayed by the utime of the messages: STATE, MODEM,
//   LISTEN and SET_ENVIRONMENT when they hold, SEND when it starts. A utime more than 30 days from the median
//   of all states comes from another clock (or from none: 0); such a message is replayed at the latest valid
//   utime that the log had reached. When no state has a valid time, all messages go by their stamps.
// - Such a log is shifted when its first message is later than one day (Unix time, or the uptime of a
//   machine): its first whole second becomes 0, `zero` keeps that second, and every utime of the replayed
//   messages shifts by it.
//
// Fields that a foreign vehicle leaves out are filled in. A vehicle_id or source_id of 0 becomes the
// scenario's id for that name, otherwise the smallest free id. An orientation of all zeros becomes level and
// facing north. Modems are the scenario's, with its standard modem for unknown names. Every repair is
// counted.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bus/config/scenario.h"
#include "bus/logs/log_reader.h"
#include "bus/messages/messages.h"
#include "core/sim_time.h"

namespace halocline::clients {

// Messages to replay, with the counts of repairs and of what was left out.
struct Recording {
  struct Event {
    SimTime at;
    std::string channel;
    std::variant<vehicle_state_t, modem_send_t, modem_config_t, modem_listen_t, environment_change_t,
                 vehicle_gps_t, vehicle_battery_t, vehicle_sensors_t>
        message;
  };
  std::vector<Event> events;  // sorted by time; events of one time in the log's order
  SimTime end;                // end of the run, as far as the log shows
  SimDuration zero;           // subtracted from every time
  bool stamped_with_simulation_time = false;
  std::int64_t outcomes = 0;      // outcomes in the log, of its own channel server
  std::int64_t ignored = 0;       // answers, and foreign and undecodable events
  std::int64_t without_time = 0;  // replayed when they were logged
  std::int64_t without_id = 0;    // events that were given a vehicle's id
  std::int64_t without_orientation = 0;
  std::vector<std::pair<std::string, std::int32_t>> ids_given;  // vehicle and id
};

// Selects whether GPS, BATTERY and SENSORS are replayed too.
enum class Played { kStatesAndPackets, kWithEquipment };

// Reads the messages to replay. `scenario` provides ids for vehicles whose messages have none.
Recording read_recording(LogReader& log, const bus::Scenario& scenario = {},
                         Played what = Played::kStatesAndPackets);

// Prints a line for each kind of repair; none for a log of Halocline's own programs.
void print_repairs(std::ostream& out, const Recording& recording);

}  // namespace halocline::clients

// Plays the states, transmissions, modems and changes of the environment of a recorded log, each at its simulation time.
//
// What the log holds of answers (LINKS, RECEIPT, OUTCOME, ...) is not played: it is for the server that listens to
// give its own. Times: a log that a lockstep run wrote is stamped with simulation time, and its messages are played at
// their stamps, in their order. Any other log (lcm-logger's, with wall-clock stamps) is played by the messages'
// utime: STATE and MODEM when they hold, SEND when it starts.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "bus/node.h"
#include "clients/halocline/log_reader.h"

namespace halocline::clients {

// What is played of a log.
struct Recording {
  struct Event {
    SimTime at;
    std::string channel;
    std::variant<vehicle_state_t, modem_send_t, modem_config_t, environment_change_t> message;
  };
  std::vector<Event> events;  // by time; of one time, in the log's order
  SimTime end;                // of the run, as far as the log tells
  bool stamped_with_simulation_time = false;
  std::int64_t ignored = 0;  // answers, foreign and undecodable events
};

Recording read_recording(LogReader& log);

class ReplayNode : public bus::Node {
 public:
  ReplayNode(lcm::LCM& lcm, bus::NodeIdentity identity, Recording recording);

 protected:
  bus::Due on_due() const override;
  void on_step(const bus::Now& now) override;
  std::string status_text() const override;

 private:
  Recording recording_;
  std::size_t next_ = 0;
};

}  // namespace halocline::clients

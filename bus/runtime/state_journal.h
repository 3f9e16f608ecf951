// The latest state of a node on disk, from which its next incarnation goes on when this one was killed.
//
// Two files, `path`.0 and `path`.1, written in turn, each with a number and a check sum: a kill in the middle of a
// write leaves the other one whole. What is written is handed to the kernel before write() returns, so that a killed
// process loses nothing that it acted upon; a machine that loses power may (nothing is forced to the disk).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/sim_time.h"

namespace halocline::bus {

class StateJournal {
 public:
  struct Saved {
    std::int64_t session = 0;  // of the node
    SimTime at;                // simulation time
    std::vector<std::uint8_t> state;
  };

  // `digest` of all that the state's meaning depends on: what was saved with another one is not inherited. Throws
  // InvalidArgument when the files cannot be written.
  StateJournal(const std::string& path, std::uint64_t digest);
  ~StateJournal();
  StateJournal(const StateJournal&) = delete;
  StateJournal& operator=(const StateJournal&) = delete;

  // What an earlier incarnation wrote last.
  const std::optional<Saved>& inherited() const { return inherited_; }

  void write(std::int64_t session, SimTime at, std::span<const std::uint8_t> state);

 private:
  std::string path_;
  std::uint64_t digest_, number_ = 0;
  std::array<int, 2> files_ = {-1, -1};
  std::optional<Saved> inherited_;
};

}  // namespace halocline::bus

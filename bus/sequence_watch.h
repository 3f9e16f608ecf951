// Tells a gap from silence: follows (session, sequence) of each channel's publishers.
//
// A publisher that keeps no numbers sends 0 for both always, and is not watched. A new session starts anew
// without a gap: its publisher was started again.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace halocline::bus {

class SequenceWatch {
 public:
  // How many messages are missing between the last one heard of this session on this channel and this one:
  // 0 for the first, for the next, and for repetitions.
  std::int64_t missing_before(std::string_view channel, std::int64_t session, std::int64_t sequence);

 private:
  struct Publisher {
    std::int64_t session = 0;
    std::int64_t sequence = 0;  // the greatest heard
  };
  // A channel remembers few sessions: the one silent for longest makes room, so that a long run does not grow.
  static constexpr std::size_t kSessionsKept = 8;
  std::map<std::string, std::vector<Publisher>, std::less<>> heard_;  // each ends in the one heard last
};

}  // namespace halocline::bus

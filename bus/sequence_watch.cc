#include "bus/sequence_watch.h"

#include <algorithm>

namespace halocline::bus {

std::int64_t SequenceWatch::missing_before(std::string_view channel, std::int64_t session,
                                           std::int64_t sequence) {
  if (session == 0 && sequence == 0) return 0;
  auto found = last_.find(channel);
  if (found == last_.end())
    found = last_.emplace(std::string(channel), std::map<std::int64_t, std::int64_t>()).first;
  auto& sessions = found->second;
  const auto known = sessions.find(session);
  if (known == sessions.end()) {
    if (sessions.size() >= kSessionsKept) sessions.erase(sessions.begin());
    sessions.emplace(session, sequence);
    return 0;
  }
  const std::int64_t missing = sequence - known->second - 1;
  known->second = std::max(known->second, sequence);
  return std::max<std::int64_t>(missing, 0);
}

}  // namespace halocline::bus

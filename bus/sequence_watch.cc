#include "bus/sequence_watch.h"

#include <algorithm>
#include <limits>

namespace halocline::bus {

std::int64_t SequenceWatch::missing_before(std::string_view channel, std::int64_t session,
                                           std::int64_t sequence) {
  if (session == 0 && sequence == 0) return 0;
  auto found = heard_.find(channel);
  if (found == heard_.end()) found = heard_.emplace(std::string(channel), std::vector<Publisher>()).first;
  std::vector<Publisher>& publishers = found->second;
  const auto known = std::find_if(publishers.begin(), publishers.end(),
                                  [&](const Publisher& publisher) { return publisher.session == session; });
  if (known == publishers.end()) {
    if (publishers.size() >= kSessionsKept) publishers.erase(publishers.begin());
    publishers.push_back({session, sequence});
    return 0;
  }
  const std::int64_t last = known->sequence;
  known->sequence = std::max(last, sequence);
  std::rotate(known, known + 1, publishers.end());
  // Numbers of a hostile publisher may lie further apart than an int64 tells: then more than anyone counts.
  std::int64_t step = 0;
  if (sequence <= last) return 0;
  return __builtin_sub_overflow(sequence, last, &step) ? std::numeric_limits<std::int64_t>::max() : step - 1;
}

}  // namespace halocline::bus

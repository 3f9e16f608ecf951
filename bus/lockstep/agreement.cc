// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/agreement.h"

#include <cstdint>
#include <map>
#include <sstream>

#include "bus/lockstep/arithmetic_digest.h"
#include "bus/messages/channel_table.h"
#include "bus/version.h"
#include "core/random.h"

namespace halocline::bus {
namespace {

// Digest of all message types that are used on channels.
std::uint64_t message_digest() {
  std::uint64_t digest = 0;
  any_channel([&digest]<class Message>(const auto&) {
    digest = identity_of({digest, static_cast<std::uint64_t>(Message::getHash())});
    return false;
  });
  return digest;
}

std::map<std::string, std::string> words_of(std::string_view text) {
  std::map<std::string, std::string> words;
  std::istringstream in{std::string(text)};
  for (std::string word; in >> word;) {
    const auto split = word.find('=');
    words[word.substr(0, split)] = split == std::string::npos ? "" : word.substr(split + 1);
  }
  return words;
}

std::string explained(const std::string& what) {
  if (what == "arithmetic")
    return "arithmetic (its elementary functions or sums give other results: another library, or options of "
           "the compiler)";
  if (what == "messages") return "messages (its types have other fields)";
  return what;
}

}  // namespace

std::string agreement_on(std::string_view scenario) {
  std::ostringstream text;
  text << "scenario=" << scenario << " version=" << kVersion << std::hex << " messages=" << message_digest()
       << " arithmetic=" << arithmetic_digest();
  return text.str();
}

std::string disagreement(std::string_view theirs, std::string_view ours) {
  const auto given = words_of(theirs), wanted = words_of(ours);
  std::string differing;
  for (const auto& [what, value] : wanted) {
    const auto found = given.find(what);
    if (found != given.end() && found->second == value) continue;
    differing += (differing.empty() ? "" : ", ") + explained(what) + " is " +
                 (found == given.end() ? "not given" : "'" + found->second + "'") + ", not '" + value + "'";
  }
  return differing.empty() && given != wanted ? "it states what is not known here: another version"
                                              : differing;
}

}  // namespace halocline::bus

// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/protocols/protocols.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/check.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {
namespace {

struct Kind {
  const char* name;
  std::unique_ptr<Protocol> (*make)(ProtocolContext);
};
constexpr std::array kKinds{
    Kind{"ahoi", make_ahoi}, Kind{"evologics", make_evologics}, Kind{"micromodem", make_micromodem},
    Kind{"nm3", make_nm3},   Kind{"uasp2", make_uasp2},         Kind{"unet", make_unet}};

}  // namespace

// Inverts clock_at() by the fixed-point iteration t = t + (reading - clock_at(t)). Clocks gain at most 1e-3
// and are at most 1e5 s off, so that four iterations leave an error of 0.1 us.
SimTime ProtocolPort::instant_of(SimTime reading) const {
  SimTime instant = reading;
  for (int i = 0; i < 4; ++i) instant = instant + (reading - clock_at(instant));
  return instant;
}

std::vector<std::string> protocol_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

bool needs_sound(std::string_view kind) { return kind == "uasp2"; }

std::unique_ptr<Protocol> make_protocol(std::string_view kind, ProtocolContext context) {
  const auto found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.name == kind; });
  std::string names;
  for (const Kind& k : kKinds) names += (names.empty() ? "" : ", ") + std::string(k.name);
  require(found != kKinds.end(), "kind of modem interface '" + std::string(kind) + "'; allowed are " + names);
  return found->make(std::move(context));
}

}  // namespace halocline::modem_gateway

// SPDX-License-Identifier: BSD-3-Clause
// Long-baseline ranging of a Micromodem (CCPDT, CCPNT, CCPGT): the travel times to up to four transponders,
// vehicles of the scenario whose modems answer pings.
//
// One ping asks all transponders at once (docs/packets.md). Each answers a turnaround after it has come, so
// that answers may overlap: the modem has a filter for each. It waits for those that the host names, for the
// host's time-out after ping, turnaround and answer. A transponder has a place, A to D, and may have a code:
// the frequency or the sequence by which hosts name its answer in CCPNT and CCPGT. Without one they name it
// by its place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bus/messages.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_core.h"
#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

class MicromodemLbl {
 public:
  static constexpr std::size_t kTransponders = 4;

  // Both must outlive it.
  MicromodemLbl(MicromodemCore& core, const AddressBook& addresses) : core_(core), addresses_(addresses) {}

  // ADDRESS or ADDRESS:CODE, / between. Throws InvalidArgument for another text.
  void name_transponders(const std::string& text);
  // Their vehicles, where an address has one.
  std::vector<std::int32_t> transponders() const;
  // False for a command that is none of these.
  bool obey(ClientId client, const NmeaSentence& sentence);
  // Whether that packet is a ping of its own, and takes its receipt or answer; a late answer counts no more.
  bool takes(const modem_receipt_t& receipt);
  bool takes(const modem_receive_t& packet);

  SimTime next() const { return until_; }
  void step();

 private:
  struct Transponder {
    std::int32_t address = 0;
    std::string code = "";
  };

  std::optional<std::int32_t> named(std::string_view field, std::size_t place, bool by_code) const;
  void report();

  MicromodemCore& core_;
  const AddressBook& addresses_;
  std::array<std::optional<Transponder>, kTransponders> transponders_;
  std::array<std::optional<std::int32_t>, kTransponders> asked_;  // vehicles
  std::array<std::optional<double>, kTransponders> times_;        // one-way, s; none where not heard
  SimDuration timeout_;
  std::int64_t sequence_ = kNotSent;  // of the last ping
  bool is_busy_ = false;
  SimTime until_ = SimTime::never();  // it waits for answers; never() before the ping's receipt
};

}  // namespace halocline::modem_gateway

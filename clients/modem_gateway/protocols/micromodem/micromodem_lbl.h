// SPDX-License-Identifier: BSD-3-Clause
// Long-baseline ranging of a Micromodem (CCPDT, CCPNT, CCPGT): the travel times to up to four transponders,
// vehicles of the scenario whose modems answer pings.
//
// One ping asks all transponders at once (docs/packets.md). Each answers a fixed turnaround after the ping
// arrives, so answers may overlap; the modem has a filter for each. It waits for the transponders that the
// host names, for the host's time-out after ping, turnaround and answer. A transponder has a place, A to D.
// It may also have a code, the frequency or sequence by which hosts name its answer in CCPNT and CCPGT;
// without one they name it by its place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bus/messages/messages.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/micromodem/micromodem_core.h"
#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {

class MicromodemLbl {
 public:
  static constexpr std::size_t kTransponders = 4;

  // `core` and `addresses` must outlive it.
  MicromodemLbl(MicromodemCore& core, const AddressBook& addresses) : core_(core), addresses_(addresses) {}

  // Reads the option `lbl`: ADDRESS or ADDRESS:CODE, with / between. Throws InvalidArgument for any other
  // text.
  void name_transponders(const std::string& text);
  std::vector<std::int32_t> transponders() const;
  // Returns false for a command that belongs to another part.
  bool obey(ClientId client, const NmeaSentence& sentence);
  // Take the receipt of a ping, or an answer to it. They return false when it belongs to no ping of this
  // object. An answer after the time-out is ignored.
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
  std::array<std::optional<std::int32_t>, kTransponders> asked_;  // vehicle ids
  std::array<std::optional<double>, kTransponders> times_;        // one-way travel times, s; none: not heard
  SimDuration timeout_;
  std::int64_t sequence_ = kNotSent;  // packet_sequence of the last ping
  bool is_busy_ = false;
  SimTime until_ = SimTime::never();  // end of the wait for answers; never() before the ping's receipt
};

}  // namespace halocline::modem_gateway

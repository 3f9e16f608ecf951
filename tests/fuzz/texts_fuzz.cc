// SPDX-License-Identifier: BSD-3-Clause
// Short texts of command lines and scenarios, by the first byte: rotation of logs, addresses and options of
// modem interfaces, places, hosts that are accepted, channels.
#include <string>
#include <vector>

#include "bus/logs/log_rotation.h"
#include "bus/messages/channel_pattern.h"
#include "bus/transport/receive_filter.h"
#include "clients/modem_gateway/gateway_config.h"
#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/interface_options.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace halocline;

void take(fuzz::Input& input) {
  const std::size_t kind = input.below(7);
  const std::string text(input.rest_as_text());
  switch (kind) {
    case 0:
      clients::rotation_of({text, "1h"}, 3);
      break;
    case 1: {
      modem_gateway::AddressBook book;
      modem_gateway::assign_addresses(book, text, {{"auv-1", 1}, {"auv-2", 2}});
      break;
    }
    case 2: {
      modem_gateway::InterfaceOptions options(text);
      options.take_number("rate", 1, 0, 10);
      options.take_flag("echo", false);
      options.require_all_taken();
      break;
    }
    case 3: {
      const modem_gateway::Endpoint place = modem_gateway::place_of(text);
      ensure(modem_gateway::place_of(place.text()) == place, "a place is read as it is written");
      break;
    }
    case 4:
      bus::receive_program({"STATE\\..*", "CLOCK"},
                           bus::accepted_hosts(text, "udpm://239.255.76.67:7667?ttl=0"));
      break;
    case 5:
      ensure(bus::ChannelPattern(bus::escaped(text)).matches(text), "an escaped channel matches itself");
      break;
    default:
      if (const auto number = parse_number(text))
        ensure(parse_number(format_number(*number)) == number, "a number is read as it is written");
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  try {
    take(input);
  } catch (const halocline::InvalidArgument&) {
  }
  return 0;
}

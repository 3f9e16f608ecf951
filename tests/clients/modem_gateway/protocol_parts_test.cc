// SPDX-License-Identifier: BSD-3-Clause
// What protocols share: addresses, options, fields, lines.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/address_book.h"
#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/interface_options.h"
#include "clients/modem_gateway/protocols/line_reader.h"
#include "core/check.h"
#include "tests/clients/modem_gateway/fake_port.h"

namespace halocline::modem_gateway {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(AddressBook, AVehicleHasItsIdUntilItIsGivenAnAddress) {
  AddressBook book;
  EXPECT_EQ(book.vehicle_of(3), 3);
  EXPECT_EQ(book.address_of(3), 3);
  EXPECT_EQ(book.vehicle_of(0), AddressBook::kNobody);
  book.assign(3, 12);
  EXPECT_EQ(book.vehicle_of(12), 3);
  EXPECT_EQ(book.address_of(3), 12);
  EXPECT_EQ(book.vehicle_of(3), AddressBook::kNobody);  // its id is nobody's address now
  EXPECT_FALSE(book.address_of(12));                    // and vehicle 12's id is another's address
}

TEST(AddressBook, AnAddressHasOneVehicle) {
  AddressBook book;
  book.assign(3, 12);
  book.assign(4, 12);
  EXPECT_EQ(book.vehicle_of(12), 4);
  EXPECT_EQ(book.address_of(3), 3);
  book.assign(4, 5);
  EXPECT_EQ(book.vehicle_of(12), 12);
}

TEST(AddressBook, TakesAddressesFromAText) {
  const std::vector<NamedVehicle> vehicles{{"auv-1", 1}, {"buoy", 9}};
  AddressBook book;
  assign_addresses(book, "auv-1=15  buoy=2", vehicles);
  EXPECT_EQ(book.address_of(1), 15);
  EXPECT_EQ(book.vehicle_of(2), 9);
  for (const auto* wrong : {"auv-1", "auv-2=1", "auv-1=x", "auv-1=-1", "auv-1=2 buoy=2"})
    EXPECT_THROW(assign_addresses(book, wrong, vehicles), InvalidArgument) << wrong;
}

TEST(InterfaceOptions, AreTakenByName) {
  InterfaceOptions options("a=1.5 b=yes");
  EXPECT_EQ(options.take_number("a", 0, 0, 2), 1.5);
  EXPECT_THROW(options.require_all_taken(), InvalidArgument);
  EXPECT_TRUE(options.take_flag("b", false));
  EXPECT_EQ(options.take("c", "other"), "other");
  EXPECT_NO_THROW(options.require_all_taken());
  EXPECT_THROW(InterfaceOptions("a=3").take_number("a", 0, 0, 2), InvalidArgument);
  EXPECT_THROW(InterfaceOptions("a=maybe").take_flag("a", false), InvalidArgument);
  EXPECT_THROW(InterfaceOptions("a"), InvalidArgument);
}

TEST(Fields, AreSplitWithTheEmptyOnes) {
  EXPECT_EQ(fields_of("a,,b,", ','), (std::vector<std::string_view>{"a", "", "b", ""}));
  EXPECT_EQ(fields_of("", ','), (std::vector<std::string_view>{""}));
  EXPECT_EQ(words_of("  a  b "), (std::vector<std::string_view>{"a", "b"}));
}

TEST(Fields, NumbersAreWholeTextsWithinBounds) {
  EXPECT_EQ(integer_in("-3", -5, 5), -3);
  EXPECT_EQ(integer_in("+3", -5, 5), 3);
  EXPECT_EQ(number_in("2.5", 0, 3), 2.5);
  for (const auto* wrong : {"", "6", "3x", " 3", "+-3", "3.0"})
    EXPECT_FALSE(integer_in(wrong, -5, 5)) << wrong;
  for (const auto* wrong : {"", "nan", "inf", "4", "1,5"}) EXPECT_FALSE(number_in(wrong, 0, 3)) << wrong;
}

TEST(Fields, HexadecimalBytesSurviveTheRoundTrip) {
  const std::vector<std::uint8_t> bytes{0x00, 0x0A, 0x0D, 0x2B, 0x2C, 0xFF};
  EXPECT_EQ(hex_of(bytes), "000A0D2B2CFF");
  EXPECT_EQ(bytes_of_hex("000a0d2b2cFF"), bytes);
  EXPECT_FALSE(bytes_of_hex("0"));
  EXPECT_FALSE(bytes_of_hex("0g"));
}

struct Lines {
  void take(std::string_view bytes) {
    reader.take(
        bytes, [&](std::string_view line) { lines.emplace_back(line); }, [&] { ++too_long; });
  }
  LineReader reader;
  std::vector<std::string> lines;
  int too_long = 0;
};

TEST(LineReader, EndsLinesAtEitherEndAndSkipsEmptyOnes) {
  Lines lines;
  lines.take("a\r\nb\rc");
  lines.take("d\n\n");
  EXPECT_EQ(lines.lines, (std::vector<std::string>{"a", "b", "cd"}));
}

TEST(LineReader, DiscardsALineThatIsTooLongAndGoesOn) {
  Lines lines;
  for (int i = 0; i < 1024; ++i) lines.take(std::string(1024, 'x'));
  EXPECT_EQ(lines.too_long, 1);
  lines.take("\nnext\n");
  EXPECT_EQ(lines.lines, (std::vector<std::string>{"next"}));
  lines.take(std::string(LineReader::kMaxLine, 'y') + "\n");
  EXPECT_EQ(lines.lines.size(), 2u);
}

TEST(LineReader, KeepsTheBeginningAndTheEndOfALineThatIsTooLong) {
  LineReader reader(10);
  std::string beginning, last;
  for (const auto* piece : {"abc", "defghijkl", "mn\nnext\n"}) {
    reader.take(
        piece, [](std::string_view) {}, [] {},
        [&](std::string_view first, std::string_view end) { beginning = first, last = end; });
  }
  EXPECT_EQ(beginning, "abcdefghij");
  EXPECT_EQ(last, "klmn");
}

std::string datagram_of(std::size_t bytes, bool data_first) {
  std::string data = R"("data":[1)";
  while (data.size() < bytes) data += ",1";
  data += "]";
  const std::string names = R"("msgID":"m7","sender":"gateway-7","recipient":"phy")";
  return R"({"action":"send","message":{"clazz":"org.arl.unet.DatagramReq","data":{)" +
         (data_first ? data + "," + names : names + "," + data) + "}}}\n";
}

TEST(Unet, ARequestOf300KilobytesIsReadAndOneBeyondAMegabyteRefused) {
  testing::ProtocolBench bench("unet");
  EXPECT_THAT(bench.ask(datagram_of(300'000, true)), HasSubstr("data too long"));
  for (const bool data_first : {false, true}) {
    EXPECT_THAT(bench.ask(datagram_of(1'100'000, data_first)),
                AllOf(HasSubstr("org.arl.unet.RefuseRsp"), HasSubstr("longer than 1048576 bytes"),
                      HasSubstr(R"("inReplyTo":"m7")"), HasSubstr(R"("recipient":"gateway-7")")));
  }
  EXPECT_TRUE(bench.port.disconnected.empty());
  bench.ask(std::string(1'100'000, 'x') + "\n");
  EXPECT_EQ(bench.port.disconnected, std::vector<ClientId>{testing::ProtocolBench::kHost})
      << "nobody to answer";
}

TEST(Unet, DeepNestingHarmsNothing) {
  testing::ProtocolBench bench("unet");
  for (const std::string open : {"[", "{\"a\":"}) {
    std::string deep = R"({"action":"send","message":{"clazz":"DatagramReq","data":{"msgID":"m",)"
                       R"("sender":"g","recipient":"phy","x":)";
    for (int i = 0; i < 200'000; ++i) deep += open;
    bench.ask(deep + "\n");
    deep += std::string(200'000, open == "[" ? ']' : '}');
    bench.ask(deep + "}}}\n");
  }
  EXPECT_THAT(bench.ask("{\"action\":\"agents\",\"id\":\"1\"}\n"), HasSubstr("agentIDs"));
}

}  // namespace
}  // namespace halocline::modem_gateway

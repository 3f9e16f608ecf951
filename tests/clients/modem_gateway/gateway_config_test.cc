// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem_gateway/gateway_config.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/config/config.h"
#include "core/check.h"
#include "core/sim_time.h"

namespace halocline::modem_gateway {
namespace {

using ::testing::HasSubstr;

constexpr auto kVehicles = R"(
[[vehicle]]
name = "auv-1"
id = 1
[[vehicle]]
name = "buoy"
id = 9
)";

GatewayConfig read(const std::string& interfaces) {
  auto file = bus::ConfigFile::parse(kVehicles + interfaces, "test.toml", {});
  GatewayConfig config;
  file.read([&](bus::ConfigVisitor& v) { visit(v, config); });
  file.check(/*whole_file=*/false);
  return config;
}

TEST(GatewayConfig, KnowsTheClocksOfVehicles) {
  const GatewayConfig config = read(
      "[[vehicle]]\nname = \"late\"\nid = 7\n[vehicle.clock]\noffset_s = 0.5\ndrift_ppm = 2\n"
      "[channel_server]\nstate_lag_s = 0.125\n");
  const auto& clocks = config.clocks.clocks;
  ASSERT_EQ(clocks.size(), 1u);
  EXPECT_EQ(clocks[0].vehicle, "late");
  EXPECT_EQ(clocks[0].id, 7);
  EXPECT_EQ(clocks[0].settings.offset_s, 0.5);
  EXPECT_EQ(clocks[0].settings.drift, 2e-6);
  EXPECT_EQ(config.clocks.fix_lag, SimDuration::from_milliseconds(125));
}

std::string errors_of(const std::string& interfaces) {
  try {
    read(interfaces);
  } catch (const bus::ConfigErrors& errors) {
    return errors.what();
  }
  return "";
}

TEST(GatewayConfig, AModemInterfaceNamesVehicleKindAndPlace) {
  const GatewayConfig config = read(R"(
[[modem_interface]]
vehicle = "buoy"
kind = "nm3"
place = "tcp:9600"
addresses = "auv-1=7"
options = "timestamps=yes"
)");
  ASSERT_EQ(config.interfaces.size(), 1u);
  EXPECT_EQ(config.interfaces[0].vehicle_id, 9);
  EXPECT_EQ(config.interfaces[0].place.port, 9600);
  EXPECT_EQ(config.interfaces[0].place.host, "127.0.0.1");
}

TEST(GatewayConfig, EachMistakeIsNamedWithItsLineAndWhatIsAllowed) {
  const std::string errors = errors_of(R"(
[[modem_interface]]
vehicle = "nobody"
kind = "nm3"
place = "udp:1"
options = "colour=red"
addresses = "auv-1=x"
)");
  EXPECT_THAT(errors, HasSubstr("test.toml:12: modem_interface[0].place"));
  EXPECT_THAT(errors, HasSubstr("name of a vehicle of the scenario"));
  EXPECT_THAT(errors, HasSubstr("allowed are tcp:PORT"));
  EXPECT_THAT(errors, HasSubstr("allowed are timestamps"));
  EXPECT_THAT(errors, HasSubstr("VEHICLE=ADDRESS"));
  EXPECT_THAT(errors_of("[[modem_interface]]\nvehicle = \"buoy\"\nkind = \"fax\"\n"), HasSubstr("nm3"));
  EXPECT_THAT(errors_of("[[modem_interface]]\nvehicle = \"buoy\"\n"), HasSubstr("must be given"));
}

TEST(GatewayConfig, TranspondersOfAModemInterfaceAreVehiclesThatAnswerPingsToAll) {
  const std::string interface =
      "[[modem_interface]]\nvehicle = \"buoy\"\nkind = \"micromodem\"\nplace = \"tcp:9600\"\naddresses = "
      "\"auv-1=3\"\n"
      "options = \"lbl=3/4\"\n";
  const std::string vehicle = "[[vehicle]]\nname = \"beacon\"\nid = 4\n";
  EXPECT_THAT(errors_of(vehicle + interface),
              HasSubstr("modem_interface[0].options is 'lbl=3/4'; they name auv-1 as a transponder"));
  std::string answering = interface;
  answering.replace(answering.find("auv-1=3"), 7, "first=3");
  EXPECT_EQ(errors_of("[[vehicle]]\nname = \"first\"\nid = 5\ntransponder = true\n" + vehicle +
                      "transponder = true\n" + answering),
            "");
  EXPECT_THAT(errors_of(vehicle + "transponder = true\n" + interface),
              HasSubstr("allowed is a vehicle with transponder = true"));
}

TEST(GatewayConfig, TwoHaveTwoPlaces) {
  const std::string interface =
      "[[modem_interface]]\nvehicle = \"buoy\"\nkind = \"nm3\"\nplace = \"tcp:9600\"\n";
  EXPECT_THAT(errors_of(interface + interface), HasSubstr("another modem interface has this place"));
}

TEST(GatewayConfig, PlacesSurviveTheRoundTrip) {
  for (const auto* text : {"tcp:9600", "tcp:0.0.0.0:9600", "pty:/tmp/modem"})
    EXPECT_EQ(place_of(text).text(), text);
  for (const auto* wrong : {"", "tcp:", "tcp:70000", "tcp:here:9600", "pty:", "9600"})
    EXPECT_THROW(place_of(wrong), InvalidArgument) << wrong;
}

TEST(GatewayConfig, TheCommandLineAddsModemInterfaces) {
  GatewayConfig config = read("");
  add_interface(config, "auv-1=nm3:tcp:9600");
  add_interface(config, "buoy=nm3:pty:/tmp/modem");
  ASSERT_EQ(config.interfaces.size(), 2u);
  EXPECT_EQ(config.interfaces[0].vehicle_id, 1);
  EXPECT_EQ(config.interfaces[1].place.path, "/tmp/modem");
  for (const auto* wrong :
       {"auv-1", "auv-1=nm3", "auv-2=nm3:tcp:9600", "auv-1=fax:tcp:9600", "auv-1=nm3:tcp:x"})
    EXPECT_THROW(add_interface(config, wrong), InvalidArgument) << wrong;
}

}  // namespace
}  // namespace halocline::modem_gateway

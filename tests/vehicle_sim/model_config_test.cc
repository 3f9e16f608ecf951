// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/model_config.h"

#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/sim_time.h"
#include "vehicle_sim/dynamics/equations_of_motion.h"
#include "vehicle_sim/dynamics/remus100_pvs.h"
#include "vehicle_sim/dynamics/vehicle_state.h"
#include "vehicle_sim/model_library.h"

namespace halocline::vehicle_sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kVehicles = std::string(HALOCLINE_SOURCE_DIR) + "/models/vehicles";

std::string errors_of(const std::string& text) {
  try {
    parse_model(text, "mine.toml");
  } catch (const bus::ConfigErrors& errors) {
    return errors.what();
  }
  return "";
}

class ShippedModel : public ::testing::TestWithParam<std::string> {};

// Every number is written with all its digits, so equal texts are equal models.
TEST_P(ShippedModel, FileEqualsTheBuiltInModel) {
  EXPECT_EQ(model_toml(load_model(kVehicles + ("/" + GetParam() + ".toml"))),
            model_toml(load_model(GetParam())));
}

TEST_P(ShippedModel, FileGivesASourceForEachSection) {
  std::ifstream file(kVehicles + "/" + GetParam() + ".toml");
  bool sourced = false;
  for (std::string line; std::getline(file, line);) {
    if (line.find("ource") != std::string::npos) sourced = true;
    const bool opens = line.starts_with("[") && !line.starts_with("[[");  // thrusters share the first one's
    if (opens) {
      EXPECT_TRUE(sourced) << line;
      sourced = false;
    }
  }
}

TEST_P(ShippedModel, SurvivesBeingWrittenAndRead) {
  const ModelFile written = load_model(GetParam());
  const Model before(written.parameters), after(parse_model(model_toml(written), "written").parameters);
  EXPECT_EQ(before.mass(), after.mass());
  VehicleState s;
  s.velocity_body << 1, 0.2, -0.1, 0.05, 0.1, -0.2;
  s.actuators = {0.1, -0.1, 15, {10, -20, 30, 5}};
  EXPECT_EQ(acceleration(before, s, {}), acceleration(after, s, {}));
}

INSTANTIATE_TEST_SUITE_P(All, ShippedModel, ::testing::ValuesIn(built_in_models()), [](const auto& test) {
  std::string name = test.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(ModelConfig, AFileChangesWhatItNamesOfItsBase) {
  const ModelFile file = parse_model("based_on = \"torpedo\"\n[body]\nmass_kg = 33\n", "mine.toml");
  EXPECT_EQ(file.parameters.mass_kg, 33);
  EXPECT_EQ(file.parameters.buoyancy_n, load_model("torpedo").parameters.buoyancy_n);
  EXPECT_FALSE(file.sensors.has_value());
}

TEST(ModelConfig, AFileMaySetTheSensorsThatTheVehicleCarries) {
  const ModelFile file = parse_model("based_on = \"torpedo\"\n[sensors.dvl]\nrate_hz = 4\n", "mine.toml");
  ASSERT_TRUE(file.sensors.has_value());
  EXPECT_EQ(file.sensors->dvl.period, SimDuration::from_milliseconds(250));
  EXPECT_EQ(parse_model(model_toml(file), "written").sensors, file.sensors);
  EXPECT_THAT(errors_of("based_on = \"torpedo\"\n[sensors.dvl]\nrate = 4\n"),
              AllOf(HasSubstr("mine.toml:3"), HasSubstr("sensors.dvl.rate")));
}

TEST(ModelConfig, AnUnknownKeyIsNamedWithItsLine) {
  EXPECT_THAT(errors_of("based_on = \"torpedo\"\n[body]\nmas_kg = 3\n"),
              AllOf(HasSubstr("mine.toml:3"), HasSubstr("body.mas_kg")));
}

TEST(ModelConfig, AWrongTypeAndAnImpossibleValueAreBothReported) {
  EXPECT_THAT(errors_of("based_on = \"torpedo\"\n[body]\nmass_kg = \"much\"\n[propeller]\nlag_s = -1\n"),
              AllOf(HasSubstr("mine.toml:3: body.mass_kg"), HasSubstr("mine.toml:5: propeller.lag_s"),
                    HasSubstr("allowed is 0.001 to 1000 s")));
}

TEST(ModelConfig, AnUnknownBaseIsRefusedWithTheNamesThereAre) {
  EXPECT_THAT(errors_of("based_on = \"boat\"\n"),
              AllOf(HasSubstr("mine.toml:1"), HasSubstr("torpedo, hover")));
}

TEST(ModelConfig, AVehicleImpossibleAsAWholeIsRefused) {
  EXPECT_THAT(errors_of("based_on = \"torpedo\"\nname = \"x\"\n[body]\ndiameter_m = 2\n"),
              HasSubstr("hull diameter"));
  EXPECT_THAT(errors_of("name = \"x\"\n[body]\nlength_m = 1\ndiameter_m = 0.1\nmass_kg = 1\n"
                        "added_mass_off_diagonal = [9,0,0,0,0, 0,0,0,0, 0,0,0, 0,0, 0]\n"),
              HasSubstr("positive definite"));
}

TEST(ModelConfig, TooShortAListIsRefused) {
  EXPECT_THAT(errors_of("based_on = \"torpedo\"\n[damping]\nlinear = [1, 2]\n"),
              AllOf(HasSubstr("mine.toml:3"), HasSubstr("six numbers")));
  EXPECT_THAT(errors_of("based_on = \"torpedo\"\n[body]\nadded_mass = [1]\n"), HasSubstr("mine.toml:3"));
}

TEST(ModelConfig, AThrusterMustHaveADirection) {
  EXPECT_THAT(errors_of("based_on = \"hover\"\nname = \"x\"\n[[thruster]]\ndirection = [0, 0, 0]\n"),
              HasSubstr("direction"));
}

TEST(ModelConfig, AFifthThrusterIsRefused) {
  std::string text = "based_on = \"hover\"\nname = \"x\"\n";
  for (int i = 0; i < 5; ++i) text += "[[thruster]]\n";
  EXPECT_THAT(errors_of(text), HasSubstr("4 thrusters at most"));
}

TEST(ModelConfig, ANameThatIsNoneIsRefused) {
  EXPECT_THROW(load_model("boat"), InvalidArgument);
  EXPECT_THROW(load_model(kVehicles + "/missing.toml"), bus::ConfigErrors);
}

}  // namespace
}  // namespace halocline::vehicle_sim

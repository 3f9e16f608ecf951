// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/arrivals/sea_files.h"

#include <functional>
#include <sstream>

#include <gmock/gmock.h>

#include "acoustics/sea/absorption.h"
#include "core/check.h"

namespace halocline::clients {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string what_is_wrong(const std::function<void()>& act) {
  try {
    act();
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

SeaDescription still_water() {
  SeaDescription sea;
  sea.sound_speed_mps = 1500;
  sea.bottom_depth_m = 100;
  return sea;
}

TEST(SeaFiles, LinksAreReadByTheNamesOfTheReferenceColumns) {
  std::istringstream in("rcv_range_m,src_depth_m,note,rcv_depth_m\n2000,30,far,50\n# none\n10,1,near,2\n");
  const auto links = read_links(in, "links.csv");
  ASSERT_EQ(links.size(), 2u);
  EXPECT_EQ(links[0].source_depth_m, 30);
  EXPECT_EQ(links[0].receiver_depth_m, 50);
  EXPECT_EQ(links[0].range_m, 2000);
  EXPECT_EQ(links[1].range_m, 10);
}

TEST(SeaFiles, EveryFaultOfATableIsNamedWithItsLine) {
  std::istringstream in("range_m,depth_m\n0,a hundred\n10,90\nnan,80\n");
  EXPECT_THAT(what_is_wrong([&] { read_bottom_profile(in, "ridge.csv"); }),
              AllOf(HasSubstr("ridge.csv"), HasSubstr("line 2: depth_m"), HasSubstr("line 4: range_m")));
}

TEST(SeaFiles, AMissingColumnIsNamed) {
  std::istringstream in("range,depth_m\n0,100\n");
  EXPECT_THAT(what_is_wrong([&] { read_bottom_profile(in, "ridge.csv"); }), HasSubstr("range_m is missing"));
}

TEST(SeaFiles, ASedimentTakesThePlaceOfTheThreeNumbers) {
  SeaDescription sea = still_water();
  sea.sediment = "MediumSand";
  EXPECT_EQ(make_sea(sea).bottom, *acoustics::sediment("MediumSand"));
  EXPECT_EQ(make_sea(still_water()).bottom, acoustics::fluid_bottom(1.9, 1650, 0.8));
}

TEST(SeaFiles, ThePathLossOfAbsorptionIsThatOfTheFormula) {
  SeaDescription sea = still_water();
  sea.absorption = "thorp";
  const auto paths = acoustics::eigenrays(make_sea(sea), {30, 30, 1000}).paths;
  ASSERT_FALSE(paths.empty());
  // 1 km of the direct path; the water is the same everywhere.
  EXPECT_NEAR(
      paths[0].absorption_db,
      acoustics::absorption_db_per_km(acoustics::AbsorptionModel::kThorp1967, {10, 35, 30, 4, 8}, 25e3),
      1e-9);
}

TEST(SeaFiles, AGridOfWaterNeedsAPlace) {
  SeaDescription sea = still_water();
  sea.sound_speed_mps.reset();
  sea.water = "model.nc";
  EXPECT_THAT(what_is_wrong([&] { make_sea(sea); }),
              HasSubstr("model.nc is a grid of water: give the place in it by --latitude and --longitude"));
  sea.latitude_deg = 45;
  sea.longitude_deg = 0;
  EXPECT_THAT(what_is_wrong([&] { make_sea(sea); }),
              HasSubstr("cannot read model.nc: there is no such file"));
}

TEST(SeaFiles, ImpossibleOptionsAreRefusedWithWhatIsAllowed) {
  SeaDescription sea = still_water();
  sea.water = "munk";
  EXPECT_THAT(what_is_wrong([&] { make_sea(sea); }), HasSubstr("give the water"));
  sea = still_water();
  sea.absorption = "thorpe";
  EXPECT_THAT(what_is_wrong([&] { make_sea(sea); }), HasSubstr("fisher-simmons"));
  sea = still_water();
  sea.sediment = "Lava";
  EXPECT_THAT(what_is_wrong([&] { make_sea(sea); }), HasSubstr("MediumSand"));
  sea = still_water();
  sea.surface = "mirror";
  EXPECT_THAT(what_is_wrong([&] { make_sea(sea); }), HasSubstr("apl-bubbles"));
  sea = still_water();
  sea.max_bounces = -1;
  EXPECT_THAT(what_is_wrong([&] { make_sea(sea); }), HasSubstr("bounces"));
}

}  // namespace
}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
#include "clients/halocline/export/mission_export.h"

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "clients/halocline/export/mcap_writer.h"
#include "core/check.h"
#include "tests/clients/mission/mission_fixtures.h"
#include "tests/support/file_size_limit.h"

namespace halocline::clients {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class MissionExport : public ::testing::Test {
 protected:
  MissionExport() {
    for (int s = 0; s <= 3; ++s) {
      testing::add(mission_, "STATE.auv-1", testing::state(1, s * testing::kSecond, 1000 * s, 0, 20));
      testing::add(mission_, "STATE.auv-2", testing::state(2, s * testing::kSecond, 0, 500, 30));
    }
    testing::add(mission_, "OUTCOME", testing::outcome(1, 2, 0, testing::kSecond));
  }
  ~MissionExport() override { std::filesystem::remove(path_); }

  std::string contents() const {
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::string path_ =
      (std::filesystem::temp_directory_path() / ("halocline_export_" + std::to_string(::getpid()))).string();
  MissionStore mission_;
};

TEST(Crc32, IsThatOfZlib) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926U);
  EXPECT_EQ(crc32("6789", crc32("12345")), 0xCBF43926U);
}

TEST_F(MissionExport, OriginIsReadAndRefused) {
  EXPECT_THROW(export_gpx(mission_, path_), InvalidArgument);
  for (const char* wrong : {"", "43.5", "43.5,", "43.5,7 ", "95,7", "43,7,1", "north,east"})
    EXPECT_THROW(set_origin(mission_, wrong), InvalidArgument) << wrong;
  set_origin(mission_, "43.5,-7.25");
  EXPECT_EQ(mission_.scenario().origin_longitude_deg, -7.25);
}

TEST_F(MissionExport, GeoJsonHasALineAVehicle) {
  set_origin(mission_, "30,-28");
  export_geojson(mission_, path_);
  const json features = json::parse(contents())["features"];
  ASSERT_EQ(features.size(), 2u);
  const json& line = features[0]["geometry"];
  EXPECT_EQ(line["type"], "LineString");
  EXPECT_EQ(line["coordinates"].size(), 4u);
  EXPECT_NEAR(line["coordinates"][3][1].get<double>(), 30.02706, 1e-5);
  EXPECT_NEAR(line["coordinates"][0][1].get<double>(), 30, 1e-9);
  EXPECT_EQ(line["coordinates"][0][2], -20);
  EXPECT_EQ(features[1]["properties"]["name"], "auv-2");
  EXPECT_EQ(features[1]["properties"]["time_s"], json({0, 1, 2, 3}));
}

TEST_F(MissionExport, GpxHasTimesAndHeights) {
  set_origin(mission_, "30,-28");
  export_gpx(mission_, path_);
  EXPECT_THAT(contents(), HasSubstr("<trk><name>auv-1</name>"));
  EXPECT_THAT(
      contents(),
      HasSubstr("<trkpt lat=\"30.00000000\" "
                "lon=\"-28.00000000\"><ele>-20.00</ele><time>1970-01-01T00:00:00.000Z</time></trkpt>"));
}

TEST_F(MissionExport, NetcdfHoldsTrajectories) {
  set_origin(mission_, "30,-28");
  export_netcdf(mission_, path_);
  int file = 0, variable = 0;
  ASSERT_EQ(nc_open(path_.c_str(), NC_NOWRITE, &file), NC_NOERR);
  std::vector<int> sizes(2);
  ASSERT_EQ(nc_inq_varid(file, "rowSize", &variable), NC_NOERR);
  ASSERT_EQ(nc_get_var_int(file, variable, sizes.data()), NC_NOERR);
  EXPECT_EQ(sizes, (std::vector<int>{4, 4}));
  std::vector<double> values(8);
  ASSERT_EQ(nc_inq_varid(file, "depth", &variable), NC_NOERR);
  ASSERT_EQ(nc_get_var_double(file, variable, values.data()), NC_NOERR);
  EXPECT_EQ(values[4], 30);
  char text[64] = {};
  ASSERT_EQ(nc_get_att_text(file, NC_GLOBAL, "featureType", text), NC_NOERR);
  EXPECT_STREQ(text, "trajectory");
  ASSERT_EQ(nc_inq_varid(file, "lat", &variable), NC_NOERR);
  ASSERT_EQ(nc_get_var_double(file, variable, values.data()), NC_NOERR);
  EXPECT_NEAR(values[3], 30.02706, 1e-5);
  nc_close(file);
}

TEST_F(MissionExport, McapBeginsAndEndsWithItsMagic) {
  export_mcap(mission_, path_);
  const std::string bytes = contents(), magic("\x89MCAP0\r\n", 8);
  EXPECT_EQ(bytes.substr(0, 8), magic);
  EXPECT_EQ(bytes.substr(bytes.size() - 8), magic);
  EXPECT_THAT(bytes, HasSubstr("Received at auv-2"));
  EXPECT_THAT(bytes, ::testing::Not(HasSubstr("/position")));  // without an origin
}

TEST_F(MissionExport, AStateAYearLaterAddsAMinuteOfScenes) {
  testing::add(mission_, "STATE.auv-1", testing::state(1, 31'000'000 * testing::kSecond, 0, 0, 20));
  export_mcap(mission_, path_);
  EXPECT_LT(std::filesystem::file_size(path_), 1'000'000u);
}

TEST_F(MissionExport, FileThatCannotBeWrittenIsAnError) {
  EXPECT_THROW(export_mcap(mission_, "/nowhere/run.mcap"), std::runtime_error);
  EXPECT_THROW(export_netcdf(mission_, "/nowhere/run.nc"), std::runtime_error);
}

// As on a full disk, where HDF5 crashed.
TEST_F(MissionExport, NetcdfThatIsCutOffIsAnError) {
  const halocline::testing::FileSizeLimit full_disk(4096);
  EXPECT_THROW(export_netcdf(mission_, path_), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(MissionExport, APipeGetsTheFileAndStaysAPipe) {
  set_origin(mission_, "30,-28");
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  const int reader = open(path_.c_str(), O_RDWR | O_CLOEXEC);  // waits for no other end
  ASSERT_GT(fcntl(reader, F_SETPIPE_SZ, 1 << 20), 0);
  for (const auto write : {export_mcap, export_netcdf, export_geojson, export_gpx}) {
    write(mission_, path_);
    EXPECT_TRUE(std::filesystem::is_fifo(path_));
  }
  close(reader);
}

}  // namespace
}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/export/run_export.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "core/check.h"
#include "runs/export/date_line.h"
#include "runs/export/mcap_writer.h"
#include "tests/runs/timeline/timeline_fixtures.h"
#include "tests/support/file_size_limit.h"

namespace halocline::clients {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class RunExport : public ::testing::Test {
 protected:
  RunExport() {
    for (int s = 0; s <= 3; ++s) {
      testing::add(timeline_, "STATE.auv-1", testing::state(1, s * testing::kSecond, 1000 * s, 0, 20));
      testing::add(timeline_, "STATE.auv-2", testing::state(2, s * testing::kSecond, 0, 500, 30));
    }
    testing::add(timeline_, "OUTCOME", testing::outcome(1, 2, 0, testing::kSecond));
  }
  ~RunExport() override { std::filesystem::remove(path_); }

  std::string contents() const {
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::string path_ =
      (std::filesystem::temp_directory_path() / ("halocline_export_" + std::to_string(::getpid()))).string();
  RunTimeline timeline_;
};

TEST(Crc32, IsThatOfZlib) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926U);
  EXPECT_EQ(crc32("6789", crc32("12345")), 0xCBF43926U);
}

TEST_F(RunExport, OriginIsReadAndRefused) {
  EXPECT_THROW(export_gpx(timeline_, path_), InvalidArgument);
  for (const char* wrong : {"", "43.5", "43.5,", "43.5,7 ", "95,7", "43,7,1", "north,east"})
    EXPECT_THROW(set_origin(timeline_, wrong), InvalidArgument) << wrong;
  set_origin(timeline_, "43.5,-7.25");
  EXPECT_EQ(timeline_.scenario().origin->longitude_deg, -7.25);
}

TEST_F(RunExport, GeoJsonHasALineAVehicle) {
  set_origin(timeline_, "30,-28");
  export_geojson(timeline_, path_);
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

// RFC 7946, 3.1.9: no line crosses the meridian of 180 degrees.
TEST_F(RunExport, GeoJsonLinesAreCutAtTheDateLine) {
  for (int s = 0; s <= 4; ++s)
    testing::add(timeline_, "STATE.east", testing::state(3, s * testing::kSecond, 100 * s, 60 * s, 10 + s));
  set_origin(timeline_, "-17.4,179.999");  // 106.3 m east of it is the meridian
  export_geojson(timeline_, path_);
  const json feature = json::parse(contents())["features"][2], pieces = feature["geometry"]["coordinates"];
  EXPECT_EQ(feature["geometry"]["type"], "MultiLineString");
  ASSERT_EQ(pieces.size(), 2u);
  ASSERT_EQ(pieces[0].size(), 3u);
  ASSERT_EQ(pieces[1].size(), 4u);
  EXPECT_EQ(pieces[0].back()[0], 180);
  EXPECT_EQ(pieces[1].front()[0], -180);
  const double share = 106.3 / 60 - 1;  // of the way from the second state to the third
  EXPECT_EQ(pieces[0].back()[1], pieces[1].front()[1]);
  EXPECT_NEAR(pieces[0].back()[1].get<double>(), -17.4 + 100 * (1 + share) / 110'650, 1e-6);
  EXPECT_NEAR(pieces[0].back()[2].get<double>(), -11 - share, 1e-2);
  const json& times = feature["properties"]["time_s"];
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].size(), 3u);
  EXPECT_NEAR(times[1].front().get<double>(), 1 + share, 1e-2);
  for (const json& piece : pieces) {
    for (std::size_t i = 1; i < piece.size(); ++i)
      EXPECT_LT(std::abs(piece[i][0].get<double>() - piece[i - 1][0].get<double>()), 1);
  }
}

TEST(DateLine, ALineToAndFroIsCutAtEachCrossing) {
  const std::vector<LinePlace> line{{179, 0, 0, 0}, {-179, 2, 4, 1}, {-178, 2, 4, 2}, {178, 2, 4, 3}};
  const auto pieces = cut_at_date_line(line);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(pieces[0].back().latitude_deg, 1);
  EXPECT_EQ(pieces[0].back().time_s, 0.5);
  EXPECT_EQ(pieces[1].size(), 4u);
  EXPECT_EQ(pieces[1].back().longitude_deg, -180);
  EXPECT_EQ(pieces[2].front().longitude_deg, 180);
  EXPECT_EQ(pieces[2].front().height_m, 4);
}

TEST(DateLine, EachPieceHasTwoPlacesAndNoneTwice) {
  for (const double first : {180.0, -180.0}) {
    const auto begins = cut_at_date_line({{first, 0, 0, 0}, {-179.5, 0, 0, 1}, {-179, 0, 0, 2}});
    ASSERT_EQ(begins.size(), 1u) << first;
    EXPECT_EQ(begins[0].size(), 3u);
    const auto ends = cut_at_date_line({{179, 0, 0, 0}, {179.5, 0, 0, 1}, {first, 0, 0, 2}});
    ASSERT_EQ(ends.size(), 1u) << first;
    EXPECT_EQ(ends[0].size(), 3u);
  }
  EXPECT_EQ(cut_at_date_line({{0, 0, 0, 0}, {90, 0, 0, 1}, {-90, 0, 0, 2}}).size(), 1u);  // through 0
}

TEST_F(RunExport, ZeroZeroIsAPlace) {
  set_origin(timeline_, "0,0");
  export_gpx(timeline_, path_);
  EXPECT_THAT(contents(), HasSubstr("lat=\"0.00000000\" lon=\"0.00000000\""));
}

// Of times in microseconds as many are within 0.5 ms before a whole millisecond as after it.
TEST_F(RunExport, GpxTimesAreTheNearestMillisecond) {
  for (int i = 0; i < 1000; ++i)
    testing::add(timeline_, "STATE.auv-3", testing::state(3, 100'000LL * i, 0, 0, 0));
  testing::add(timeline_, "STATE.auv-3", testing::state(3, 200'000'499, 0, 0, 0));
  testing::add(timeline_, "STATE.auv-3", testing::state(3, 299'999'500, 0, 0, 0));
  set_origin(timeline_, "30,-28");
  export_gpx(timeline_, path_);
  const std::string text = contents();
  for (int i = 0; i < 1000; ++i)
    EXPECT_THAT(text, HasSubstr(fmt::format("00:{:02}:{:02}.{}00Z", i / 600, i / 10 % 60, i % 10)));
  EXPECT_THAT(text, HasSubstr("00:03:20.000Z"));
  EXPECT_THAT(text, HasSubstr("00:05:00.000Z"));
}

// GPX 1.1: -180 <= longitude < 180.
TEST_F(RunExport, GpxHasNo180East) {
  set_origin(timeline_, "0,180");
  export_gpx(timeline_, path_);
  EXPECT_THAT(contents(), ::testing::Not(HasSubstr("lon=\"180.")));
}

TEST_F(RunExport, GpxHasTimesAndHeights) {
  set_origin(timeline_, "30,-28");
  export_gpx(timeline_, path_);
  EXPECT_THAT(contents(), HasSubstr("<trk><name>auv-1</name>"));
  EXPECT_THAT(
      contents(),
      HasSubstr("<trkpt lat=\"30.00000000\" "
                "lon=\"-28.00000000\"><ele>-20.00</ele><time>1970-01-01T00:00:00.000Z</time></trkpt>"));
}

TEST_F(RunExport, NetcdfHoldsTrajectories) {
  set_origin(timeline_, "30,-28");
  export_netcdf(timeline_, path_);
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

TEST_F(RunExport, McapBeginsAndEndsWithItsMagic) {
  export_mcap(timeline_, path_);
  const std::string bytes = contents(), magic("\x89MCAP0\r\n", 8);
  EXPECT_EQ(bytes.substr(0, 8), magic);
  EXPECT_EQ(bytes.substr(bytes.size() - 8), magic);
  EXPECT_THAT(bytes, HasSubstr("Received at auv-2"));
  EXPECT_THAT(bytes, ::testing::Not(HasSubstr("/position")));  // without an origin
}

TEST_F(RunExport, AStateAYearLaterAddsAMinuteOfScenes) {
  testing::add(timeline_, "STATE.auv-1", testing::state(1, 31'000'000 * testing::kSecond, 0, 0, 20));
  export_mcap(timeline_, path_);
  EXPECT_LT(std::filesystem::file_size(path_), 1'000'000u);
}

TEST_F(RunExport, FileThatCannotBeWrittenIsAnError) {
  EXPECT_THROW(export_mcap(timeline_, "/nowhere/run.mcap"), std::runtime_error);
  EXPECT_THROW(export_netcdf(timeline_, "/nowhere/run.nc"), std::runtime_error);
}

// As on a full disk, where HDF5 crashed.
TEST_F(RunExport, AFullDiskIsAnErrorAndLeavesTheOldFile) {
  set_origin(timeline_, "30,-28");
  for (const auto write : {export_mcap, export_netcdf, export_geojson, export_gpx}) {
    std::filesystem::remove(path_);
    {
      const halocline::testing::FileSizeLimit full_disk(200);
      EXPECT_THROW(write(timeline_, path_), std::runtime_error);
    }
    EXPECT_FALSE(std::filesystem::exists(path_));
    write(timeline_, path_);
    const std::string before = contents();
    const halocline::testing::FileSizeLimit full_disk(200);
    EXPECT_THROW(write(timeline_, path_), std::runtime_error);
    EXPECT_EQ(contents(), before);
    EXPECT_FALSE(std::filesystem::exists(path_ + ".unfinished"));
  }
}

TEST_F(RunExport, APipeGetsTheFileAndStaysAPipe) {
  set_origin(timeline_, "30,-28");
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  const int reader = open(path_.c_str(), O_RDWR | O_CLOEXEC);  // waits for no other end
  ASSERT_GT(fcntl(reader, F_SETPIPE_SZ, 1 << 20), 0);
  for (const auto write : {export_mcap, export_netcdf, export_geojson, export_gpx}) {
    write(timeline_, path_);
    EXPECT_TRUE(std::filesystem::is_fifo(path_));
  }
  close(reader);
}

}  // namespace
}  // namespace halocline::clients

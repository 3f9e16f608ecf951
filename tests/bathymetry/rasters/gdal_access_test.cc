// SPDX-License-Identifier: BSD-3-Clause
// A raster comes from a stranger: nothing in it may reach the network, or keep the program waiting.
#include <array>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bathymetry/rasters/raster_loader.h"
#include "core/check.h"
#include "tests/bathymetry/rasters/raster_fixtures.h"
#include "tests/support/channel_file.h"

namespace halocline::bathymetry {
namespace {

using testing::around_origin;
using testing::frame_at;
using ::testing::HasSubstr;

// A server that counts who comes, and answers nobody.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    bind(socket_, reinterpret_cast<sockaddr*>(&address), size);
    listen(socket_, 8);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/x";
  }
  ~Listener() { close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  const std::string& url() const { return url_; }
  int visitors() const {
    int count = 0;
    for (int one; (one = accept(socket_, nullptr, nullptr)) >= 0; ++count) close(one);
    return count;
  }

 private:
  int socket_;
  std::string url_;
};

std::string refusal(const std::string& path) {
  try {
    load_raster({.path = path}, frame_at(43.2, 7.3), around_origin(100, 10));
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "loaded";
}

std::string written(const std::string& name, const std::string& text) {
  const std::string path = ::testing::TempDir() + "access-" + std::to_string(getpid()) + "-" + name;
  std::ofstream(path) << text;
  return path;
}

std::string virtual_raster(const std::string& source) {
  return "<VRTDataset rasterXSize=\"4\" rasterYSize=\"4\"><GeoTransform>7, 0.1, 0, 43.4, 0, "
         "-0.1</GeoTransform>"
         "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename relativeToVRT=\"0\">" +
         source + "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
}

std::string map_service(const std::string& url) {
  return "<GDAL_WMS><Service name=\"WMS\"><Version>1.1.1</Version><ServerUrl>" + url +
         "?</ServerUrl><SRS>EPSG:4326</SRS><ImageFormat>image/tiff</ImageFormat><Layers>a</Layers></Service>"
         "<DataWindow><UpperLeftX>7</UpperLeftX><UpperLeftY>44</UpperLeftY><LowerRightX>8</LowerRightX>"
         "<LowerRightY>43</LowerRightY><SizeX>100</SizeX><SizeY>100</SizeY></DataWindow><BandsCount>1</"
         "BandsCount>"
         "<DataType>Float32</DataType></GDAL_WMS>";
}

// GDAL reads netCDF-4 and BAG by the same library.
TEST(GdalAccess, SurvivesAFileThatHdf5DiesOf) {
  const std::string path =
      halocline::testing::write_channel_file(halocline::testing::channel_file(4, 1, 2), "no_names.bag");
  halocline::testing::lose_names(path);
  EXPECT_THAT(refusal(path), HasSubstr(path + " is damaged: the library that reads it crashes on it"));
}

TEST(GdalAccess, NoNameOfAServerIsFollowed) {
  const Listener server;
  for (const std::string& name :
       {"/vsicurl/" + server.url() + ".tif", "/vsicurl_streaming/" + server.url() + ".tif",
        "/vsigzip//vsicurl/" + server.url() + ".gz", "/vsizip/{/vsicurl/" + server.url() + ".zip}/a.tif",
        server.url() + ".tif", "NETCDF:\"" + server.url() + "\":z", "WMS:" + server.url(),
        map_service(server.url()), virtual_raster("/vsicurl/" + server.url())}) {
    EXPECT_THAT(refusal(name), HasSubstr("cannot read")) << name;
  }
  EXPECT_EQ(server.visitors(), 0);
}

TEST(GdalAccess, NoFileThatNamesAServerIsFollowed) {
  const Listener server;
  const std::vector<std::string> files{
      written("map.xml", map_service(server.url())),
      written("tiles.wms", map_service(server.url())),
      written("curl.vrt", virtual_raster("/vsicurl/" + server.url() + ".tif")),
      written("plain.vrt", virtual_raster(server.url() + ".tif")),
      written("dap.vrt", virtual_raster("NETCDF:&quot;" + server.url() + "&quot;:z")),
      written("named.tif", virtual_raster("/vsicurl/" + server.url() + ".tif"))};
  for (const std::string& file : files)
    EXPECT_THAT(refusal(file), HasSubstr("cannot read the raster")) << file;
  EXPECT_EQ(server.visitors(), 0);
}

// Overviews and masks beside a raster may be named in its .aux.xml.
TEST(GdalAccess, WhatStandsBesideARasterIsNotFollowedToAServer) {
  const Listener server;
  const std::string path = written(
      "beside.asc",
      "ncols 3\nnrows 3\nxllcorner 7.2\nyllcorner 43.1\ncellsize 0.1\n-1 -2 -3\n-4 -5 -6\n-7 -8 -9\n");
  std::ofstream(path + ".aux.xml")
      << "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">/vsicurl/" << server.url()
      << ".ovr</MDI></Metadata></PAMDataset>";
  EXPECT_EQ(refusal(path), "loaded");
  EXPECT_EQ(server.visitors(), 0);
}

TEST(GdalAccess, ACoordinateSystemIsNoAddressAndNoFile) {
  const Listener server;
  const std::string pipe = written("system.prj", "");
  unlink(pipe.c_str());
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  testing::TestRaster raster{.name = "unnamed_system",
                             .columns = 4,
                             .rows = 4,
                             .geotransform = std::array<double, 6>{7, 0.2, 0, 43.6, 0, -0.2},
                             .coordinate_system = ""};
  const std::string path = testing::write_raster(raster, [](int, int) { return -100.0; });
  for (const std::string& system : {server.url(), "/vsicurl/" + server.url(), pipe}) {
    try {
      load_raster({.path = path, .coordinate_system = system}, frame_at(43.2, 7.3), around_origin(100, 10));
      FAIL() << system;
    } catch (const InvalidArgument& error) {
      EXPECT_THAT(error.what(), HasSubstr("is not known to PROJ"));
    }
  }
  EXPECT_EQ(server.visitors(), 0);
}

TEST(GdalAccess, APipeIsRefusedWithoutWaitingForAWriter) {
  const std::string pipe = written("pipe.tif", "");
  unlink(pipe.c_str());
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal(pipe), HasSubstr("it is a pipe; allowed is a regular file"));
  EXPECT_THAT(refusal(::testing::TempDir()), HasSubstr("it is a folder"));
  EXPECT_THAT(refusal("/vsistdin/"), HasSubstr("there is no such file"));
}

}  // namespace
}  // namespace halocline::bathymetry

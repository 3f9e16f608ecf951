// SPDX-License-Identifier: BSD-3-Clause
// What the programs link.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"

namespace halocline::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// GDAL brings 70 shared libraries and netCDF 40, which takes 80 ms at each start; modules load them where they are used.
TEST(Programs, LinkNeitherGdalNorNetcdf) {
  for (const char* program :
       {"halocline", "halocline-autopilot", "halocline-bathymetry", "halocline-channel-server",
        "halocline-conductor", "halocline-localiser", "halocline-modem-gateway", "halocline-network",
        "halocline-traffic", "halocline-vehicle-sim"}) {
    Process ldd({"/usr/bin/ldd", std::string(HALOCLINE_BIN_DIR) + "/" + program});
    EXPECT_EQ(ldd.wait(), 0) << program;
    EXPECT_THAT(ldd.output(), HasSubstr("libc.so")) << program;
    EXPECT_THAT(ldd.output(), Not(HasSubstr("libgdal"))) << program;
    EXPECT_THAT(ldd.output(), Not(HasSubstr("libnetcdf"))) << program;
  }
}

}  // namespace
}  // namespace halocline::testing

// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/netcdf_header.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <unistd.h>

#include "core/check.h"
#include "tests/ocean/sea_file.h"

namespace halocline::ocean {
namespace {

using ocean::testing::good;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;

std::string path_of(const std::string& name) {
  return ::testing::TempDir() + "header-" + std::to_string(getpid()) + "-" + name + ".nc";
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string verdict_on(const std::string& bytes) {
  const std::string path = path_of("bytes");
  std::ofstream(path, std::ios::binary) << bytes;
  try {
    require_whole_netcdf(path);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "whole";
}

struct Layout {
  int format = 0;  // flags of nc_create
  bool has_fixed = true;
  int record_variables = 1, records = 3;
};

// A fixed variable of 4 x 5 floats and records of 3 shorts, which are padded to 8 bytes unless they are
// alone.
std::string make(const Layout& layout) {
  const std::string path = path_of("made");
  int file = 0, time = 0, row = 0, column = 0;
  good(nc_create(path.c_str(), NC_CLOBBER | layout.format, &file));
  good(nc_def_dim(file, "time", NC_UNLIMITED, &time));
  good(nc_def_dim(file, "row", 4, &row));
  good(nc_def_dim(file, "column", 5, &column));
  int three = 0, fixed = 0;
  good(nc_def_dim(file, "three", 3, &three));
  const int on_fixed[2]{row, column}, on_records[2]{time, three};
  if (layout.has_fixed) good(nc_def_var(file, "bottom", NC_FLOAT, 2, on_fixed, &fixed));
  std::vector<int> records(static_cast<std::size_t>(layout.record_variables));
  for (std::size_t i = 0; i < records.size(); ++i)
    good(nc_def_var(file, ("record_" + std::to_string(i)).c_str(), NC_SHORT, 2, on_records, &records[i]));
  good(nc_put_att_text(file, NC_GLOBAL, "title", 5, "whole"));
  good(nc_enddef(file));
  const std::vector<float> floats(20, 1.5F);
  if (layout.has_fixed) good(nc_put_var_float(file, fixed, floats.data()));
  const std::vector<short> shorts(static_cast<std::size_t>(3 * layout.records), 7);
  const std::size_t start[2]{0, 0}, count[2]{static_cast<std::size_t>(layout.records), 3};
  for (const int id : records) {
    if (layout.records > 0) good(nc_put_vara_short(file, id, start, count, shorts.data()));
  }
  good(nc_close(file));
  return bytes_of(path);
}

const std::vector<std::pair<std::string, int>> kFormats{
    {"CDF-1", 0}, {"CDF-2", NC_64BIT_OFFSET}, {"CDF-5", NC_64BIT_DATA}, {"netCDF-4", NC_NETCDF4}};

TEST(NetcdfHeader, WholeFilesOfEveryFormatPass) {
  for (const auto& [name, format] : kFormats) {
    for (const int record_variables : {0, 1, 2}) {
      EXPECT_EQ(verdict_on(make({format, true, record_variables, 3})), "whole") << name << record_variables;
      EXPECT_EQ(verdict_on(make({format, false, record_variables, 1})), "whole") << name << record_variables;
      EXPECT_EQ(verdict_on(make({format, true, record_variables, 0})), "whole") << name << record_variables;
    }
  }
}

// Wherever a file was cut, a value or a part of the header is lost: up to 3 bytes of padding at the end are
// neither.
TEST(NetcdfHeader, AFileThatLostItsEndIsRefusedWhereverItWasCut) {
  for (const auto& [name, format] : kFormats) {
    for (const int record_variables : {0, 1, 2}) {
      const std::string bytes = make({format, true, record_variables, 3});
      for (std::size_t kept = 0; kept + 4 <= bytes.size(); kept += 1 + kept / 12)
        EXPECT_NE(verdict_on(bytes.substr(0, kept)), "whole")
            << name << ' ' << kept << " of " << bytes.size();
    }
  }
}

TEST(NetcdfHeader, TheVariableAndTheSizesAreNamed) {
  const std::string bytes = make({0, true, 0, 0});
  EXPECT_THAT(
      verdict_on(bytes.substr(0, bytes.size() - 10)),
      AllOf(HasSubstr("is cut short: its variable bottom ends at byte " + std::to_string(bytes.size())),
            HasSubstr("the file has " + std::to_string(bytes.size() - 10) + ": fetch it again")));
  const std::string hdf5 = make({NC_NETCDF4, true, 1, 3});
  EXPECT_THAT(verdict_on(hdf5.substr(0, hdf5.size() - 100)),
              HasSubstr("is cut short: by its header it ends at byte " + std::to_string(hdf5.size())));
}

TEST(NetcdfHeader, PaddingAtTheEndMayBeMissing) {
  const std::string bytes = make({0, true, 2, 3});  // each record of 6 bytes padded by 2
  EXPECT_EQ(verdict_on(bytes.substr(0, bytes.size() - 2)), "whole");
  EXPECT_NE(verdict_on(bytes.substr(0, bytes.size() - 3)), "whole");
}

TEST(NetcdfHeader, RecordsThatAStreamDidNotCountAreRefused) {
  std::string bytes = make({0, true, 1, 3});
  bytes.replace(4, 4, "\xff\xff\xff\xff");
  EXPECT_THAT(verdict_on(bytes), HasSubstr("its number of records is not stated"));
}

// netCDF would ask for the memory that a count claims, or walk a list of billions.
TEST(NetcdfHeader, EveryDamagedHeaderIsRefusedOrStillFitsTheFile) {
  const std::string bytes = make({0, true, 2, 3});
  const std::size_t header = bytes.find("record_1") + 60;
  std::size_t refused = 0;
  for (std::size_t at = 4; at < header; ++at) {
    for (const char byte : {'\x00', '\x7f', '\xff'}) {
      std::string damaged = bytes;
      damaged[at] = byte;
      const std::string verdict = verdict_on(damaged);
      refused += verdict == "whole" ? 0 : 1;
      EXPECT_THAT(verdict, AnyOf("whole", HasSubstr("is cut short"), HasSubstr("header is damaged"),
                                 HasSubstr("records is not stated")));
    }
  }
  EXPECT_GT(refused, header / 2);
}

TEST(NetcdfHeader, OtherFilesAreNamed) {
  EXPECT_THAT(verdict_on(""), HasSubstr("is empty"));
  EXPECT_THAT(verdict_on("<!DOCTYPE html><html>404 Not Found</html>"), HasSubstr("a failed download"));
  EXPECT_THAT(verdict_on("MATLAB 5.0 MAT-file, Platform"), HasSubstr("save it with -v7.3"));
  EXPECT_THAT(verdict_on("\x1f\x8b\x08rest"), HasSubstr("compressed (gzip): unpack it"));
  EXPECT_THAT(verdict_on("depth_m,temperature"), HasSubstr("neither classic netCDF nor HDF5"));
  EXPECT_THAT(verdict_on("CDF\x09"), HasSubstr("neither classic netCDF nor HDF5"));
}

}  // namespace
}  // namespace halocline::ocean

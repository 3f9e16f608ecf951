// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/channel_record_reader.h"

#include <fstream>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/channel_file.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::channel_file;
using halocline::testing::ChannelFile;
using halocline::testing::write_channel_file;
using ::testing::AllOf;
using ::testing::HasSubstr;

// Each value names its place: [3 instants, 2 receivers, 4 delays].
ChannelFile numbered() {
  ChannelFile file = channel_file(3, 2, 4);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t m = 0; m < 2; ++m) {
      for (std::size_t k = 0; k < 4; ++k)
        file.at(i, m, k) = {static_cast<double>(100 * i + 10 * m + k), -0.5};
    }
  }
  return file;
}

std::string refusal_of(const ChannelFile& file, std::size_t receiver = 0) {
  const std::string path = write_channel_file(file, "malformed.mat");
  try {
    read_channel_record(path, receiver);
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr(path));
    return error.what();
  }
  return "";
}

template <class Change>
std::string refusal_after(Change change) {
  ChannelFile file = numbered();
  change(file);
  return refusal_of(file);
}

TEST(ChannelRecordReader, ReadsAReceiversTapsAndRates) {
  const ChannelRecord record = read_channel_record(write_channel_file(numbered(), "numbered.mat"), 1);
  EXPECT_EQ(record.delay_rate_hz, 5000);
  EXPECT_EQ(record.time_rate_hz, 10);
  EXPECT_EQ(record.carrier_hz, 25'000);
  EXPECT_EQ(record.delays, 4u);
  ASSERT_EQ(record.instants(), 3u);
  EXPECT_NEAR(record.duration_s(), 0.3, 1e-12);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(record.taps[i * 4 + k], std::complex<float>(static_cast<float>(100 * i + 10 + k), -0.5F));
    }
  }
}

TEST(ChannelRecordReader, TakesComplexNumbersAsPythonNamesThem) {
  ChannelFile file = numbered();
  file.names = {"r", "i"};
  EXPECT_EQ(read_channel_record(write_channel_file(file, "python.h5"), 0).taps[5],
            std::complex<float>(101, -0.5F));
}

// Motion has 5000 values a second where responses have 10: 1500 for 3.
TEST(ChannelRecordReader, MotionOfTheEndsHasToFitTheOrderOfTheAxes) {
  EXPECT_EQ(refusal_after([](ChannelFile& f) { f.theta_hat = {1500, 2}; }), "");
  EXPECT_THAT(refusal_after([](ChannelFile& f) {
                f.theta_hat = {2, 1500};
              }),
              AllOf(HasSubstr("theta_hat: is of size [2, 1500]"),
                    HasSubstr("h_hat, which is [time, receiver, delay], of 3, 2 and 4")));
  // As a C program writes [delay, receiver, time].
  EXPECT_THAT(refusal_after([](ChannelFile& f) {
                f.instants = 4;
                f.delays = 3;
                f.theta_hat = {1500, 2};
              }),
              HasSubstr("theta_hat: is of size [1500, 2]"));
}

TEST(ChannelRecordReader, RefusesMalformedFilesAndNamesThePlace) {
  EXPECT_EQ(refusal_after([](ChannelFile&) {}), "");
  for (const char* name : {"version", "params/fs_delay", "params/fs_time", "params/fc", "h_hat"}) {
    EXPECT_THAT(refusal_after([&](ChannelFile& f) { f.without = {name}; }),
                HasSubstr(std::string(": ") + name + ": is not there"));
  }
  EXPECT_THAT(refusal_after([](ChannelFile& f) { f.without = {"params"}; }),
              HasSubstr("params: is not there"));
  EXPECT_THAT(refusal_after([](ChannelFile& f) { f.version = 2; }), HasSubstr("below 2"));
  EXPECT_THAT(refusal_after([](ChannelFile& f) { f.is_real = true; }), HasSubstr("h_hat: is not complex"));
  EXPECT_THAT(refusal_after([](ChannelFile& f) {
                f.names = {"x", "y"};
              }),
              HasSubstr("h_hat: is not complex"));
  EXPECT_THAT(refusal_after([](ChannelFile& f) { f.is_flat = true; }), HasSubstr("h_hat: is of size [24]"));
  EXPECT_THAT(refusal_after([](ChannelFile& f) { f.fs_time = 0; }), HasSubstr("params/fs_time"));
  EXPECT_THAT(refusal_after([](ChannelFile& f) { f.at(1, 0, 2) = NAN; }), HasSubstr("instant 1, delay 2"));
  EXPECT_THAT(refusal_of(numbered(), 2), HasSubstr("has 2 receivers; given is number 2"));
}

std::string refusal_of(const std::string& path) {
  try {
    read_channel_record(path, 0);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(ChannelRecordReader, SurvivesAFileThatHdf5DiesOf) {
  const std::string path = write_channel_file(numbered(), "no_names.mat");
  halocline::testing::lose_names(path);
  EXPECT_THAT(refusal_of(path), HasSubstr(path + " is damaged: the library that reads it crashes on it"));
}

TEST(ChannelRecordReader, RefusesWhatIsNoHdf5) {
  const std::string path = ::testing::TempDir() + "text.mat";
  std::ofstream(path) << "no channel";
  EXPECT_THAT(refusal_of(path), HasSubstr(path + ": cannot be read as HDF5"));
  EXPECT_THAT(refusal_of("/nowhere/channel.mat"), HasSubstr("/nowhere/channel.mat: there is no such file"));
}

}  // namespace
}  // namespace halocline::acoustics

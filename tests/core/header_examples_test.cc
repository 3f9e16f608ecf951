// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of core/, compiled and run (tests/docs/check_examples).
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/archive.h"
#include "core/atomic_file.h"
#include "core/files/file_path.h"
#include "core/frames.h"
#include "core/lru_cache.h"
#include "core/random.h"
#include "core/tide.h"
#include "tests/support/working_folder.h"

namespace halocline {
namespace {

std::string content_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Navigator {
 public:
  Navigator() = default;
  explicit Navigator(const Vec3& position) : position_(position) {}
  void archive(Archive& a) { a(position_, velocity_, waiting_); }
  bool operator==(const Navigator&) const = default;

 private:
  Vec3 position_ = Vec3::Zero(), velocity_ = Vec3::Zero();
  std::vector<int> waiting_{1};
};

TEST(HeaderExamples, Archive) {
  Navigator navigator(Vec3(1, 2, 3)), another;
  Archive saved;
  saved(navigator);
  Archive(saved.bytes())(another);
  EXPECT_EQ(another, navigator);
}

TEST(HeaderExamples, AtomicFileByItsText) {
  const testing::TemporaryFolder folder;
  const std::string text = "{}";
  replace_file("result.json", text);
  EXPECT_EQ(content_of("result.json"), text);
}

TEST(HeaderExamples, AtomicFileByItsTemporaryPath) {
  const testing::TemporaryFolder folder;
  const std::string results = "CDF";
  const auto write_netcdf = [](const std::string& bytes, const std::string& path) {
    std::ofstream(path) << bytes;
  };
  AtomicFile file("sweep.nc");
  write_netcdf(results, file.temporary_path());
  file.commit();
  EXPECT_EQ(content_of("sweep.nc"), results);
}

TEST(HeaderExamples, FilePath) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directories("casts");
  std::ofstream("casts/may.csv") << "depth_m\n";
  FilePath cast("casts/may.csv");  // of code: as it is
  std::ifstream in(cast.place());
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "depth_m\n");
}

TEST(HeaderExamples, LruCache) {
  using Spectrum = std::vector<double>;
  const std::string name = "wind";
  int computed = 0;
  const auto compute_spectrum = [&](const std::string&) { return Spectrum(3, ++computed); };
  LruCache<std::string, Spectrum> spectra(/*capacity=*/32);
  const Spectrum& spectrum = spectra.find_or_make(name, [&] { return compute_spectrum(name); });
  EXPECT_EQ(spectrum, Spectrum(3, 1));
  EXPECT_EQ(spectra.find(name), &spectrum);
}

TEST(HeaderExamples, Random) {
  const std::uint32_t sender = 3;
  const std::uint64_t sequence = 17;
  const double u =
      uniform_at({.seed = 7, .purpose = purpose_of("bit-error"), .who = sender, .which = sequence});
  EXPECT_EQ(u, uniform_at({7, purpose_of("bit-error"), 3, 17}));
}

TEST(HeaderExamples, Tide) {
  const Tide tide{{{.amplitude_m = 1}}};          // M2
  const double height_m = tide.height_m(10'000);  // 0.1649
  EXPECT_NEAR(height_m, 0.1649, 1e-4);
}

}  // namespace
}  // namespace halocline

// SPDX-License-Identifier: BSD-3-Clause
// The command lines of tests/data/vehicle/README.md, run as they stand there: each makes the reference
// trajectory of its name.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/csv_table.h"
#include "tests/support/tolerance.h"

namespace halocline {
namespace {

namespace fs = std::filesystem;
using testing::tolerance;

const std::string kSource = HALOCLINE_SOURCE_DIR;

CsvTable read_table(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> errors;
  CsvTable table = read_csv(file, errors);
  EXPECT_TRUE(errors.empty()) << path;
  return table;
}

std::vector<double> numbers_of(const CsvLine& row) {
  std::vector<double> numbers;
  for (const std::string& cell : row.cells) numbers.push_back(parse_number(cell).value());
  return numbers;
}

// The lines of the documentation that write a table, by the table's name.
std::map<std::string, std::string> documented_lines() {
  std::map<std::string, std::string> lines;
  std::ifstream file(kSource + "/tests/data/vehicle/README.md");
  for (std::string line; std::getline(file, line);) {
    const auto out = line.find(" --out ");
    if (line.starts_with("halocline vehicle replay --model ") && out != std::string::npos)
      lines[line.substr(out + 7)] = line;
  }
  return lines;
}

std::map<std::string, fs::path> reference_files() {
  std::map<std::string, fs::path> files;
  for (const std::string folder : {"exact", "galilean_current"}) {
    for (const auto& entry : fs::directory_iterator(kSource + "/tests/data/vehicle/" + folder))
      files[entry.path().filename().string()] = entry.path();
  }
  return files;
}

std::vector<std::string> reference_names() {
  std::vector<std::string> names;
  for (const auto& [name, path] : reference_files()) names.push_back(name.substr(0, name.find('.')));
  return names;
}

class DocumentedReplay : public ::testing::TestWithParam<std::string> {
 protected:
  DocumentedReplay() { fs::create_directories(folder_); }
  ~DocumentedReplay() override { fs::remove_all(folder_); }

  // Runs the line in the repository's folder, its result written into one of the test's own.
  CsvTable run(std::string line, const std::string& name) {
    const std::string program = "halocline", out = (folder_ / name).string();
    line.replace(line.find(name + ".csv"), name.size() + 4, "'" + out + "'");
    line.replace(0, program.size(), "'" HALOCLINE_BIN_DIR "/halocline'");
    EXPECT_EQ(std::system(("cd '" + kSource + "' && " + line).c_str()), 0) << line;
    return read_table(out);
  }

 private:
  fs::path folder_ = ::testing::TempDir() + "halocline-vehicle-" + std::to_string(getpid());
};

TEST_P(DocumentedReplay, MakesTheReferenceTrajectory) {
  const std::string name = GetParam() + ".csv";
  const auto lines = documented_lines();
  ASSERT_TRUE(lines.contains(name)) << "tests/data/vehicle/README.md has no command line for it";
  std::string line = lines.at(name);
  line.replace(line.find(" --out ") + 7, std::string::npos, GetParam() + ".csv");
  const CsvTable made = run(line, GetParam()), reference = read_table(reference_files().at(name));
  ASSERT_EQ(made.header.text, reference.header.text);
  ASSERT_EQ(made.rows.size(), reference.rows.size());
  const double degree = std::numbers::pi / 180;
  for (std::size_t i = 0; i < made.rows.size(); ++i) {
    const auto a = numbers_of(made.rows[i]), b = numbers_of(reference.rows[i]);
    EXPECT_NEAR(a[0], b[0], 1e-9);
    for (int k = 1; k <= 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance(1e-3)) << "row " << i << " column " << k;
    for (int k = 4; k <= 6; ++k)
      EXPECT_NEAR(a[k], b[k], tolerance(1e-3 * degree)) << "row " << i << " column " << k;
    for (int k = 7; k <= 12; ++k) EXPECT_NEAR(a[k], b[k], tolerance(1e-4)) << "row " << i << " column " << k;
    for (int k = 13; k <= 18; ++k) EXPECT_NEAR(a[k], b[k], tolerance(1e-6)) << "row " << i << " column " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(All, DocumentedReplay, ::testing::ValuesIn(reference_names()),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace halocline

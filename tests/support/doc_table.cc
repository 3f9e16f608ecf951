// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/doc_table.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace halocline::testing {

void doc_row(const std::string& table, const std::vector<std::string>& cells) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name();
  for (char& c : name) c = c == '/' ? '-' : c;
  const std::filesystem::path folder = std::filesystem::path(HALOCLINE_TEST_TABLES) / table;
  std::filesystem::create_directories(folder);
  static std::set<std::string> begun;
  const bool is_first = begun.insert(table + name).second;
  std::ofstream file(folder / (name + ".md"), is_first ? std::ios::trunc : std::ios::app);
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + cell + " |";
  std::cout << row << '\n';
  file << row << '\n';
  if (!file.flush()) throw std::runtime_error("cannot write into " + folder.string());
}

}  // namespace halocline::testing

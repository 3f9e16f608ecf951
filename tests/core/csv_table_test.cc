// SPDX-License-Identifier: BSD-3-Clause
#include "core/csv_table.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace halocline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Read {
  CsvTable table;
  std::vector<std::string> errors;
};

Read read(const std::string& text) {
  std::istringstream in(text);
  Read result;
  result.table = read_csv(in, result.errors);
  return result;
}

TEST(CsvTable, ReadsColumnsAndRowsWithTheirLineNumbers) {
  const Read r = read("a,b\n1,2\n\n# note\n3,4\n");
  EXPECT_TRUE(r.errors.empty());
  ASSERT_EQ(r.table.rows.size(), 2u);
  EXPECT_EQ(r.table.rows[1].number, 5);
  EXPECT_THAT(r.table.rows[1].cells, ElementsAre("3", "4"));
  EXPECT_EQ(r.table.column("b"), 1u);
  EXPECT_EQ(r.table.column("c"), std::nullopt);
}

TEST(CsvTable, QuotedCellsMayHoldCommasAndQuotes) {
  const Read r = read("name,x\n\"say \"\"T=25, S=35\"\"\", 7 \r\n");
  EXPECT_THAT(r.table.rows.at(0).cells, ElementsAre("say \"T=25, S=35\"", "7"));
  EXPECT_EQ(r.table.rows.at(0).text, "\"say \"\"T=25, S=35\"\"\", 7 ");
}

TEST(CsvTable, SkipsAByteOrderMark) { EXPECT_EQ(read("\xEF\xBB\xBFx\n1\n").table.column("x"), 0u); }

TEST(CsvTable, ReportsEveryFaultAtOnce) {
  const Read r = read("a,a,b\n1,2\n1,2,3\n1,2,3,4\n\"open,1,2\n");
  EXPECT_THAT(r.errors, ElementsAre(HasSubstr("'a' is named twice"), HasSubstr("line 2: 2 cells"),
                                    HasSubstr("line 4: 4 cells"), HasSubstr("line 5: a quote")));
  EXPECT_EQ(r.table.rows.size(), 1u);
}

TEST(CsvTable, WrittenCellsReadBackAsTheSameText) {
  for (const std::string text : {"plain", "a,b", "say \"so\"", "\"", ""}) {
    const auto table = read("x,y\n" + csv_cell(text) + ",1\n").table;
    ASSERT_EQ(table.rows.size(), 1u) << text;
    EXPECT_EQ(table.rows[0].cells[0], text);
  }
  EXPECT_EQ(csv_cell("two\nlines"), "\"two\nlines\"");
}

TEST(CsvTable, AnEmptyTextHasNoHeader) {
  EXPECT_THAT(read("\n").errors, ElementsAre(HasSubstr("no header")));
}

TEST(ParseNumber, RealNumbersAreWholeTextsAndFinite) {
  EXPECT_EQ(parse_number("-1.5e3"), -1500);
  EXPECT_EQ(parse_number("+2"), 2);
  for (const char* bad : {"", "+", "1x", " 1", "nan", "inf", "1e999", "0x10", "1 2", "+-3", "++3", "1,5"})
    EXPECT_EQ(parse_number(bad), std::nullopt) << bad;
}

TEST(ParseNumber, IntegersFillTheirTypeAndNoMore) {
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  EXPECT_EQ(parse_number<std::int64_t>("-9223372036854775808"), kMin);
  EXPECT_EQ(parse_number<std::uint64_t>("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  for (const char* bad : {"9223372036854775808", "1.0", "1e3", ""})
    EXPECT_EQ(parse_number<std::int64_t>(bad), std::nullopt) << bad;
  EXPECT_EQ(parse_number<std::uint64_t>("-1"), std::nullopt);
}

TEST(ParseNumber, BoundsAreIncluded) {
  EXPECT_EQ(parse_number<int>("3", 3, 5), 3);
  EXPECT_EQ(parse_number<int>("5", 3, 5), 5);
  EXPECT_EQ(parse_number<int>("6", 3, 5), std::nullopt);
  EXPECT_EQ(parse_number("2.9999", 3.0, 5.0), std::nullopt);
  EXPECT_EQ(parse_number("nan", 3.0, 5.0), std::nullopt);
}

TEST(CsvTable, WrittenNumbersReadBackAsTheSameDouble) {
  for (const double value : {0.1, 1.0 / 3, 1500.0, -2.5e-300, std::nextafter(1.0, 2.0)}) {
    EXPECT_EQ(parse_number(format_number(value)), value) << format_number(value);
  }
}

}  // namespace
}  // namespace halocline

// SPDX-License-Identifier: BSD-3-Clause
#include "runs/plot/plot.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/check.h"
#include "tests/support/file_size_limit.h"

namespace halocline::clients {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Plot stems() {
  Plot plot{.title = "Arrivals", .charts = {{.x = "delay, s", .y = "level, dB"}}};
  plot.charts[0].series.push_back({"paths", Series::kStems, {1.25, 1.5}, {-60, -71.5}});
  return plot;
}

class PlotFile : public ::testing::Test {
 protected:
  PlotFile() { std::filesystem::create_directories(folder_); }
  ~PlotFile() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  static std::string bytes(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }

 private:
  std::string folder_ = ::testing::TempDir() + "halocline-plot-" + std::to_string(getpid());
};

TEST(GnuplotScript, HoldsEveryPointOnce) {
  const std::string script = gnuplot_script(stems(), "a.svg");
  EXPECT_THAT(script, HasSubstr("<< EOD\n1.25 -60\n1.5 -71.5\nEOD\n"));
  EXPECT_THAT(script, HasSubstr("set xlabel 'delay, s'\nset ylabel 'level, dB'\n"));
}

// Levels lie below 0: stems from 0 would hang down, the weakest the longest.
TEST(GnuplotScript, StemsRiseFromBelowTheLowestPoint) {
  EXPECT_THAT(gnuplot_script(stems(), "a.svg"), HasSubstr("set yrange [-72.65:-58.85]"));
  EXPECT_THAT(gnuplot_script(stems(), "a.svg"),
              HasSubstr("1:(-72.65):(0):($2-(-72.65)) with vectors nohead"));
}

TEST(GnuplotScript, TextsCannotLeaveTheirQuotes) {
  Plot plot = stems();
  plot.title = "x'; system('touch /tmp/never'); print '`id` $HOME \\\n!id";
  const std::string script = gnuplot_script(plot, "a.svg");
  EXPECT_THAT(script, HasSubstr("title 'x''; system(''touch /tmp/never''); print ''`id` $HOME \\ !id'\n"));
}

TEST(GnuplotScript, BarsOfTwoSeriesStandSideBySideAndOnZero) {
  Plot plot{.charts = {{.x = "outcome", .y = "packets", .categories = {"received", "collided"}}}};
  plot.charts[0].series.push_back({"a", Series::kBars, {0, 1}, {5, 3}});
  plot.charts[0].series.push_back({"b", Series::kBars, {0, 1}, {2, 4}});
  const std::string script = gnuplot_script(plot, "a.png");
  EXPECT_THAT(script, HasSubstr("using ($1+(-0.2)):2:(0.4) with boxes"));
  EXPECT_THAT(script, HasSubstr("using ($1+(0.2)):2:(0.4) with boxes"));
  EXPECT_THAT(script, HasSubstr("('received' 0, 'collided' 1)"));
  EXPECT_THAT(script, HasSubstr("set yrange [0:5.5]"));
}

TEST(GnuplotScript, ShowsALabelWhereThereIsNothingToDraw) {
  Plot plot = stems();
  plot.charts[0].series.clear();
  plot.charts[0].when_empty = "shadow";
  const std::string script = gnuplot_script(plot, "a.png");
  EXPECT_THAT(script, HasSubstr("set label 1 'shadow'"));
  EXPECT_THAT(script, Not(HasSubstr("EOD")));
}

TEST(GnuplotScript, RefusesWhatCannotBeDrawn) {
  Plot plot = stems();
  plot.charts[0].series[0].y.pop_back();
  EXPECT_THROW(gnuplot_script(plot, "a.png"), InvalidArgument);
  plot.charts[0].series[0].y = {1, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW(gnuplot_script(plot, "a.png"), InvalidArgument);
  EXPECT_THROW(gnuplot_script({}, "a.png"), InvalidArgument);
}

TEST(GnuplotScript, AcceptsPngAndSvgAlone) {
  for (const std::string file : {"a.pdf", "png", "a.png.txt", "", "a\n.png"})
    EXPECT_THROW(gnuplot_script(stems(), file), InvalidArgument) << file;
}

TEST_F(PlotFile, IsAPngOfTheGivenSize) {
  Plot plot = stems();
  plot.charts.push_back(plot.charts[0]);
  write_plot(plot, path("a.png"));
  const std::string png = bytes(path("a.png"));
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  const auto number = [&](std::size_t at) {
    return static_cast<unsigned char>(png[at]) * 256 + static_cast<unsigned char>(png[at + 1]);
  };
  EXPECT_EQ(number(18), 900);  // width and height of the header, their lower halves
  EXPECT_EQ(number(22), 800);
}

TEST_F(PlotFile, IsAnSvgWithItsTexts) {
  Plot plot = stems();
  plot.title = "a_b^{c} `d` 'e'";
  write_plot(plot, path("it's.svg"));
  const std::string svg = bytes(path("it's.svg"));
  EXPECT_THAT(svg, HasSubstr("<svg"));
  EXPECT_THAT(svg, HasSubstr("a_b^{c} `d` 'e'"));
  EXPECT_THAT(svg, HasSubstr("delay, s"));
}

TEST_F(PlotFile, DrawsBarsLinesPointsAndNothing) {
  Plot plot{.charts = {{.x = "x", .y = "y"}, {.when_empty = "empty chart"}}};
  plot.charts[0].series = {{"bars", Series::kBars, {0, 1, 2}, {1, 2, 3}},
                           {"lines", Series::kLines, {0, 1, 2}, {3, 2, 1}},
                           {"points", Series::kPoints, {0.5}, {2}}};
  write_plot(plot, path("all.svg"));
  const std::string svg = bytes(path("all.svg"));
  for (const std::string text : {"bars", "lines", "points", "empty chart"}) EXPECT_THAT(svg, HasSubstr(text));
}

TEST_F(PlotFile, IsReportedWhenItCannotBeWritten) {
  EXPECT_THROW(write_plot(stems(), path("no-such-folder/a.png")), std::runtime_error);
}

// As on a full disk, of which gnuplot says nothing.
TEST_F(PlotFile, OneThatIsCutOffIsReportedAndLeavesTheOldOne) {
  for (const std::string& file : {path("a.svg"), path("a.png")}) {
    write_plot(stems(), file);
    const std::string before = bytes(file);
    Plot other = stems();
    other.title = "another";
    const halocline::testing::FileSizeLimit full_disk(4096);
    EXPECT_THROW(write_plot(other, file), std::runtime_error);
    EXPECT_EQ(bytes(file), before);
  }
}

TEST_F(PlotFile, IsReportedWhenGnuplotIsMissing) {
  const std::string before = std::getenv("PATH") ? std::getenv("PATH") : "";
  setenv("PATH", path("").c_str(), 1);
  try {
    write_plot(stems(), path("a.png"));
    ADD_FAILURE() << "drawn without gnuplot";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("gnuplot-nox"));
  }
  setenv("PATH", before.c_str(), 1);
}

}  // namespace
}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/report_page.h"

#include <cstdlib>
#include <regex>
#include <set>

#include <gmock/gmock.h>

#include "runs/timeline/outcome_classes.h"
#include "runs/timeline/packet_book.h"
#include "runs/timeline/terrain_overview.h"
#include "tests/runs/timeline/timeline_fixtures.h"
#include "tests/viewer/report/well_formed.h"
#include "viewer/report/packet_lanes.h"
#include "viewer/report/packet_links.h"
#include "viewer/report/seabed_raster.h"
#include "viewer/report/svg.h"

namespace halocline::clients {
namespace {

using halocline::testing::fault_in_xml;
using testing::add;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kSecond;
using ::testing::Not;
using testing::outcome;
using testing::receipt;
using testing::send;
using testing::state;

constexpr std::size_t kLargestPage = 3'000'000;  // bytes, of any run

// For the test's time there is no gnuplot.
class WithoutGnuplot {
 public:
  WithoutGnuplot() { setenv("PATH", "/nonexistent", 1); }
  ~WithoutGnuplot() { setenv("PATH", path_.c_str(), 1); }

 private:
  std::string path_ = std::getenv("PATH");
};

TerrainOverview slope() {
  TerrainOverview terrain{-2000, -2000, 100, 100, 41, 41, {}};
  for (int row = 0; row < 41; ++row) {
    for (int column = 0; column < 41; ++column)
      terrain.depth_m.push_back(static_cast<float>(100 + row + column));
  }
  return terrain;
}

// Two vehicles, one packet of every outcome.
void add_run(RunTimeline& store) {
  for (std::int64_t s = 0; s <= 200; ++s) {
    add(store, "STATE.auv-1", state(1, s * kSecond, static_cast<double>(s), 0, 30));
    add(store, "STATE.b-2", state(2, s * kSecond, 0, 500 + static_cast<double>(s), 40));
  }
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(kOutcomes); ++i) {
    add(store, "SEND.auv-1", send(1, i, i * 10 * kSecond));
    add(store, "RECEIPT.auv-1", receipt(i, i * 10 * kSecond));
    packet_outcome_t o = outcome(1, 2, i, i * 10 * kSecond, static_cast<std::int8_t>(i));
    if (i == packet_outcome_t::COLLIDED) {
      o.num_colliders = 1;
      o.colliders.push_back({2, 0, 7, 5, 0});
    }
    add(store, "OUTCOME", o);
  }
  store.set_terrain(slope());
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++found;
  return found;
}

TEST(ReportPage, IsWellFormedAndLoadsAndRunsNothing) {
  RunTimeline store;
  add_run(store);
  const std::string page = report_page({"run.lcm", store});
  EXPECT_EQ(fault_in_xml(page), "");
  EXPECT_THAT(page, AllOf(Not(HasSubstr("<script")), Not(HasSubstr("http")), Not(HasSubstr("onmouse")),
                          Not(HasSubstr("@import")), Not(HasSubstr("src="))));
  EXPECT_LT(page.size(), 500'000u);
}

TEST(ReportPage, EveryColourOfGnuplotIsOneOfThePage) {
  RunTimeline store;
  add_run(store);
  const std::string page = report_page({"run.lcm", store});
  EXPECT_EQ(count(page, "01fe") + count(page, "01FE"), 0u);
  EXPECT_EQ(count(page, "rgb(  1, 254"), 0u);
  EXPECT_THAT(page, HasSubstr("var(--seabed)"));
  EXPECT_THAT(page, HasSubstr("data:image/png"));
}

TEST(ReportPage, EveryOutcomeIsInTheLedgerAndItsSumIsThatOfTheLog) {
  RunTimeline store;
  add_run(store);
  const std::string page = report_page({"run.lcm", store});
  const std::string ledger = std::regex_replace(page.substr(page.find("<section id=\"ledger\""), 7000),
                                                std::regex("</?a[^>]*>"), "");  // without links
  for (std::size_t i = 0; i < kOutcomes; ++i)
    EXPECT_THAT(ledger, HasSubstr(std::string(outcome_name(i)) + "</td><td class=\"number\">1</td>"));
  EXPECT_THAT(ledger, HasSubstr("<td>all</td><td class=\"number\">" + std::to_string(kOutcomes) + "</td>"));
}

TEST(ReportPage, EveryLossHasItsSentenceAndItsMarkOnTheTimeLine) {
  RunTimeline store;
  add_run(store);
  const std::string page = report_page({"run.lcm", store});
  const std::string losses = page.substr(page.find("<section id=\"losses\""));
  EXPECT_EQ(count(losses, "Lost at b-2: "), kOutcomes - 1);
  PacketLinks links(store);
  const std::string lanes = packet_lanes(store, links).svg;
  EXPECT_EQ(count(lanes, "Lost at b-2: "), kOutcomes - 1);
  EXPECT_EQ(count(lanes, "class=\"sent v-0 dash-0\""), kOutcomes);
}

TEST(ReportPage, WithoutGnuplotItHasTheOtherPicturesAndNamesWhatIsMissing) {
  RunTimeline store;
  add_run(store);
  const WithoutGnuplot without;
  const std::string page = report_page({"run.lcm", store});
  EXPECT_EQ(fault_in_xml(page), "");
  EXPECT_EQ(count(page, "apt-get install gnuplot-nox"), 3u);
  EXPECT_THAT(page, HasSubstr("class=\"sent "));
}

TEST(ReportPage, AnEmptyRunIsAPageOfSentences) {
  const RunTimeline store;
  const std::string page =
      report_page({"nothing.lcm", store, {"nothing.lcm, byte 12: 400 bytes are no event"}});
  EXPECT_EQ(fault_in_xml(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("No vehicle published a state"), HasSubstr("The log holds no packets"),
                          HasSubstr("400 bytes are no event")));
}

TEST(ReportPage, PacketsWithoutStatesAndStatesWithoutPacketsHaveTheirParts) {
  RunTimeline packets, states;
  add(packets, "OUTCOME", outcome(1, 2, 0, 0, packet_outcome_t::SHADOW));
  add(states, "STATE.a", state(1, 0, 0));
  add(states, "STATE.a", state(1, 9 * kSecond, 50));
  for (const RunTimeline* store : {&packets, &states})
    EXPECT_EQ(fault_in_xml(report_page({"x.lcm", *store})), "");
  EXPECT_THAT(report_page({"x.lcm", packets}), HasSubstr("Lost at 2: "));
  EXPECT_THAT(report_page({"x.lcm", states}), HasSubstr("Depth of a over time"));
}

// 400 vehicles, as many states of each as are drawn, and packets of all to all.
TEST(ReportPage, ALargeFleetIsDecimated) {
  RunTimeline store;
  for (std::int32_t v = 1; v <= 400; ++v) {
    for (std::int64_t s = 0; s < 400; ++s)
      add(store, "STATE.v" + std::to_string(v),
          state(v, s * 15 * kSecond, 2.5 * static_cast<double>(s) + static_cast<double>(s % 7), 30.0 * v,
                50 + static_cast<double>(s % 5)));
  }
  for (std::int64_t i = 0; i < 300; ++i) {
    for (std::int32_t v = 1; v <= 400; ++v) {
      if (v != 1 + i)
        add(store, "OUTCOME",
            outcome(1 + static_cast<std::int32_t>(i), v, i, i * 20 * kSecond,
                    static_cast<std::int8_t>(v % 14)));
    }
  }
  store.set_terrain(slope());
  const std::string page = report_page({"fleet.lcm", store});
  EXPECT_EQ(fault_in_xml(page), "");
  EXPECT_LT(page.size(), kLargestPage);
  EXPECT_THAT(page,
              AllOf(HasSubstr("384 vehicles with less traffic are left out"),
                    HasSubstr("388 vehicles with shorter ways are left out"),
                    HasSubstr("100 more vehicles are left out"), HasSubstr("376 more vehicles are left out"),
                    HasSubstr(" more are left out; <code>")));
  EXPECT_LE(count(page, "class=\"loss\""), 200u);
}

// Ids of a page, and what its links lead to.
std::multiset<std::string> all_of(const std::string& page, const std::string& pattern) {
  const std::regex regex(pattern);
  std::multiset<std::string> found;
  for (std::sregex_iterator i(page.begin(), page.end(), regex), end; i != end; ++i) found.insert((*i)[1]);
  return found;
}

void expect_sound_links(const std::string& page) {
  const auto ids = all_of(page, " id=\"([^\"]*)\"");
  for (const std::string& id : ids) EXPECT_EQ(ids.count(id), 1u) << id;
  for (const std::string& target : all_of(page, "<a href=\"#([^\"]*)\""))
    EXPECT_TRUE(ids.contains(target)) << target;
}

TEST(ReportPage, AMarkOfALossLeadsToItsRowAndTheRowToTheTimeLine) {
  RunTimeline store;
  add_run(store);
  const std::string page = report_page({"run.lcm", store});
  expect_sound_links(page);
  const std::string chart =
      page.substr(page.find("<section id=\"chart\""),
                  page.find("<section id=\"matrix\"") - page.find("<section id=\"chart\""));
  EXPECT_EQ(count(chart, "<a href=\"#lost-"), count(chart, "class=\"loss\""));
  EXPECT_GT(count(chart, "<a href=\"#lost-"), 0u);
  const std::string lanes = page.substr(page.find("<section id=\"packets\""));
  EXPECT_EQ(count(lanes, "<g id=\"at-"), kOutcomes - 1);
  EXPECT_EQ(count(lanes, "<tr id=\"lost-"), kOutcomes - 1);
  EXPECT_EQ(count(lanes, "<a href=\"#at-"), kOutcomes - 1);
  // The packet that collided, in all three.
  for (const char* part :
       {"<a href=\"#lost-6-2\"", "<g id=\"at-6-2\"", "<tr id=\"lost-6-2\"", "<a href=\"#at-6-2\""})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST(ReportPage, CommandedDepthAndSeabedStandBesideTheDepth) {
  RunTimeline store;
  add_run(store);
  for (std::int64_t s = 0; s <= 200; ++s) {
    autopilot_status_t status{};
    status.utime = s * kSecond;
    status.is_propelled = 1;
    status.commanded_z_m = 35;
    add(store, "AUTOPILOT.auv-1", status);
  }
  const std::string page = report_page({"run.lcm", store});
  const auto from = page.find("<section id=\"depth\"");
  const std::string depth = page.substr(from, page.find("</section>", from) - from);
  const std::string strip = depth.substr(0, depth.find("</svg>"));
  EXPECT_THAT(strip,
              AllOf(HasSubstr("var(--v-0)"), HasSubstr("var(--seabed)"), HasSubstr("stroke-dasharray"),
                    HasSubstr("var(--ink)"), HasSubstr("30 to 30 m deep"), HasSubstr("seabed 140 to 142 m")));
  EXPECT_THAT(depth, AllOf(HasSubstr("depth of the vehicle"), HasSubstr("commanded depth"),
                           HasSubstr("seabed below the vehicle")));
}

TEST(ReportPage, ASeabedFarBelowIsStated) {
  RunTimeline store;
  add_run(store);
  store.set_terrain({-2000, -2000, 4000, 4000, 2, 2, {4000, 4000, 4000, 4000}});
  const std::string page = report_page({"run.lcm", store});
  EXPECT_THAT(page, AllOf(HasSubstr("seabed 4000 to 4000 m"), HasSubstr("The seabed lies far below"),
                          Not(HasSubstr("seabed below the vehicle"))));
}

TEST(ReportPage, AVehicleHasTheSameColourInEveryPicture) {
  RunTimeline store;
  for (std::int64_t v = 1; v <= 9; ++v) {
    const auto id = static_cast<std::int32_t>(v);
    for (std::int64_t s = 0; s <= 20; ++s)
      add(store, "STATE.n" + std::to_string(v),
          state(id, s * kSecond, static_cast<double>(10 * s), 100.0 * id, 30));
    add(store, "OUTCOME", outcome(id, id % 9 + 1, 0, v * kSecond));
  }
  const std::string page = report_page({"run.lcm", store});
  const auto part = [&](const std::string& id) {
    const auto from = page.find("<section id=\"" + id + "\"");
    return page.substr(from, page.find("</section>", from) - from);
  };
  for (int v = 0; v < 9; ++v) {
    const std::string colour = "v-" + std::to_string(v % 8), line = colour + " dash-" + std::to_string(v / 8);
    EXPECT_THAT(part("chart"),
                AllOf(HasSubstr("class=\"track " + line + "\""), HasSubstr("class=\"vehicle " + colour)));
    EXPECT_THAT(part("depth"),
                AllOf(HasSubstr("var(--" + colour + ")"), HasSubstr("class=\"swatch " + line + "\"")));
    EXPECT_THAT(part("packets"),
                AllOf(HasSubstr("class=\"sent " + line + "\""), HasSubstr("class=\"swatch " + line + "\"")));
    EXPECT_THAT(page, HasSubstr("." + colour + " { color: var(--" + colour + ")"));
  }
}

TEST(ReportPage, TwoLogsStandSideBySideWithWhatChanged) {
  RunTimeline before, after;
  add_run(before);
  add(after, "OUTCOME", outcome(1, 2, 1, 10 * kSecond, packet_outcome_t::RECEIVED));
  LoggedOutcomes was, is;
  for (const PacketRecord& packet : before.packets().all()) was.summary.count(packet.outcomes[0]);
  is.summary.count(after.packets().all()[0].outcomes[0]);
  const std::string page = report_page({"a.lcm", before}, {"b.lcm", after}, Comparison(was, is));
  EXPECT_EQ(fault_in_xml(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("a.lcm"), HasSubstr("b.lcm"), HasSubstr("below cutoff → received")));
  EXPECT_THAT(report_page({"a.lcm", before}, {"a.lcm", before}, Comparison(was, was)),
              AllOf(HasSubstr("<tr id=\"before-lost-6-2\""), HasSubstr("<tr id=\"after-lost-6-2\"")));
  expect_sound_links(report_page({"a.lcm", before}, {"a.lcm", before}, Comparison(was, was)));
}

TEST(Svg, TextIsEscapedAndWhatXmlForbidsIsReplaced) {
  EXPECT_EQ(escaped_xml("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;");
  EXPECT_EQ(escaped_xml("\x01\xff\xc3\xa9 \xc3"), "??\xc3\xa9 ?");
}

TEST(Svg, EveryClassOfOutcomesHasItsMark) {
  for (const OutcomeClass& c : outcome_classes())
    EXPECT_THAT(mark_definitions(), HasSubstr("id=\"m-" + std::string(c.mark) + "\"")) << c.key;
}

TEST(SeabedRaster, DepthsAreThoseOfThePlaneAndLightComesFromTheNorthWest) {
  // Linear in both directions, which a cubic surface reproduces.
  const SeabedRaster raster = seabed_raster(slope(), {-1000, -1000, 1000, 1000}, 100, 100);
  EXPECT_NEAR(raster.depth_m[0], 100 + 10.1 + 10.1, 1e-3);
  EXPECT_NEAR(raster.depth_m[99 * 100 + 99], 100 + 29.9 + 29.9, 1e-3);
  // Two ridges: the flank towards the north-west is the brighter one.
  TerrainOverview ridge{-2000, -2000, 100, 100, 41, 41, {}};
  for (int row = 0; row < 41; ++row) {
    for (int column = 0; column < 41; ++column)
      ridge.depth_m.push_back(static_cast<float>(100 + std::abs(column - row)));  // its crest runs north-east
  }
  const SeabedRaster lit = seabed_raster(ridge, {-1000, -1000, 1000, 1000}, 100, 100);
  const auto brightness = [&](std::size_t x, std::size_t y) { return lit.rgba[4 * (y * 100 + x) + 1]; };
  EXPECT_GT(brightness(30, 70), brightness(70, 30));
}

TEST(SeabedRaster, WhereThereIsNoTerrainItIsTransparent) {
  const SeabedRaster raster = seabed_raster(slope(), {1000, 1000, 3000, 3000}, 50, 50);
  EXPECT_EQ(raster.rgba[3], 255);
  EXPECT_EQ(raster.rgba[4 * (49 * 50 + 49) + 3], 0);
}

}  // namespace
}  // namespace halocline::clients

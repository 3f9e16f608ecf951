// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/calc/calc.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/csv_table.h"

namespace halocline::clients {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

struct Outcome {
  int code;
  std::string out, err;
};

Outcome run(const CalcOptions& options, const std::string& table) {
  std::istringstream in(table);
  std::ostringstream out, err;
  const int code = run_calc(options, in, out, err);
  return {code, out.str(), err.str()};
}

TEST(Calc, AppendsTheResultAndLeavesTheRestAlone) {
  const Outcome r = run({.quantity = "sound-speed"},
                        "name,T_degC,S_ppt,depth_m\n\"warm, salty\", 25,35,1000\r\nb,10,35,0\n");
  EXPECT_EQ(r.code, kCalcDone);
  EXPECT_EQ(r.err, "");
  EXPECT_THAT(r.out,
              StartsWith("name,T_degC,S_ppt,depth_m,c_m_per_s\n\"warm, salty\", 25,35,1000,1550.74402"));
}

TEST(Calc, AResultWhoseColumnIsThereIsSuffixedNotOverwritten) {
  const Outcome r = run({.quantity = "munk"}, "depth_m,c_m_per_s\n1300,7\n");
  EXPECT_EQ(r.out, "depth_m,c_m_per_s,computed_c_m_per_s\n1300,7,1500\n");
  EXPECT_THAT(run({.quantity = "munk"}, "depth_m,c_m_per_s,computed_c_m_per_s\n1300,7,8\n").out,
              HasSubstr("computed_computed_c_m_per_s"));
}

TEST(Calc, MissingOptionalColumnsTakeTheirDefault) {
  const Outcome given = run({.quantity = "noise"}, "f_kHz,shipping,wind_m_per_s\n10,0.5,0\n");
  const Outcome missing = run({.quantity = "noise"}, "f_kHz\n10\n");
  EXPECT_EQ(given.out.substr(given.out.rfind(",29.35")), missing.out.substr(missing.out.rfind(",29.35")));
}

TEST(Calc, EveryBadCellIsReportedAtOnceAndNothingIsWritten) {
  const Outcome r =
      run({.quantity = "sound-speed"}, "T_degC,S_ppt,depth_m\nhot,35,0\n10,35,0\n10,-1,99999\n");
  EXPECT_EQ(r.code, kCalcBadTable);
  EXPECT_EQ(r.out, "");
  EXPECT_THAT(r.err,
              AllOf(HasSubstr("line 2, column T_degC: 'hot'; allowed is a number from -10 to 60\n"),
                    HasSubstr("line 4, column S_ppt: '-1'"), HasSubstr("line 4, column depth_m: '99999'")));
}

TEST(Calc, NotANumberIsRefused) {
  EXPECT_EQ(run({.quantity = "munk"}, "depth_m\nnan\n").code, kCalcBadTable);
  EXPECT_EQ(run({.quantity = "munk"}, "depth_m\ninf\n").code, kCalcBadTable);
  EXPECT_EQ(run({.quantity = "munk"}, "depth_m\n\"\"\n").code, kCalcBadTable);
}

TEST(Calc, MissingColumnsAreAllNamed) {
  const Outcome r = run({.quantity = "sound-speed", .model = "unesco"}, "T_degC\n1\n");
  EXPECT_EQ(r.code, kCalcBadTable);
  EXPECT_THAT(r.err, AllOf(HasSubstr("no column T68_degC"), HasSubstr("no column S_psu"),
                           HasSubstr("no column p_dbar")));
}

TEST(Calc, AnImpossibleRowNamesItsLine) {
  const Outcome r = run({.quantity = "capacity"},
                        "Ptx_dB_re_1uPa_at_1m,range_m,f_lo_kHz,f_hi_kHz,T_degC,P_atm\n120,100,30,20,10,1\n");
  EXPECT_EQ(r.code, kCalcBadTable);
  EXPECT_THAT(r.err, HasSubstr("line 2: f_lo_kHz has to be below f_hi_kHz"));
}

TEST(Calc, UnknownQuantitiesAndModelsAreAnsweredWithTheKnownOnes) {
  EXPECT_THAT(run({.quantity = "speed"}, "").err, HasSubstr("sound-speed"));
  EXPECT_EQ(run({.quantity = "speed"}, "").code, kCalcBadRequest);
  const Outcome r = run({.quantity = "absorption", .model = "urick"}, "f_kHz\n1\n");
  EXPECT_EQ(r.code, kCalcBadRequest);
  EXPECT_THAT(r.err, HasSubstr("fisher-simmons, francois-garrison, ainslie-mccolm, thorp"));
}

TEST(Calc, TheModelFollowsTheColumnsUnlessNamed) {
  const std::string t68 = "T68_degC,S_psu,p_dbar\n40,40,10000\n",
                    t90 = "T90_degC,S_psu,p_dbar\n40,40,10000\n";
  EXPECT_THAT(run({.quantity = "sound-speed"}, t68).out, HasSubstr(",1731.995"));
  EXPECT_EQ(run({.quantity = "sound-speed"}, t90).out,
            run({.quantity = "sound-speed", .model = "chen-millero"}, t90).out);
}

TEST(Calc, TheModelMovesTheResult) {
  const std::string table = "f_kHz,T_degC\n25,13.3\n";
  EXPECT_NE(run({.quantity = "absorption", .model = "ainslie-mccolm"}, table).out,
            run({.quantity = "absorption", .model = "francois-garrison"}, table).out);
}

TEST(Calc, AFormulaDoesNotReadWhatItDoesNotKnow) {
  // Fisher and Simmons fix salinity and pH: offering the columns would be an input that changes nothing.
  const Outcome fisher = run({.quantity = "absorption", .model = "fisher-simmons", .list = true}, "");
  EXPECT_EQ(fisher.out.substr(0, fisher.out.find("gives")).find("pH"), std::string::npos);
  const std::string salty = "f_kHz,T_degC,S_ppt\n25,10,38\n", fresh = "f_kHz,T_degC,S_ppt\n25,10,20\n";
  const auto result = [](const Outcome& o) {
    return o.out.substr(o.out.rfind('\n', o.out.size() - 2) + 1 + 9);
  };
  EXPECT_NE(result(run({.quantity = "absorption", .model = "ainslie-mccolm"}, salty)),
            result(run({.quantity = "absorption", .model = "ainslie-mccolm"}, fresh)));
}

TEST(Calc, TheProfileMovesTheDelay) {
  const std::string table = "depth_tx_m,depth_rx_m,horizontal_range_m\n0,1000,500\n";
  EXPECT_NE(run({.quantity = "delay"}, table).out, run({.quantity = "delay", .profile = "munk"}, table).out);
  EXPECT_EQ(run({.quantity = "delay", .profile = "/nowhere.csv"}, table).code, kCalcBadRequest);
}

TEST(Calc, ListNamesEveryQuantityWithItsColumns) {
  const Outcome r = run({.list = true}, "");
  EXPECT_EQ(r.code, kCalcDone);
  for (const std::string& name : quantity_names()) EXPECT_THAT(r.out, HasSubstr(name + ": ")) << name;
  EXPECT_THAT(run({.quantity = "pressure", .list = true}, "").out, HasSubstr("may have lat_deg (45)"));
}

TEST(Calc, AModemIsFoundByNameAndByTheFileOfItsProfile) {
  const std::string table = "payload_bytes\n100\n";
  const std::string file = HALOCLINE_SOURCE_DIR "/models/modems/micromodem-psk-4.toml";
  const Outcome by_name = run({.quantity = "packet-duration", .model = "micromodem-psk-4"}, table);
  EXPECT_EQ(by_name.code, kCalcDone) << by_name.err;
  EXPECT_EQ(run({.quantity = "packet-duration", .model = file}, table).out, by_name.out);
  EXPECT_NE(run({.quantity = "packet-duration", .model = "micromodem-fsk"}, "payload_bytes\n30\n").out,
            run({.quantity = "packet-duration", .model = "micromodem-psk-4"}, "payload_bytes\n30\n").out);
  EXPECT_EQ(run({.quantity = "packet-duration", .model = "/nowhere.toml"}, table).code, kCalcBadRequest);
  EXPECT_EQ(run({.quantity = "absorption", .model = file}, table).code, kCalcBadRequest);
}

TEST(Calc, ModelNamesAreThoseOfTheForms) {
  EXPECT_THAT(model_names("sound-speed"), Contains("teos10"));
  EXPECT_THAT(model_names("nothing"), IsEmpty());
}

TEST(Calc, ValuesBeyondAPublishedRangeAreComputedAndSaidOnce) {
  const Outcome inside = run({.quantity = "sound-speed"}, "T_degC,S_ppt,depth_m\n30,40,8000\n");
  EXPECT_EQ(inside.err, "");
  const Outcome one = run({.quantity = "sound-speed"}, "T_degC,S_ppt,depth_m\n10,35,0\n31,35,0\n");
  EXPECT_EQ(one.code, kCalcDone);
  EXPECT_THAT(one.out, HasSubstr("31,35,0,15"));
  EXPECT_EQ(
      one.err,
      "note: line 3, column T_degC: 31 lies outside of the range for which mackenzie was published, -2 to "
      "30\n");
  const Outcome three = run({.quantity = "sound-speed"}, "T_degC,S_ppt,depth_m\n31,41,0\n10,35,9000\n");
  EXPECT_EQ(std::count(three.err.begin(), three.err.end(), '\n'), 1);
  EXPECT_THAT(three.err, HasSubstr("there are 3 values outside of theirs"));
}

TEST(Calc, PublishedRangesAreInTheUnitsOfTheColumns) {
  EXPECT_THAT(
      run({.quantity = "absorption", .model = "fisher-simmons"}, "f_kHz,T_degC\n9,10\n").err,
      HasSubstr("column f_kHz: 9 lies outside of the range for which fisher-simmons was published, 10 to "
                "400"));
  EXPECT_EQ(
      run({.quantity = "sound-speed", .model = "del-grosso"}, "T90_degC,S_psu,P_kg_per_cm2\n10,35,1000\n")
          .err,
      "");
  EXPECT_NE(
      run({.quantity = "sound-speed", .model = "del-grosso"}, "T90_degC,S_psu,P_kg_per_cm2\n10,35,1001\n")
          .err,
      "");
  EXPECT_NE(run({.quantity = "surface-loss"}, "f_kHz,wind_m_per_s,grazing_deg\n5,7,10\n").err, "");
  EXPECT_NE(run({.quantity = "munk"}, "depth_m\n5001\n").err, "");
}

TEST(Calc, RoughnessIsThatOfTheWavesAtTheGrazingAngle) {
  EXPECT_THAT(run({.quantity = "wave-height"}, "wind_m_per_s\n10\n").out, HasSubstr("10,0.5612244"));
  // 2 k sigma sin G = 5.10 at 25 kHz, 5 m/s and 10 degrees.
  EXPECT_THAT(run({.quantity = "rayleigh-parameter"}, "f_kHz,wind_m_per_s,grazing_deg\n25,5,10\n").out,
              HasSubstr("25,5,10,5.10"));
}

TEST(Calc, ASedimentByNameReflectsAsItsNumbersDo) {
  const Outcome by_name = run({.quantity = "bottom-reflection", .model = "MediumSand"}, "grazing_deg\n20\n");
  const Outcome by_numbers =
      run({.quantity = "bottom-reflection"},
          "density_ratio,sound_speed_ratio,loss_parameter_delta,grazing_deg\n1.845,1.1782,0.01624,20\n");
  EXPECT_EQ(by_name.code, kCalcDone) << by_name.err;
  EXPECT_THAT(by_numbers.out, HasSubstr(by_name.out.substr(by_name.out.find("\n20,") + 1)));
}

TEST(Calc, ATableWithoutRowsGivesItsHeader) {
  EXPECT_EQ(run({.quantity = "munk"}, "depth_m\n").out, "depth_m,c_m_per_s\n");
}

}  // namespace
}  // namespace halocline::clients

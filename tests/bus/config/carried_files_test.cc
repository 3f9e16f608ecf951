// SPDX-License-Identifier: BSD-3-Clause
// Paths as keys: where they start, and how the files that they name travel with a configuration.
#include "bus/config/carried_files.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/config/config.h"
#include "core/check.h"
#include "core/files/file_path.h"

namespace halocline::bus {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Sea {
  FilePath cast, raster, model;
  std::vector<FilePath> rates;
};

void visit(ConfigVisitor& v, Sea& sea) {
  v.file("cast", sea.cast, FileNames::kFiles, "");
  v.file("raster", sea.raster, FileNames::kRasters, "");
  v.file("model", sea.model, FileNames::kShipped, "");
  v.files("rates", sea.rates, FileNames::kShipped, "");
}

Sea sea_in(ConfigFile& file) {
  Sea sea;
  file.read([&](ConfigVisitor& v) { visit(v, sea); });
  file.check(/*whole_file=*/true);
  return sea;
}

std::string bytes_of(const std::string& place) {
  std::ifstream in(place, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class CarriedFile : public ::testing::Test {
 protected:
  CarriedFile() { fs::create_directories(folder_ / "sub"); }
  ~CarriedFile() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }
  ConfigFile load(const std::string& toml, const std::vector<std::string>& overrides = {}) const {
    return ConfigFile::load(write("sea.toml", toml), overrides);
  }
  // The configuration that travels, read where none of its files is.
  ConfigFile moved(const std::string& toml) {
    ConfigFile file = load(toml);
    sea_in(file);
    const std::string text = file.to_toml();
    fs::remove_all(folder_);
    return ConfigFile::parse(text, "SCENARIO");
  }

  const fs::path folder_ = fs::path(::testing::TempDir()) / ("carried-" + std::to_string(getpid()));
};

TEST_F(CarriedFile, APathStartsWhereItStands) {
  ConfigFile file =
      load("cast = \"sub/a.csv\"\nraster = \"/data/b.tif\"\nmodel = \"torpedo\"\n", {"rates=c.toml janus"});
  const Sea sea = sea_in(file);
  EXPECT_EQ(sea.cast.place(), (folder_ / "sub/a.csv").string());
  EXPECT_EQ(sea.cast.given(), "sub/a.csv");
  EXPECT_EQ(sea.raster.place(), "/data/b.tif");
  EXPECT_EQ(sea.model.place(), "torpedo");
  ASSERT_EQ(sea.rates.size(), 2u);
  EXPECT_EQ(sea.rates[0].place(), "c.toml");
  EXPECT_EQ(sea.rates[1].place(), "janus");
}

TEST_F(CarriedFile, NamesOfGdalAreNoPaths) {
  ConfigFile file = load("raster = 'NETCDF:\"a.nc\":z'\n");
  EXPECT_EQ(sea_in(file).raster.place(), "NETCDF:\"a.nc\":z");
}

TEST_F(CarriedFile, IsReadByteForByteFarFromItsOrigin) {
  const std::string text = "a \"quoted\" line\r\n\ttab\n\nno end", bytes("\0\xff\x80\n", 4);
  write("sub/a.csv", text);
  write("b.tif", bytes);
  write("c.toml", "");
  ConfigFile file = moved("cast = \"sub/a.csv\"\nraster = \"b.tif\"\nrates = \"c.toml janus\"\n");
  const Sea sea = sea_in(file);
  EXPECT_EQ(bytes_of(sea.cast.place()), text);
  EXPECT_EQ(bytes_of(sea.raster.place()), bytes);
  ASSERT_EQ(sea.rates.size(), 2u);
  EXPECT_EQ(bytes_of(sea.rates[0].place()), "");
  EXPECT_EQ(sea.rates[1].place(), "janus");
  EXPECT_EQ(file.to_toml(), [&] {
    ConfigFile again = ConfigFile::parse(file.to_toml(), "SCENARIO");
    sea_in(again);
    return again.to_toml();
  }());
}

TEST_F(CarriedFile, TwoOfOneNameAreToldApart) {
  write("a.csv", "first");
  write("sub/a.csv", "second");
  ConfigFile file = moved("cast = \"a.csv\"\nraster = \"sub/a.csv\"\n");
  const Sea sea = sea_in(file);
  EXPECT_EQ(bytes_of(sea.cast.place()), "first");
  EXPECT_EQ(bytes_of(sea.raster.place()), "second");
}

// The shell's "..": the parent of the folder to which the link leads.
TEST_F(CarriedFile, IsFoundBehindALinkAsTheSystemFindsIt) {
  fs::create_directories(folder_ / "real/deep");
  fs::create_directory_symlink(folder_ / "real/deep", folder_ / "link");
  write("real/a.csv", "behind the link");
  write("a.csv", "another");
  ConfigFile file = moved("cast = \"link/../a.csv\"\n");
  EXPECT_EQ(bytes_of(sea_in(file).cast.place()), "behind the link");
}

TEST_F(CarriedFile, ARasterMayHaveAColonInItsNameOrItsFolder) {
  fs::create_directories(folder_ / "12:30");
  write("12:30/b.asc", "in the folder");
  write("b12:45.asc", "in the name");
  for (const auto& [path, text] :
       std::map<std::string, std::string>{{"12:30/b.asc", "in the folder"}, {"b12:45.asc", "in the name"}}) {
    ConfigFile file = load("raster = \"" + path + "\"\n");
    EXPECT_EQ(sea_in(file).raster.place(), (folder_ / path).string());
    EXPECT_THAT(file.to_toml(), HasSubstr(text));
  }
  fs::create_directories(folder_ / "A:B");
  write("A:B/c.asc", "in the folder of the scenario");
  std::ofstream(folder_ / "A:B/sea.toml") << "raster = \"c.asc\"\n";
  ConfigFile beside = ConfigFile::load((folder_ / "A:B/sea.toml").string());
  sea_in(beside);
  EXPECT_THAT(beside.to_toml(), HasSubstr("in the folder of the scenario"));
  for (const char* name : {"NETCDF:a.nc:z", "GTIFF_DIR:1:a.tif", "HDF5:a.h5://z", "/vsizip/a.zip"})
    EXPECT_FALSE(names_a_file(name, FileNames::kRasters)) << name;
}

TEST_F(CarriedFile, TheCompanionsOfARasterAreKnownInAnyCase) {
  const auto is_carried_beside = [&](const std::string& raster, const std::string& companion) {
    write(raster, "ncols 1\n");
    if (!companion.empty()) write(companion, "");
    ConfigFile file = load("raster = \"" + raster + "\"\n");
    sea_in(file);
    const bool is_carried = file.to_toml().find("ncols 1") != std::string::npos;
    fs::remove(folder_ / raster);
    fs::remove(folder_ / companion);
    return is_carried;
  };
  EXPECT_TRUE(is_carried_beside("b.asc", "b2.prj"));
  EXPECT_TRUE(is_carried_beside("b.asc", "b.csv"));
  EXPECT_FALSE(is_carried_beside("b.asc", "b.PRJ"));
  EXPECT_FALSE(is_carried_beside("b.img", "b.img.hdr"));
  EXPECT_FALSE(is_carried_beside("bb", "bb.HDR"));
  EXPECT_FALSE(is_carried_beside("b.tif", "b.tifw"));
  EXPECT_FALSE(is_carried_beside("b.tif", "b.TFW"));
  EXPECT_FALSE(is_carried_beside("b.sdat", "b.sgrd"));
  EXPECT_FALSE(is_carried_beside("b.tif", "b.tif.aux.xml"));
}

// `model` names own.toml, which names inner.toml unread; `rates` names inner.toml, which is read and names
// the cast.
TEST_F(CarriedFile, MetBeforeItIsReadBringsTheFilesThatItNamesAllTheSame) {
  write("own.toml", "rates = \"sub/inner.toml\"\n");
  write("sub/inner.toml", "cast = \"a.csv\"\n");
  write("sub/a.csv", "cast");
  ConfigFile file = load("model = \"own.toml\"\nrates = \"sub/inner.toml\"\n");
  const auto nested = [](const FilePath& path) {
    ConfigFile inside = ConfigFile::load_named(path);
    return sea_in(inside);
  };
  const Sea sea = sea_in(file);
  nested(sea.model);
  nested(sea.rates.at(0));
  const std::string text = file.to_toml();
  fs::remove_all(folder_);
  ConfigFile again = ConfigFile::parse(text, "SCENARIO");
  const Sea there = sea_in(again);
  EXPECT_EQ(bytes_of(nested(there.rates.at(0)).cast.place()), "cast");
  EXPECT_EQ(bytes_of(nested(nested(there.model).rates.at(0)).cast.place()), "cast");
}

TEST_F(CarriedFile, BringsTheFilesThatItNamesInTurn) {
  write("sub/inner.toml", "model = \"torpedo\"\n");
  write("sub/own.toml", "cast = \"../a.csv\"\nrates = \"inner.toml\"\n");
  write("a.csv", "cast");
  ConfigFile file = load("model = \"sub/own.toml\"\n");
  const auto nested = [](const FilePath& path) {
    ConfigFile inside = ConfigFile::load_named(path);
    return sea_in(inside);
  };
  nested(sea_in(file).model);
  const std::string text = file.to_toml();
  fs::remove_all(folder_);
  ConfigFile again = ConfigFile::parse(text, "SCENARIO");
  const Sea inside = nested(sea_in(again).model);
  EXPECT_EQ(bytes_of(inside.cast.place()), "cast");
  EXPECT_EQ(bytes_of(inside.rates.at(0).place()), "model = \"torpedo\"\n");
}

TEST_F(CarriedFile, OfAKeyThatDoesNotApplyIsLeftWhereItIs) {
  write("a.csv", "none of the log's business");
  ConfigFile file = load("cast = \"a.csv\"\n");
  FilePath cast;
  file.read([&](ConfigVisitor& v) {
    v.when(false, "profile = \"file\"", [&] { v.file("cast", cast, FileNames::kFiles, ""); });
  });
  file.check(/*whole_file=*/true);
  EXPECT_EQ(file.to_toml(), "cast = \"a.csv\"\n");
}

TEST_F(CarriedFile, IsNoFileToWriteTo) {
  write("own.toml", "cast = \"a.csv\"\n");
  write("a.csv", "cast");
  write("b.csv", "not named");
  ConfigFile file = load("model = \"own.toml\"\nrates = \"janus\"\n");
  ConfigFile inside = ConfigFile::load_named(sea_in(file).model);
  sea_in(inside);
  EXPECT_THAT(file.inputs(), ElementsAre((folder_ / "sea.toml").string(), (folder_ / "own.toml").string(),
                                         (folder_ / "a.csv").string()));
  EXPECT_THROW(file.require_no_input((folder_ / "sub/../a.csv").string()), InvalidArgument);
  file.require_no_input((folder_ / "b.csv").string());
  file.require_no_input("");
}

TEST_F(CarriedFile, StaysAsLongAsItsPathAndNoLonger) {
  write("a.csv", "cast");
  FilePath cast;
  {
    ConfigFile file = moved("cast = \"a.csv\"\n");
    cast = sea_in(file).cast;
  }
  const std::string place = cast.place();
  EXPECT_EQ(bytes_of(place), "cast");
  cast = FilePath();
  EXPECT_FALSE(fs::exists(place));
}

TEST_F(CarriedFile, AboveAMegabyteOrWithCompanionsIsNamedByItsPlace) {
  const std::string large = write("large.csv", std::string(kMaxCarriedBytes + 1, '1'));
  const std::string raster = write("small.asc", "ncols 1\n");
  write("small.prj", "");
  ConfigFile file = load("cast = \"large.csv\"\nraster = \"small.asc\"\n");
  sea_in(file);
  const std::string text = file.to_toml();
  EXPECT_LT(text.size(), 2000u);
  {
    ConfigFile again = ConfigFile::parse(text, "SCENARIO");
    const Sea sea = sea_in(again);
    EXPECT_EQ(sea.cast.place(), large);
    EXPECT_EQ(sea.raster.place(), raster);
    EXPECT_THAT(again.warnings(), IsEmpty());
  }
  write("large.csv", std::string(kMaxCarriedBytes + 1, '2'));
  ConfigFile changed = ConfigFile::parse(text, "SCENARIO");
  sea_in(changed);
  EXPECT_THAT(changed.warnings(), ElementsAre(HasSubstr("it is another file than the one of 1000001 bytes")));
  fs::remove(large);
  ConfigFile gone = ConfigFile::parse(text, "SCENARIO");
  Sea sea;
  gone.read([&](ConfigVisitor& v) {
    visit(v, sea);
    require_readable(v, "cast", sea.cast);
  });
  try {
    gone.check(/*whole_file=*/true);
    FAIL() << "nothing was refused";
  } catch (const ConfigErrors& errors) {
    EXPECT_THAT(errors.what(),
                HasSubstr("cannot read " + large + ": there is no such file; a file of 1000001 bytes"));
  }
}

TEST_F(CarriedFile, OfAnotherHashOrOfAPlaceOutsideIsRefused) {
  const auto error_of = [](const std::string& table) -> std::string {
    try {
      ConfigFile::parse("[[file]]\n" + table, "SCENARIO");
    } catch (const ConfigErrors& errors) {
      return errors.what();
    }
    return "";
  };
  EXPECT_THAT(error_of("name = \"a\"\nxxh3 = \"0\"\nlines = [\"x\"]\n"),
              HasSubstr("its bytes have the hash"));
  for (const std::string name : {"../a", "/etc/a", "..", ""})
    EXPECT_THAT(error_of("name = \"" + name + "\"\nplace = \"/a\"\nbytes = 1\n"),
                HasSubstr("without a folder"));
  EXPECT_THAT(error_of("name = \"a\"\nbase64 = [\"!\"]\n"), HasSubstr("base64"));
  EXPECT_THAT(error_of("name = \"a\"\n"), HasSubstr("is missing"));
}

TEST_F(CarriedFile, WarningsOfAFileThatIsReadAreThoseOfTheConfiguration) {
  write("own.toml", "x = 1\n");
  ConfigFile file = load("model = \"own.toml\"\n");
  file.read([&](ConfigVisitor& v) {
    Sea sea;
    visit(v, sea);
    ConfigFile inside = ConfigFile::load_named(sea.model);
    inside.read([](ConfigVisitor& w) {
      double x = 0;
      w.when(false, "y = 2", [&] { w.number("x", x, {0, 9, "", ""}); });
    });
    inside.check(/*whole_file=*/true);
  });
  file.check(/*whole_file=*/true);
  EXPECT_THAT(file.warnings(),
              ElementsAre(HasSubstr("own.toml:1: x is 1; it has no effect, it counts only with y = 2")));
}

// What a scenario includes is as if it stood there: it goes before the scenario's own values and behind
// overrides, and travels within the configuration.
TEST_F(CarriedFile, ValuesOfAnIncludedFileReplaceThoseOfTheFile) {
  const auto read = [](ConfigFile& file) {
    std::array<double, 3> values{};
    file.read([&](ConfigVisitor& v) {
      v.section("sea", "", [&](ConfigVisitor& s) {
        s.number("wind", values[0], {0, 9, "", ""});
        s.number("rain", values[1], {0, 9, "", ""});
        s.number("noise", values[2], {0, 9, "", ""});
      });
    });
    file.check(/*whole_file=*/true);
    return values;
  };
  const std::string included = write("fit.toml", "[sea]\nrain = 5\nnoise = 6\n");
  const std::string own = "include = \"fit.toml\"\n[sea]\nwind = 1\nrain = 2\n";
  ConfigFile file = load(own);
  EXPECT_EQ(read(file), (std::array<double, 3>{1, 5, 6}));
  EXPECT_THAT(file.warnings(), ElementsAre(HasSubstr("sea.rain is 2")));
  EXPECT_THAT(file.inputs(), ::testing::Contains(included));
  ConfigFile overridden = load(own, {"sea.noise=7"});
  EXPECT_EQ(read(overridden), (std::array<double, 3>{1, 5, 7}));
  ConfigFile travelled = ConfigFile::parse(file.to_toml(), "SCENARIO");
  EXPECT_EQ(read(travelled), (std::array<double, 3>{1, 5, 6}));
}

TEST_F(CarriedFile, ErrorsOfAnIncludedFileNameItsLine) {
  write("fit.toml", "[sea]\nrain = 50\n");
  ConfigFile file = load("include = \"fit.toml\"\n");
  double rain = 0;
  file.read([&](ConfigVisitor& v) {
    v.section("sea", "", [&](ConfigVisitor& s) { s.number("rain", rain, {0, 9, "", ""}); });
  });
  try {
    file.check(/*whole_file=*/true);
    FAIL() << "nothing was refused";
  } catch (const ConfigErrors& errors) {
    EXPECT_THAT(errors.lines(), ElementsAre(HasSubstr("fit.toml:2: sea.rain is 50")));
  }
}

TEST_F(CarriedFile, AFileThatCannotBeIncludedIsRefused) {
  EXPECT_THROW(load("include = \"none.toml\"\n"), ConfigErrors);
  EXPECT_THROW(load("include = 3\n"), ConfigErrors);
  write("other.toml", "include = \"sea.toml\"\n");
  EXPECT_THROW(load("include = \"other.toml\"\n"), ConfigErrors);
}

}  // namespace
}  // namespace halocline::bus

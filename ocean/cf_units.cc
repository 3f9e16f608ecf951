// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/cf_units.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/csv_table.h"
#include "core/text/lower_case.h"

namespace halocline::ocean {
namespace {

constexpr double kKelvin = 273.15;      // temperature of 0 degC, K
constexpr double kPascalPerDbar = 1e4;  // BIPM
constexpr double kDegreesPerRadian = 57.29577951308232;

using Powers = std::array<int, 3>;
constexpr Powers kMetre{1, 0, 0}, kKilogram{0, 1, 0}, kSecond{0, 0, 1}, kMetrePerSecond{1, 0, -1},
    kPascal{-1, 1, -2};

struct Unit {
  double factor = 1;  // to SI
  Powers powers{};
};

struct NamedUnit {
  std::string_view name;
  Unit unit;
};

// Symbols take symbolic prefixes and are case-sensitive; names take the prefixes that are words.
constexpr std::array kSymbols{NamedUnit{"m", {1, kMetre}},       NamedUnit{"g", {1e-3, kKilogram}},
                              NamedUnit{"s", {1, kSecond}},      NamedUnit{"h", {3600, kSecond}},
                              NamedUnit{"d", {86'400, kSecond}}, NamedUnit{"Pa", {1, kPascal}},
                              NamedUnit{"bar", {1e5, kPascal}}};
constexpr std::array kNames{NamedUnit{"meter", {1, kMetre}},
                            NamedUnit{"metre", {1, kMetre}},
                            NamedUnit{"gram", {1e-3, kKilogram}},
                            NamedUnit{"second", {1, kSecond}},
                            NamedUnit{"sec", {1, kSecond}},
                            NamedUnit{"min", {60, kSecond}},
                            NamedUnit{"minute", {60, kSecond}},
                            NamedUnit{"hr", {3600, kSecond}},
                            NamedUnit{"hour", {3600, kSecond}},
                            NamedUnit{"day", {86'400, kSecond}},
                            NamedUnit{"week", {604'800, kSecond}},
                            NamedUnit{"fortnight", {1'209'600, kSecond}},
                            NamedUnit{"pascal", {1, kPascal}},
                            NamedUnit{"bar", {1e5, kPascal}},
                            NamedUnit{"psi", {6894.757293168, kPascal}},
                            NamedUnit{"atmosphere", {101'325, kPascal}},
                            NamedUnit{"atm", {101'325, kPascal}},
                            NamedUnit{"in", {0.0254, kMetre}},
                            NamedUnit{"inch", {0.0254, kMetre}},
                            NamedUnit{"ft", {0.3048, kMetre}},
                            NamedUnit{"foot", {0.3048, kMetre}},
                            NamedUnit{"feet", {0.3048, kMetre}},
                            NamedUnit{"yard", {0.9144, kMetre}},
                            NamedUnit{"fathom", {1.8288, kMetre}},
                            NamedUnit{"mile", {1609.344, kMetre}},
                            NamedUnit{"nautical_mile", {1852, kMetre}},
                            NamedUnit{"nmile", {1852, kMetre}},
                            NamedUnit{"knot", {1852.0 / 3600, kMetrePerSecond}},
                            NamedUnit{"kt", {1852.0 / 3600, kMetrePerSecond}}};

using Prefix = std::pair<std::string_view, double>;
constexpr std::array kSymbolPrefixes{Prefix{"da", 10},  Prefix{"G", 1e9},  Prefix{"M", 1e6},
                                     Prefix{"k", 1e3},  Prefix{"h", 100},  Prefix{"d", 0.1},
                                     Prefix{"c", 0.01}, Prefix{"m", 1e-3}, Prefix{"u", 1e-6},
                                     Prefix{"µ", 1e-6}, Prefix{"n", 1e-9}, Prefix{"p", 1e-12}};
constexpr std::array kNamePrefixes{Prefix{"giga", 1e9},   Prefix{"mega", 1e6},   Prefix{"kilo", 1e3},
                                   Prefix{"hecto", 100},  Prefix{"deca", 10},    Prefix{"deci", 0.1},
                                   Prefix{"centi", 0.01}, Prefix{"milli", 1e-3}, Prefix{"micro", 1e-6},
                                   Prefix{"nano", 1e-9},  Prefix{"pico", 1e-12}, Prefix{"d", 0.1},
                                   Prefix{"m", 1e-3}};  // "dbar" in any case, "msec"

template <class Names>
std::optional<Unit> exactly(const Names& names, std::string_view word) {
  const auto found =
      std::find_if(names.begin(), names.end(), [&](const NamedUnit& one) { return one.name == word; });
  return found == names.end() ? std::nullopt : std::optional(found->unit);
}

template <class Names, class Prefixes>
std::optional<Unit> with_prefix(const Names& names, const Prefixes& prefixes, std::string_view word) {
  if (const auto unit = exactly(names, word)) return unit;
  for (const auto& [prefix, factor] : prefixes) {
    if (!word.starts_with(prefix)) continue;
    if (const auto unit = exactly(names, word.substr(prefix.size())))
      return Unit{unit->factor * factor, unit->powers};
  }
  return std::nullopt;
}

std::optional<Unit> unit_of_word(std::string_view word) {
  if (const auto unit = with_prefix(kSymbols, kSymbolPrefixes, word)) return unit;
  const std::string name = lower_case(word);
  if (const auto unit = with_prefix(kNames, kNamePrefixes, name)) return unit;
  const bool is_plural = name.size() > 2 && name.back() == 's';
  return is_plural ? with_prefix(kNames, kNamePrefixes, std::string_view(name).substr(0, name.size() - 1))
                   : std::nullopt;
}

// Reader of the factors of a unit: cuts one word or number with its exponent off the front of the text.
class Factors {
 public:
  explicit Factors(std::string_view text) : rest_(text) {}

  bool is_done() {
    while (take(" ")) continue;
    return rest_.empty();
  }
  // True when the next factor divides; skips the operator before it.
  bool divides() {
    if (take("/")) return true;
    if (!take("*")) take(".");
    return false;
  }
  std::optional<Unit> next() {
    is_done();
    if (rest_.empty()) return std::nullopt;
    const bool is_number = std::isdigit(static_cast<unsigned char>(rest_.front())) != 0;
    std::optional<Unit> unit = is_number ? number() : word();
    if (!unit || is_number) return unit;
    const int power = exponent();
    Unit raised{1, unit->powers};
    for (int& one : raised.powers) one *= power;
    for (int i = std::abs(power); i > 0; --i) raised.factor *= unit->factor;
    if (power < 0) raised.factor = 1 / raised.factor;
    return raised;
  }

 private:
  bool take(std::string_view sign) {
    if (!rest_.starts_with(sign)) return false;
    rest_.remove_prefix(sign.size());
    return true;
  }
  std::string_view cut(std::string_view allowed_beside_letters) {
    const auto belongs = [&](char c) {
      return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80 ||
             allowed_beside_letters.find(c) != std::string_view::npos;
    };
    const auto end = std::find_if_not(rest_.begin(), rest_.end(), belongs);
    const std::string_view front = rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
    rest_.remove_prefix(front.size());
    return front;
  }
  std::optional<Unit> number() {
    const std::string_view digits = cut("0123456789.+-");
    const auto value = parse_number(digits);
    return value ? std::optional(Unit{*value, {}}) : std::nullopt;
  }
  std::optional<Unit> word() { return unit_of_word(cut("_")); }
  int exponent() {
    if (!take("^")) take("**");
    const bool is_negative = take("-");
    if (!is_negative) take("+");
    if (rest_.empty() || std::isdigit(static_cast<unsigned char>(rest_.front())) == 0) return 1;
    const int power = rest_.front() - '0';
    rest_.remove_prefix(1);
    return is_negative ? -power : power;
  }

  std::string_view rest_;
};

std::optional<Unit> parsed(std::string_view text) {
  Factors factors(text);
  Unit product;
  bool has_any = false;
  while (!factors.is_done()) {
    const bool divides = factors.divides();
    const std::optional<Unit> next = factors.next();
    if (!next || (divides && !has_any)) return std::nullopt;
    product.factor = divides ? product.factor / next->factor : product.factor * next->factor;
    for (std::size_t i = 0; i < product.powers.size(); ++i)
      product.powers[i] += divides ? -next->powers[i] : next->powers[i];
    has_any = true;
  }
  return has_any ? std::optional(product) : std::nullopt;
}

std::optional<UnitFactor> parsed_as(std::string_view text, const Powers& powers, double si_per_unit = 1) {
  const std::optional<Unit> unit = parsed(text);
  const bool is_right = unit && unit->powers == powers && std::isfinite(unit->factor) && unit->factor > 0;
  return is_right ? std::optional(UnitFactor{unit->factor / si_per_unit}) : std::nullopt;
}

// Returns lower-case text without blanks, dots and underscores: "deg. C" becomes "degc".
std::string folded(std::string_view text) {
  std::string result = lower_case(text);
  std::erase_if(result, [](char c) { return c == ' ' || c == '.' || c == '_'; });
  return result;
}

std::string_view without_first(std::string_view text, std::initializer_list<std::string_view> starts) {
  for (const std::string_view start : starts) {
    if (text.starts_with(start)) return text.substr(start.size());
  }
  return text;
}

std::optional<UnitFactor> temperature_unit(std::string_view text) {
  const std::string whole = folded(text);
  const std::string_view scale = without_first(whole, {"degrees", "degree", "degs", "deg", "°"});
  if (scale == "c" || scale == "celsius" || scale == "centigrade") return UnitFactor{};
  if (scale == "k" || scale == "kelvin" || scale == "kelvins") return UnitFactor{1, -kKelvin};
  if (scale == "f" || scale == "fahrenheit") return UnitFactor{5.0 / 9, -160.0 / 9};
  return std::nullopt;
}

std::optional<UnitFactor> salinity_unit(std::string_view text) {
  const std::string unit = folded(text);
  constexpr std::array<std::string_view, 13> kKnown{"",
                                                    "psu",
                                                    "pss-78",
                                                    "pss78",
                                                    "pss",
                                                    "ppt",
                                                    "gkg-1",
                                                    "g/kg",
                                                    "gkg^-1",
                                                    "partsperthousand",
                                                    "practicalsalinityscale",
                                                    "permil",
                                                    "‰"};
  if (std::find(kKnown.begin(), kKnown.end(), unit) != kKnown.end()) return UnitFactor{};
  const auto number = parse_number(text);
  return number && (*number == 1 || *number == 1e-3) ? std::optional(UnitFactor{}) : std::nullopt;
}

// Returns the text after the word for degrees: "n" for "degrees_n", "" for "degrees"; empty when there is no
// such word.
std::optional<std::string> after_degrees(std::string_view text) {
  const std::string unit = folded(text);
  const std::string_view rest = without_first(unit, {"degrees", "degree", "deg", "°"});
  return rest.size() < unit.size() ? std::optional(std::string(rest)) : std::nullopt;
}

std::optional<UnitFactor> angle_unit(std::string_view text) {
  const std::string unit = folded(text);
  if (unit == "radian" || unit == "radians" || unit == "rad") return UnitFactor{kDegreesPerRadian};
  const auto rest = after_degrees(text);
  const bool is_degree = rest && (rest->empty() || direction_in(text) != Direction::kUnknown);
  return is_degree ? std::optional(UnitFactor{}) : std::nullopt;
}

std::optional<UnitFactor> length_unit(std::string_view text) {
  const std::string unit = folded(text);
  if (unit == "us-ft" || unit == "ussurveyfoot" || unit == "ussurveyfeet") return UnitFactor{1200.0 / 3937};
  return parsed_as(text, kMetre);
}

}  // namespace

std::optional<UnitFactor> unit_in(QuantityKind quantity, std::string_view text) {
  const std::string unit = folded(text);
  switch (quantity) {
    case QuantityKind::kTemperature:
      return temperature_unit(text);
    case QuantityKind::kSalinity:
      return salinity_unit(text);
    case QuantityKind::kAngle:
      return angle_unit(text);
    case QuantityKind::kLength:
      return length_unit(text);
    case QuantityKind::kSpeed:  // the blank is often missing, and "ms-1" is not a speed by the grammar
      return unit == "ms-1" || unit == "ms^-1" || unit == "ms**-1"
                 ? UnitFactor{}
                 : parsed_as(lower_case(text), kMetrePerSecond);
    case QuantityKind::kPressure:
      return unit == "db" ? UnitFactor{} : parsed_as(text, kPascal, kPascalPerDbar);
    case QuantityKind::kTime:
      return parsed_as(text, kSecond);
  }
  return std::nullopt;
}

Direction direction_in(std::string_view text) {
  const std::string rest = after_degrees(text).value_or("");
  if (rest == "n" || rest == "north") return Direction::kNorth;
  return rest == "e" || rest == "east" ? Direction::kEast : Direction::kUnknown;
}

std::string allowed_units(QuantityKind quantity) {
  switch (quantity) {
    case QuantityKind::kTemperature:
      return "degC, K or degF";
    case QuantityKind::kSpeed:
      return "m s-1, cm s-1, knot or another unit of speed";
    case QuantityKind::kSalinity:
      return "psu, 1, 1e-3, g kg-1 or none";
    case QuantityKind::kLength:
      return "m, km, ft or another unit of length";
    case QuantityKind::kPressure:
      return "dbar, Pa or another unit of pressure";
    case QuantityKind::kTime:
      return "seconds, minutes, hours, days or another unit of fixed length";
    case QuantityKind::kAngle:
      return "degrees_north, degrees_east, degrees or radians";
  }
  return "";
}

}  // namespace halocline::ocean

// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/published_range.h"

#include <cmath>
#include <string_view>

#include "acoustics/sea/pressure.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/csv_table.h"

namespace halocline::acoustics {
namespace {

constexpr double kDecibarPerKilogram = 9.80665;  // one kilogram-force per square centimetre

// Checks the inputs of one formula and keeps a note about the first that is out of range.
class Inputs {
 public:
  explicit Inputs(std::string_view formula) : formula_(formula) {}

  void check(std::string_view what, double value, const PublishedRange& range, std::string_view unit) {
    if (!note_.empty() || range.holds(value)) return;
    note_ = std::string(what) + " of " + format_number(value) + (unit.empty() ? "" : " ") +
            std::string(unit) + " lies outside of the range for which " + formula_ + " was published, " +
            format_number(range.lowest) + " to " + format_number(range.highest);
  }
  const std::string& note() const { return note_; }

 private:
  std::string formula_, note_;
};

// Published ranges are in whole psu: the salinity is rounded to tenths before it is compared.
double stated_salinity(double salinity_psu) { return std::round(10 * salinity_psu) / 10; }

// The depths of the profile's rows above `deepest_m`, with 0 and `deepest_m`.
std::vector<double> depths_to(const SoundSpeedProfile& profile, double deepest_m) {
  std::vector<double> depths = {0, deepest_m};
  for (const double depth : profile.row_depths_m()) {
    if (depth < deepest_m) depths.push_back(depth);
  }
  return depths;
}

std::string note_of_speed(const Environment& environment, double deepest_m) {
  const SoundSpeedProfile& profile = environment.profile;
  if (!profile.knows_water()) return {};
  const PublishedWater range = published_water(profile.model());
  Inputs inputs(to_name(profile.model()));
  for (const double depth : depths_to(profile, deepest_m)) {
    const WaterSample water = profile.water(depth);
    inputs.check("a temperature", water.temperature_degc, range.temperature_degc, "degC");
    inputs.check("a salinity", stated_salinity(water.salinity_psu), range.salinity_psu, "psu");
    inputs.check("a depth", depth, range.depth_m, "m");
    inputs.check("a pressure", standard_ocean_pressure_dbar(depth, environment.latitude_rad),
                 range.pressure_dbar, "dbar");
  }
  return inputs.note();
}

std::string note_of_absorption(const Environment& environment, const Band& band, double deepest_m) {
  const PublishedAbsorption range = published_absorption(environment.absorption_model);
  Inputs inputs(to_name(environment.absorption_model));
  for (const double frequency : {band.low_hz, band.high_hz})
    inputs.check("a frequency", frequency, range.frequency_hz, "Hz");
  for (const double depth : depths_to(environment.profile, deepest_m)) {
    const WaterSample water = environment.profile.water(depth);
    inputs.check("a temperature", water.temperature_degc, range.temperature_degc, "degC");
    inputs.check("a salinity", stated_salinity(water.salinity_psu), range.salinity_psu, "psu");
    inputs.check("a depth", depth, range.depth_m, "m");
  }
  inputs.check("a pH", environment.ph, range.ph, "");
  return inputs.note();
}

std::string note_of_noise(const Band& band) {
  Inputs inputs("the noise of Coates");
  for (const double frequency : {band.low_hz, band.high_hz})
    inputs.check("a frequency", frequency, kPublishedNoiseHz, "Hz");
  return inputs.note();
}

}  // namespace

PublishedWater published_water(SoundSpeedModel model) {
  switch (model) {
    case SoundSpeedModel::kMackenzie1981:
      return {{-2, 30}, {25, 40}, {0, 8000}, {}};
    case SoundSpeedModel::kUnescoChenMillero:
    case SoundSpeedModel::kChenMilleroWongZhu1995:
      return {{0, 40}, {0, 40}, {}, {0, 10'000}};
    case SoundSpeedModel::kDelGrossoWongZhu1995:
      return {{0, 30}, {30, 40}, {}, {0, 1000 * kDecibarPerKilogram}};
    case SoundSpeedModel::kTeos10:
      return {{-2, 40}, {0, 42}, {}, {0, 8000}};
    case SoundSpeedModel::kHarrisZorzi2007:
      return {{0, 35}, {0, 45}, {0, 4000}, {}};
  }
  return {};
}

PublishedAbsorption published_absorption(AbsorptionModel model) {
  switch (model) {
    case AbsorptionModel::kFisherSimmons1977:
      return {{10e3, 400e3}, {}, {}, {}, {}};
    case AbsorptionModel::kFrancoisGarrison1982:
      return {{200, 1e6}, {-2, 22}, {30, 35}, {}, {}};
    case AbsorptionModel::kAinslieMcColm1998:
      return {{100, 1e6}, {-6, 35}, {5, 50}, {0, 7000}, {7.7, 8.3}};
    case AbsorptionModel::kThorpExtended:
      return {{400, 50e3}, {}, {}, {}, {}};
    case AbsorptionModel::kThorpLowFrequency:
      return {{0, 400}, {}, {}, {}, {}};
    case AbsorptionModel::kThorp1967:
    case AbsorptionModel::kThorpPiecewise:
    case AbsorptionModel::kThorpJensen:
      return {{100, 50e3}, {}, {}, {}, {}};
  }
  return {};
}

PublishedRange published_surface_loss_hz(SurfaceModel model) {
  return model == SurfaceModel::kAplBubbles ? PublishedRange{10e3, 100e3} : PublishedRange{};
}

std::vector<std::string> beyond_published_ranges(const Environment& environment, const Band& band,
                                                 double deepest_m) {
  std::vector<std::string> notes = {note_of_speed(environment, deepest_m),
                                    note_of_absorption(environment, band, deepest_m), note_of_noise(band)};
  std::erase_if(notes, [](const std::string& note) { return note.empty(); });
  return notes;
}

}  // namespace halocline::acoustics

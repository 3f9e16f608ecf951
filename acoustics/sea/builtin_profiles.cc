// The profiles that ship with the project.
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr double kMeanLatitude = to_radians(45);  // where standard gravity is defined

// Levitus 1998, World Ocean Atlas: mean temperature and salinity of all oceans.
std::vector<WaterRow> levitus_1998_rows() {
  return {{0, 17.26, 34.89},   {50, 15.09, 35.01},  {100, 13.3, 35.03}, {150, 11.89, 34.98},
          {250, 9.98, 34.86},  {350, 8.57, 34.76},  {450, 7.39, 34.68}, {550, 6.44, 34.63},
          {750, 5.13, 34.59},  {950, 4.21, 34.61},  {1450, 2.97, 34.7}, {1950, 2.32, 34.74},
          {2450, 1.96, 34.75}, {2950, 1.72, 34.74}, {3950, 1.37, 34.73}};
}

}  // namespace

SoundSpeedProfile SoundSpeedProfile::global_mean(SoundSpeedModel model) {
  return from_water(levitus_1998_rows(), model, kMeanLatitude);
}

SoundSpeedProfile SoundSpeedProfile::global_mean_of_salinity_35(SoundSpeedModel model) {
  std::vector<WaterRow> rows = levitus_1998_rows();
  for (WaterRow& row : rows) row.salinity_psu = 35;
  return from_water(std::move(rows), model, kMeanLatitude);
}

SoundSpeedProfile SoundSpeedProfile::harris_zorzi(SoundSpeedModel model) {
  // Their slope below 1000 m is rounded, 4.57139 - 5.7142e-4 z: it starts 3e-5 degC under the 4 degC that the
  // slope above ends with. The row just below 1000 m keeps that step, because published delays contain it.
  const double just_below_1000_m = std::nextafter(1000.0, kDeepestWater);
  const double start_of_deep_slope = 4.57139 - 5.7142e-4 * 1000;
  return from_water({{0, 22, 35},
                     {250, 22, 35},
                     {750, 8, 35},
                     {1000, 4, 35},
                     {just_below_1000_m, start_of_deep_slope, 35},
                     {4500, 2, 35}},
                    model, kMeanLatitude);
}

std::optional<SoundSpeedProfile> built_in_profile(std::string_view name, std::optional<SoundSpeedModel> model,
                                                  WaterSample assumed) {
  const SoundSpeedModel speed = model.value_or(SoundSpeedModel::kMackenzie1981);
  if (name == "global-mean") return SoundSpeedProfile::global_mean(speed);
  if (name == "global-mean-s35") return SoundSpeedProfile::global_mean_of_salinity_35(speed);
  if (name == "harris-zorzi") {
    return SoundSpeedProfile::harris_zorzi(model.value_or(SoundSpeedModel::kHarrisZorzi2007));
  }
  if (name == "munk") return SoundSpeedProfile::munk(assumed);
  return std::nullopt;
}

}  // namespace halocline::acoustics

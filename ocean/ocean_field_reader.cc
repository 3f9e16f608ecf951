// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/ocean_field_reader.h"

#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include "core/files/guarded_reading.h"
#include "core/shared_module.h"

namespace halocline::ocean {

std::shared_ptr<const OceanField> read_ocean_field(const FieldQuery& query) {
  static const auto read = reinterpret_cast<OceanFieldReader*>(
      module_symbol("halocline_ocean_fields.so", "halocline_read_ocean_field"));
  using Key = std::tuple<std::string, std::string, double, double>;
  static std::mutex mutex;
  static std::map<Key, std::weak_ptr<const OceanField>> kept;
  const std::lock_guard lock(mutex);
  std::weak_ptr<const OceanField>& known =
      kept[{query.path, query.start_date, query.origin.latitude_rad, query.origin.longitude_rad}];
  std::shared_ptr<const OceanField> field = known.lock();
  if (field) return field;
  field.reset(guarded_reading({query.path}, [&] { return read(query); }));
  known = field;
  return field;
}

WaterColumn read_water_column(const ColumnQuery& query) {
  static const auto read = reinterpret_cast<WaterColumnReader*>(
      module_symbol("halocline_ocean_fields.so", "halocline_read_water_column"));
  std::vector<std::string> paths{query.temperature_path};
  if (!query.salinity_path.empty()) paths.push_back(query.salinity_path);
  return guarded_reading(paths, [&] { return std::move(*std::unique_ptr<WaterColumn>(read(query))); });
}

}  // namespace halocline::ocean

// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/vehicle_style.h"

#include <array>
#include <cstddef>

#include <fmt/format.h>

#include "viewer/report/svg.h"

namespace halocline::clients {
namespace {

// Colour as "#rrggbb" on a light and on a dark page.
struct VehicleColour {
  const char* on_light;
  const char* on_dark;
};

constexpr std::size_t kVehicleColours = 8;
// Colours in an order in which the first few differ the most.
constexpr std::array<VehicleColour, kVehicleColours> kColours{{{"#2d2f84", "#719cf5"},
                                                               {"#c37f00", "#e9cd56"},
                                                               {"#9835c8", "#9754ed"},
                                                               {"#2098db", "#4a798d"},
                                                               {"#c03809", "#dd8736"},
                                                               {"#585e69", "#d3e0ea"},
                                                               {"#52102c", "#b54a48"},
                                                               {"#988b94", "#b9a9ad"}}};
constexpr std::array<const char*, 4> kDashes{"none", "7 3", "2 3", "9 3 2 3"};

}  // namespace

std::string colour_of(const VehicleRecord& vehicle) {
  return fmt::format("v-{}", vehicle.index % kVehicleColours);
}

std::string classes_of(const VehicleRecord* vehicle) {
  if (vehicle == nullptr) return "";
  return fmt::format("{} dash-{}", colour_of(*vehicle), vehicle->index / kVehicleColours % kDashes.size());
}

std::string swatch(const VehicleRecord* vehicle, double x, double y) {
  return fmt::format(R"(<path d="M{} {}h22" class="swatch {}"/>)", px(x - 11), px(y), classes_of(vehicle));
}

std::string vehicle_style(bool on_dark) {
  std::string style;
  for (std::size_t i = 0; i < kColours.size(); ++i)
    style += fmt::format("--v-{}: {}; ", i, on_dark ? kColours[i].on_dark : kColours[i].on_light);
  return ":root { " + style + "}\n";
}

std::string vehicle_classes() {
  std::string style;
  for (std::size_t i = 0; i < kColours.size(); ++i)
    style += fmt::format(".v-{0} {{ color: var(--v-{0}); }}\n", i);
  for (std::size_t i = 0; i < kDashes.size(); ++i)
    style += fmt::format(".track.dash-{0}, .swatch.dash-{0} {{ stroke-dasharray: {1}; }}\n", i, kDashes[i]);
  return style;
}

}  // namespace halocline::clients

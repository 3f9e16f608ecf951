// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/frequency_band.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

void add_panels(std::vector<FrequencyNode>& nodes, double low_hz, double high_hz, double panel_ratio,
                const GaussLegendreRule& rule) {
  // Panels of equal ratio:
  //   f_k = low (high / low)^(k / n),  n = ceil(ln(high / low) / ln(panel_ratio))
  const double wanted = elementary::log(high_hz / low_hz) / elementary::log(panel_ratio);
  const int panels = std::max(1, static_cast<int>(std::ceil(wanted)));
  double from = low_hz;
  for (int panel = 1; panel <= panels; ++panel) {
    const double share = static_cast<double>(panel) / panels;
    const double to = panel == panels ? high_hz : low_hz * elementary::pow(high_hz / low_hz, share);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      nodes.push_back({(from + to) / 2 + (to - from) / 2 * rule.nodes[i], (to - from) / 2 * rule.weights[i]});
    }
    from = to;
  }
}

}  // namespace

double band_share(const Band& of, const Band& in) {
  const double shared_hz = std::min(of.high_hz, in.high_hz) - std::max(of.low_hz, in.low_hz);
  return std::clamp(shared_hz / of.width_hz(), 0.0, 1.0);
}

std::vector<FrequencyNode> frequency_nodes(double low_hz, double high_hz, double panel_ratio,
                                           const GaussLegendreRule& rule) {
  require(low_hz > 0 && low_hz <= high_hz && std::isfinite(high_hz), "a band needs 0 < low_hz <= high_hz");
  std::vector<FrequencyNode> nodes;
  const bool joint_inside = low_hz < kThorpJointHz && kThorpJointHz < high_hz;
  if (joint_inside) add_panels(nodes, low_hz, kThorpJointHz, panel_ratio, rule);
  add_panels(nodes, joint_inside ? kThorpJointHz : low_hz, high_hz, panel_ratio, rule);
  return nodes;
}

}  // namespace halocline::acoustics

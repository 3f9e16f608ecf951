// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/report/vehicle_style.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace halocline::clients {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Linear light of "#rrggbb" (IEC 61966-2-1).
Vector3d linear(const std::string& hex) {
  Vector3d rgb;
  for (int i = 0; i < 3; ++i) {
    const double value = std::stoi(hex.substr(1 + 2 * static_cast<std::size_t>(i), 2), nullptr, 16) / 255.0;
    rgb[i] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  return rgb;
}

double contrast(const Vector3d& a, const Vector3d& b) {  // WCAG 2.1
  const auto luminance = [](const Vector3d& c) { return c.dot(Vector3d(0.2126, 0.7152, 0.0722)) + 0.05; };
  return std::max(luminance(a), luminance(b)) / std::min(luminance(a), luminance(b));
}

Vector3d oklab(const Vector3d& rgb) {  // Ottosson 2020
  Matrix3d cones, lab;
  cones << 0.4122214708, 0.5363325363, 0.0514459929, 0.2119034982, 0.6806995451, 0.1073969566, 0.0883024619,
      0.2817188376, 0.6299787005;
  lab << 0.2104542553, 0.7936177850, -0.0040720468, 1.9779984951, -2.4285922050, 0.4505937099, 0.0259040371,
      0.7827717662, -0.8086757660;
  return lab * (cones * rgb).unaryExpr([](double x) { return std::cbrt(x); });
}

// Machado, Oliveira and Fernandes 2009, table 1, severity 1: none, protanomaly, deuteranomaly, tritanomaly.
std::vector<Matrix3d> eyes() {
  std::vector<Matrix3d> all(4, Matrix3d::Identity());
  all[1] << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
  all[2] << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
  all[3] << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900;
  return all;
}

double least_difference(const std::vector<Vector3d>& colours) {
  double least = HUGE_VAL;
  for (const Matrix3d& eye : eyes()) {
    std::vector<Vector3d> seen;
    for (const Vector3d& colour : colours) seen.push_back(oklab((eye * colour).cwiseMax(0).cwiseMin(1)));
    for (std::size_t i = 0; i < seen.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) least = std::min(least, (seen[i] - seen[k]).norm());
    }
  }
  return least;
}

// The colours "#rrggbb" of the style sheet of one scheme.
std::vector<std::string> colours_in(const std::string& style) {
  std::vector<std::string> colours;
  for (auto at = style.find('#'); at != std::string::npos; at = style.find('#', at + 1))
    colours.push_back(style.substr(at, 7));
  return colours;
}

TEST(VehicleStyle, ColoursDifferForEveryKindOfEyesAndStandOutFromThePaper) {
  for (const auto& [on_dark, paper] : {std::pair(false, "#fbfaf6"), std::pair(true, "#0d1316")}) {
    std::vector<Vector3d> colours;
    for (const std::string& colour : colours_in(vehicle_style(on_dark))) {
      colours.push_back(linear(colour));
      EXPECT_GE(contrast(colours.back(), linear(paper)), 3) << colour;
    }
    EXPECT_EQ(colours.size(), 8u);
    EXPECT_GE(least_difference(colours), 0.1);
  }
  // The measure itself: red and green of one brightness are alike for some.
  EXPECT_LT(least_difference({linear("#c03030"), linear("#6f6f20")}), 0.1);
}

TEST(VehicleStyle, FromTheNinthVehicleOnTheLineIsDashed) {
  VehicleRecord first, ninth;
  ninth.index = 8;
  EXPECT_EQ(colour_of(first), colour_of(ninth));
  EXPECT_NE(classes_of(&first), classes_of(&ninth));
  EXPECT_EQ(classes_of(nullptr), "");
}

}  // namespace
}  // namespace halocline::clients

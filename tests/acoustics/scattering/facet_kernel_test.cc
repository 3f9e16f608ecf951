// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/scattering/facet_kernel.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

// Eight bins of ten degrees, s2 = 0.01, all scattered; values of the numpy oracle for the middle at 15
// degrees.
TEST(FacetKernel, AgreesWithTheOracleOfTenDegreeBins) {
  FacetBins bins;
  for (int i = 0; i < 8; ++i) {
    bins.angle_rad.push_back(to_radians(5 + 10.0 * i));
    bins.width_rad.push_back(to_radians(10));
    bins.scattered.push_back(1);
  }
  const FacetKernel kernel = facet_kernel(bins, 0.01);
  const double expected[] = {0.152882645063,  0.369990705315,   0.327427991298,    0.127955072022,
                             0.0205374032417, 0.00118509591701, 2.09890031119e-05, 9.81398313651e-08};
  for (std::size_t j = 0; j < 8; ++j) {
    const double share = kernel.part[8 + j] * bins.width_rad[j] / std::sin(bins.angle_rad[1]);
    EXPECT_NEAR(share / expected[j], 1, tolerance(1e-11)) << j;
  }
}

// Energy: whatever is scattered goes somewhere, also where little is, and however steep the facets are.
TEST(FacetKernel, RowsSumToWhatIsScatteredWhateverTheSlopes) {
  for (const double s2 : {0.001, 0.01, 0.04, 0.3}) {
    FacetBins bins;
    for (int i = 0; i < 48; ++i) {
      const double angle = 0.01 + 0.031 * i;
      bins.angle_rad.push_back(angle);
      bins.width_rad.push_back(0.031);
      bins.scattered.push_back(1 - std::exp(-100 * std::sin(angle) * std::sin(angle)));
    }
    const FacetKernel kernel = facet_kernel(bins, s2);
    for (std::size_t i = 0; i < 48; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < 48; ++j)
        sum += kernel.part[i * 48 + j] * bins.width_rad[j] / std::sin(bins.angle_rad[i]);
      EXPECT_NEAR(sum, bins.scattered[i], tolerance(1e-12)) << s2 << " " << i;
    }
  }
}

}  // namespace
}  // namespace halocline::acoustics

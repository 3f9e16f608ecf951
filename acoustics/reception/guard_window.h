// SPDX-License-Identifier: BSD-3-Clause
// Where a receiver synchronises: the guard interval that holds the greatest power, as a matched filter finds
// it.
//
// Model: the window begins at one of the paths and lasts the guard time. A path d after its begin has the
// weight
//   w = 1 (0 <= d <= guard), (1 + cos(pi (d - guard) / taper)) / 2 (guard < d < guard + taper), 0 otherwise
// on its pressure; the window is the one of greatest sum w^2 P, the earliest among equals. What it leaves out
// of a path, 1 - w^2 of the power, interferes with the packet's later symbols. In frequency-hopped FSK it
// falls on other tones: it takes nothing until the hop pattern returns (the clearing time), and 1/N of its
// power from then on, N tone pairs; the change takes one more chip, by a raised cosine.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/fading/sound_path.h"
#include "acoustics/modem/modem.h"

namespace halocline::acoustics {

// Of a path in a window.
struct WindowShare {
  double weight = 0;        // of its pressure in the signal, 0..1
  double interference = 0;  // share of its power that interferes, 0..1
};

struct GuardWindow {
  std::size_t first = 0;            // path at which it begins
  std::size_t strongest = 0;        // of the paths in it, by weighted power
  std::vector<WindowShare> shares;  // of each path
};

// Mean powers of paths, uPa^2, within 1e-9.
std::vector<double> mean_powers(const std::vector<SoundPath>& paths);

// Those of no effect left out, more than 60 dB below the strongest: `paths`, not empty, or what is `heard` of
// them.
const std::vector<SoundPath>& without_faint(const std::vector<SoundPath>& paths,
                                            std::vector<SoundPath>& heard);

// `paths` by delay, not empty.
GuardWindow best_window(const std::vector<SoundPath>& paths, const Modem& modem);

// Windows that hold nearly the same power, for predictions: as paths fade, now the one and now the other is
// the stronger. With the best there is at most one, the best without its strongest path: of a power lower by
// d < 1 dB it is chosen with the probability (1 - d / 1 dB)^2 / 2 (our choice), so that no small change of
// the power exchanges one for the other.
struct LikelyWindow {
  GuardWindow window;
  double probability = 1;
};

// The best first. `paths` as above.
std::vector<LikelyWindow> likely_windows(const std::vector<SoundPath>& paths, const Modem& modem);

// Sum over the window of w^2 P of mean powers, uPa^2.
double mean_signal(const std::vector<SoundPath>& paths, const GuardWindow& window);
// Sum of what interferes, uPa^2.
double mean_interference(const std::vector<SoundPath>& paths, const GuardWindow& window);

}  // namespace halocline::acoustics

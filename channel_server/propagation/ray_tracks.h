// SPDX-License-Identifier: BSD-3-Clause
// Builds the tracks of a link from the paths that a search over its seabed found.
#pragma once

#include <vector>

#include "acoustics/fading/sound_path.h"
#include "acoustics/modem/modem.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/traced_ray.h"
#include "channel_server/propagation/link_tracks.h"
#include "core/units.h"

namespace halocline::channel_server {

// Path as a search found it, and as the receiver gets it.
struct FoundPath {
  acoustics::Eigenray arrival;
  acoustics::SoundPath path;
  Decibels kept_at_surface;  // see received_path.h
};

// Returns the tracks without guard weights. `found` is by rising delay over the link `searched`; `reversed`:
// it was searched from the receiver to the transmitter.
LinkTracks tracks_of(const acoustics::ProfiledSea& sea, const acoustics::RayLink& searched, bool reversed,
                     std::vector<FoundPath> found, const acoustics::Modem& transmitter,
                     const acoustics::Modem& receiver);

}  // namespace halocline::channel_server

// Finds out by depths how the seabed runs under one link, and makes of it the bottom that rays meet.
//
// Rule. Each end is snapped to the nearest point of a horizontal lattice (points `reuse_distance_m` apart, one in
// the world's origin); the seabed is sampled evenly between the two snapped ends, no further apart than
// `spacing_m`, by 16 to 256 samples (so beyond 6.4 km by default they lie further apart). A profile is therefore
// a function of the two lattice cells and the terrain, and serves all that are in them, whatever was queried before.
// For a link it is stretched to the true range: its samples are off by no more than 0.71 lattice spacings, as is
// the bottom under the link. Where an end of the link lies below the profile at that end, the profile is lowered
// there to just below it; nowhere else is it changed. Land counts as 0.1 m of water.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/bottom_profile.h"
#include "channel_server/propagation/terrain_rays.h"
#include "core/frames.h"

namespace halocline::channel_server {

struct ProfileRule {
  double reuse_distance_m = 10;  // between points of the lattice, 0.1..1000
  double spacing_m = 25;         // between samples at most, 1..1000
  static constexpr int kMinSamples = 16, kMaxSamples = 256;
};

struct LatticeCell {
  std::int64_t north = 0, east = 0;
  auto operator<=>(const LatticeCell&) const = default;
};
LatticeCell cell_of(const Vec3& position_ned_m, const ProfileRule& rule);

// Of a link, from one end to the other.
struct CellPair {
  LatticeCell from, to;
  CellPair reversed() const { return {to, from}; }
  auto operator<=>(const CellPair&) const = default;
};
CellPair cells_of(const Vec3& from_ned_m, const Vec3& to_ned_m, const ProfileRule& rule);

// z of the seabed, m, evenly from one end of a link to the other; at least two samples.
using SeabedProfile = std::vector<double>;

class ProfileSurvey {
 public:
  ProfileSurvey() = default;
  ProfileSurvey(const CellPair& cells, const ProfileRule& rule);

  // As EchoSurvey's: there is one question.
  std::optional<RayKind> next_query() const;
  std::vector<TerrainRay> rays() const;
  void take(std::span<const RayAnswer> answers);

  const CellPair& cells() const { return cells_; }
  // Null until answered, and when one sample has no answer (outside, no data).
  const std::shared_ptr<const SeabedProfile>& profile() const { return profile_; }

 private:
  CellPair cells_;
  std::vector<Vec3> places_;
  bool taken_ = false;
  std::shared_ptr<const SeabedProfile> profile_;
};

// The bottom along a link whose ends are those of `seabed` in its order.
acoustics::BottomProfile bottom_under(const SeabedProfile& seabed, const acoustics::RayLink& link,
                                      double sea_surface_z_m);

// Whether the bottom reaches up to the straight line between the ends of the link.
bool cuts_straight_line(const acoustics::BottomProfile& bottom, const acoustics::RayLink& link);

}  // namespace halocline::channel_server

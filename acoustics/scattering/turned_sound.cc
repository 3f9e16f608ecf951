// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/scattering/turned_sound.h"

#include <algorithm>
#include <cmath>

#include "acoustics/math/fast_functions.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

// Parts of the first and the second stretch between whose ends receptions are tabulated.
constexpr std::size_t kFirstParts = 4, kSecondParts = 2;

// Reception over distance d from a first bounce: ln F, mean and variance of the delay, by state.
struct Received {
  std::vector<double> power, mean_s, variance_s2;
};

// Adds the sound of one cell of first bounces. `share` of the cell bounces before the receiver.
void add_cell(const FirstBounces& cell, double share, const Received& at, double range_m, TurnedSound& sound,
              std::vector<double>& second) {
  for (std::size_t j = 0; j < sound.parts.size(); ++j) {
    const double power = share * cell.bounced[j] * at.power[j] / range_m;
    const double mean = cell.excess_s + at.mean_s[j];
    TurnedPart& part = sound.parts[j];
    part.power += power;
    part.excess_s += power * mean;
    second[j] += power * (at.variance_s2[j] + mean * mean);
    part.sine_squares += power * cell.sine_squares;
  }
}

// Share of a cell within the range, and the mean distance of that share's first bounces.
struct Reached {
  double share, distance_m;
};
Reached reached(const FirstBounces& cell, double range_m) {
  if (!(cell.power > 0) || cell.begin_m >= range_m) return {0, 0};
  if (cell.end_m <= range_m) return {1, cell.distance_m};
  const double share = (range_m - cell.begin_m) / (cell.end_m - cell.begin_m);
  return {share, std::min(cell.distance_m, 0.5 * (cell.begin_m + range_m))};
}

// Turns sums weighted by power into means.
void finish(TurnedSound& sound, const std::vector<double>& second) {
  for (std::size_t j = 0; j < sound.parts.size(); ++j) {
    TurnedPart& part = sound.parts[j];
    if (!(part.power > 0)) continue;
    sound.power += part.power;
    part.excess_s /= part.power;
    part.sine_squares /= part.power;
    part.variance_s2 = std::max(second[j] / part.power - part.excess_s * part.excess_s, 0.0);
  }
}

void set_received(const ReceptionTable& table, double distance_m, Received& at) {
  const auto [node, share] = table.place_of(distance_m);
  const std::size_t n = table.size;
  const auto between = [&](const std::vector<double>& values, std::size_t j) {
    const double low = values[node * n + j], high = values[(node + 1) * n + j];
    return low + share * (high - low);
  };
  for (std::size_t j = 0; j < n; ++j) at.power[j] = fast_exp(between(table.log_power, j));
  for (std::size_t j = 0; j < n; ++j) {
    at.mean_s[j] = between(table.mean_s, j);
    at.variance_s2[j] = std::max(between(table.variance_s2, j), 0.0);
  }
}

// Launched power by state of the rays that bounce first beyond the range.
std::vector<double> waiting_power(const TransportEnd& source, double range_m) {
  std::vector<double> waiting(source.never_bouncing().size());
  for (const FirstBounces& cell : source.first_bounces()) {
    const double share = 1 - reached(cell, range_m).share;
    if (!(share > 0 && cell.power > 0)) continue;
    for (std::size_t j = 0; j < waiting.size(); ++j) waiting[j] += share * cell.launched[j];
  }
  return waiting;
}

// Power of the rays that have met no boundary yet: those of cells beyond the range, and those that never do.
double unbounced_power(const AngleTransport& transport, const TransportEnd& source,
                       const TransportEnd& receiver, double range_m) {
  double sum = 0;
  const std::vector<double>& reception = receiver.reception();
  const std::vector<double> waiting = waiting_power(source, range_m);
  for (std::size_t j = 0; j < transport.size(); ++j) {
    if (waiting[j] > 0)
      sum += waiting[j] * reception[j] * elementary::exp(-transport.states()[j].nepers_per_m * range_m);
    if (!(source.never_bouncing()[j] > 0)) continue;
    // F at y = r: at d = r + D / 4 of the table, less the absorption of that quarter
    const double quarter_m = transport.states()[j].cycle_m / 4;
    const auto [node, share] = receiver.table().place_of(range_m + quarter_m);
    const std::size_t n = transport.size();
    const double low = receiver.table().log_power[node * n + j];
    const double high = receiver.table().log_power[(node + 1) * n + j];
    sum += source.never_bouncing()[j] *
           elementary::exp(low + share * (high - low) + transport.states()[j].nepers_per_m * quarter_m);
  }
  return sum / range_m;
}

// Share by which each bin of one water goes into the bins of another, by action: bins are adjacent intervals
// of action in both.
std::vector<double> into_bins(const std::vector<double>& values, const AngleTransport& here,
                              const AngleTransport& there) {
  const std::vector<double>&from = here.actions(), &to = there.actions();
  std::vector<double> result(from.size() - 1);
  std::size_t start = 0;  // first bin of `to` that may overlap
  for (std::size_t i = 0; i + 1 < from.size(); ++i) {
    const double width = from[i + 1] - from[i];
    while (start + 2 < to.size() && to[start + 1] <= from[i]) ++start;
    for (std::size_t j = start; j + 1 < to.size() && to[j] < from[i + 1] && width > 0; ++j) {
      const double overlap = std::min(from[i + 1], to[j + 1]) - std::max(from[i], to[j]);
      if (overlap > 0) result[i] += overlap / width * values[j];
    }
  }
  return result;
}

// What a state of the stretch `here` brings that goes on into the stretch `there`.
std::vector<double> across_step(const std::vector<double>& by_state, const AngleTransport& here,
                                const AngleTransport& there) {
  const double there_m = there.depth_m() / 2;
  std::vector<double> bins(there.actions().size() - 1);
  for (std::size_t j = 0; j < bins.size(); ++j) bins[j] = by_state[there.state_at(j, there_m)];
  bins = into_bins(bins, here, there);
  std::vector<double> result(here.size());
  for (std::size_t i = 0; i < here.size(); ++i) result[i] = bins[here.states()[i].bin];
  return result;
}

// The same from the last stretch to the first.
std::vector<double> across_steps(std::vector<double> by_state, const std::vector<Stretch>& stretches) {
  for (std::size_t i = stretches.size(); i-- > 1;)
    by_state = across_step(by_state, *stretches[i - 1].transport, *stretches[i].transport);
  return by_state;
}

// Moments of what the receiver gets, by state of stretch `begin`, at its end; the slowest decays of the
// stretches that follow are left to `nepers`.
CarriedMoments moments_beyond(const std::vector<Stretch>& stretches, std::size_t begin,
                              const CarriedMoments& received, double& nepers) {
  CarriedMoments moments = received;
  for (std::size_t i = stretches.size(); i-- > begin + 1;) {
    const AngleTransport& here = *stretches[i].transport;
    moments = by_state(here, carried(here, in_eigenvectors(here, moments), stretches[i].length_m));
    nepers -= here.slowest() * stretches[i].length_m;
    const AngleTransport& before = *stretches[i - 1].transport;
    moments = {across_step(moments.power, before, here), across_step(moments.first, before, here),
               across_step(moments.second, before, here)};
  }
  return moments;
}

Received received_from(const AngleTransport& transport, const CarriedMoments& in_eigenvectors,
                       double nepers) {
  const CarriedMoments here = by_state(transport, in_eigenvectors);
  const std::size_t n = transport.size();
  Received at{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  const double scale = elementary::exp(-nepers);
  for (std::size_t j = 0; j < n; ++j) {
    if (!(here.power[j] > 1e-290)) continue;
    at.power[j] = here.power[j] * scale;
    at.mean_s[j] = std::max(here.first[j] / here.power[j], 0.0);
    at.variance_s2[j] = std::max(here.second[j] / here.power[j] - at.mean_s[j] * at.mean_s[j], 0.0);
  }
  return at;
}

// What is received from a distance before the end of the first stretch; below 0: from within the second.
struct PlacedReception {
  double left_m;
  Received received;
};

// Receptions over the first stretch and the second, by rising distance.
std::vector<PlacedReception> placed_receptions(const std::vector<Stretch>& stretches,
                                               const CarriedMoments& received) {
  const AngleTransport &first = *stretches[0].transport, &second = *stretches[1].transport;
  double nepers = 0;
  const CarriedMoments beyond_second =
      in_eigenvectors(second, moments_beyond(stretches, 1, received, nepers));
  std::vector<PlacedReception> table;
  CarriedMoments moments;
  double decay = 0;
  for (std::size_t part = 0; part <= kSecondParts; ++part) {
    const double share = static_cast<double>(part) / kSecondParts, length_m = stretches[1].length_m;
    const CarriedMoments here =
        by_state(second, part == 0 ? beyond_second : carried(second, beyond_second, share * length_m));
    decay = nepers - second.slowest() * share * length_m;
    moments = in_eigenvectors(first,
                              {across_step(here.power, first, second), across_step(here.first, first, second),
                               across_step(here.second, first, second)});
    table.push_back({-(1 - share) * length_m, received_from(first, moments, decay)});
  }
  const double step_m = stretches[0].length_m / kFirstParts;
  for (std::size_t part = 1; part <= kFirstParts; ++part) {
    moments = carried(first, moments, step_m);
    decay -= first.slowest() * step_m;
    table.push_back({step_m * static_cast<double>(part), received_from(first, moments, decay)});
  }
  return table;
}

// What a first bounce brings whose rays have `left_m` to run in the first stretch. The first quarter of a
// cycle of each state is without loss but absorption.
Received received_within(const AngleTransport& first, const std::vector<PlacedReception>& table,
                         double left_m) {
  const std::size_t n = first.size();
  Received at{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  for (std::size_t j = 0; j < n; ++j) {
    const TransportState& state = first.states()[j];
    const double place_m = std::max(left_m - state.cycle_m / 4, table.front().left_m);
    std::size_t node = 0;
    while (node + 2 < table.size() && table[node + 1].left_m <= place_m) ++node;
    const double share = (place_m - table[node].left_m) / (table[node + 1].left_m - table[node].left_m);
    const Received &low = table[node].received, &high = table[node + 1].received;
    double power = (1 - share) * low.power[j] + share * high.power[j];
    if (low.power[j] > 0 && high.power[j] > 0)
      power = low.power[j] * fast_exp(share * fast_log(high.power[j] / low.power[j]));
    const double straight_m = left_m - place_m;
    at.power[j] = power * fast_exp(-state.nepers_per_m * straight_m);
    at.mean_s[j] = low.mean_s[j] + share * (high.mean_s[j] - low.mean_s[j]) + state.excess_spm * straight_m;
    at.variance_s2[j] = low.variance_s2[j] + share * (high.variance_s2[j] - low.variance_s2[j]);
  }
  return at;
}

}  // namespace

TurnedSound turned_sound(const AngleTransport& transport, const TransportEnd& source,
                         const TransportEnd& receiver, double range_m) {
  TurnedSound sound;
  sound.reference_s = transport.reference_spm() * range_m;
  sound.parts.resize(transport.size());
  const std::size_t n = transport.size();
  std::vector<double> second(n);
  Received at{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  for (const FirstBounces& cell : source.first_bounces()) {
    const Reached before = reached(cell, range_m);
    if (!(before.share > 0)) continue;
    set_received(receiver.table(), range_m - before.distance_m, at);
    add_cell(cell, before.share, at, range_m, sound, second);
  }
  finish(sound, second);
  sound.unbounced = unbounced_power(transport, source, receiver, range_m);
  return sound;
}

TurnedSound turned_sound(const std::vector<Stretch>& stretches, const TransportEnd& source,
                         const TransportEnd& receiver) {
  const AngleTransport& first = *stretches.front().transport;
  double range_m = 0;
  for (const Stretch& stretch : stretches) range_m += stretch.length_m;
  const std::vector<double> none(stretches.back().transport->size());
  const std::vector<PlacedReception> table = placed_receptions(stretches, {receiver.reception(), none, none});
  TurnedSound sound;
  for (const Stretch& stretch : stretches)
    sound.reference_s += stretch.transport->reference_spm() * stretch.length_m;
  sound.parts.resize(first.size());
  std::vector<double> second(first.size());
  for (const FirstBounces& cell : source.first_bounces()) {
    const Reached before = reached(cell, range_m);
    if (!(before.share > 0)) continue;
    const double left_m = std::max(stretches.front().length_m - before.distance_m, 0.0);
    add_cell(cell, before.share, received_within(first, table, left_m), range_m, sound, second);
  }
  finish(sound, second);
  // Rays without a bounce keep to the receiver's depth as those of the last stretch do.
  const std::vector<double> arrives = across_steps(receiver.reception(), stretches);
  const std::vector<double> waiting = waiting_power(source, range_m);
  for (std::size_t j = 0; j < first.size(); ++j) {
    const double launched = waiting[j] + source.never_bouncing()[j];
    if (launched > 0)
      sound.unbounced +=
          launched * arrives[j] / range_m * elementary::exp(-first.states()[j].nepers_per_m * range_m);
  }
  return sound;
}

}  // namespace halocline::acoustics

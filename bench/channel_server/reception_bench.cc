// SPDX-License-Identifier: BSD-3-Clause
// What a packet's judgement and a link's prediction cost with paths that fade.
#include <cstdint>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/modem/modem.h"
#include "acoustics/modem/packet_format.h"
#include "acoustics/prediction/link_prediction.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/reception/reception_curves.h"
#include "acoustics/reception/signal_history.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/packets/packet.h"
#include "channel_server/packets/reception_decision.h"
#include "core/sim_time.h"

namespace halocline::channel_server {
namespace {

using acoustics::Arrival;

constexpr acoustics::FadingModel kSea{.enabled = true};
constexpr double kNoise = 1e7;

// Paths as a shallow sea has them: 0.7 ms apart, each 1 dB weaker, steeper and rougher.
std::vector<Arrival> paths_of(std::int64_t count, double frequency_hz) {
  std::vector<Arrival> paths;
  for (std::int64_t i = 0; i < count; ++i) {
    const double n = static_cast<double>(i);
    Arrival path{{.delay_s = 0.7 + 0.0007 * n, .launch_angle_rad = 0.02 * n}, {100 - n}};
    path.identity = acoustics::PathIdentity::of_number(static_cast<std::uint64_t>(i));
    path.fading = path_fading(kSea, 5, frequency_hz, 0.0004 * n * n, 0.0002 * n * n);
    paths.push_back(path);
  }
  return paths;
}

void judgement(benchmark::State& state, const char* profile) {
  const acoustics::Modem modem = load_modem(profile).modem;
  const auto paths = paths_of(state.range(0), modem.centre_frequency_hz);
  Packet packet;
  packet.modem = modem;
  packet.format = data_format(modem, 32);
  packet.timing = packet_timing(modem, packet.format);
  const auto shared = std::make_shared<const Packet>(packet);
  const SimTime begin = SimTime::from_seconds(100);
  const acoustics::FadingLink link{.seed = 1, .lower_id = 1, .higher_id = 2};
  for (auto _ : state) {
    const acoustics::Synchronisation sync{&modem, best_window(paths, modem)};
    const double large_scale = acoustics::LinkFading(kSea, link).large_scale(begin);
    ReceivedSignal signal{
        shared, kNoise, begin, begin + packet.timing.preamble, begin + packet.timing.duration, true, {}, {}};
    signal.history = signal_history(kSea, link, large_scale, paths, sync, modem.band(), begin,
                                    {packet.timing.preamble.seconds(), packet.timing.duration.seconds()});
    benchmark::DoNotOptimize(acquisition_probability(signal, {}) * success_probability(signal, {}));
  }
}
BENCHMARK_CAPTURE(judgement, fsk, "micromodem-fsk")->Arg(1)->Arg(5)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(judgement, psk, "micromodem-psk-1")->Arg(1)->Arg(5)->Arg(30)->Unit(benchmark::kMicrosecond);

void prediction(benchmark::State& state, const char* profile) {
  const acoustics::Modem modem = load_modem(profile).modem;
  const auto paths = paths_of(state.range(0), modem.centre_frequency_hz);
  const acoustics::ReceptionCurves curves(modem, 32);
  for (auto _ : state) {
    const acoustics::Synchronisation sync{&modem, best_window(paths, modem)};
    benchmark::DoNotOptimize(predict_link(kSea, paths, sync, modem.band(), kNoise, curves));
  }
}
BENCHMARK_CAPTURE(prediction, fsk, "micromodem-fsk")->Arg(1)->Arg(5)->Arg(30)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(prediction, psk, "micromodem-psk-1")
    ->Arg(1)
    ->Arg(5)
    ->Arg(30)
    ->Unit(benchmark::kMicrosecond);

// The same with noise that half of the packets survive: nothing is certain.
void prediction_at_half(benchmark::State& state, const char* profile) {
  const acoustics::Modem modem = load_modem(profile).modem;
  const auto paths = paths_of(state.range(0), modem.centre_frequency_hz);
  const acoustics::ReceptionCurves curves(modem, 32);
  const acoustics::Synchronisation sync{&modem, best_window(paths, modem)};
  const auto delivery = [&](double noise) {
    return predict_link(kSea, paths, sync, modem.band(), noise, curves).delivery_probability;
  };
  double noise = 1e15;
  while (noise > 1 && delivery(noise) < 0.5) noise /= 1.1;
  for (auto _ : state) {
    const acoustics::Synchronisation again{&modem, best_window(paths, modem)};
    benchmark::DoNotOptimize(predict_link(kSea, paths, again, modem.band(), noise, curves));
  }
  state.counters["delivery"] = delivery(noise);
}
BENCHMARK_CAPTURE(prediction_at_half, psk, "micromodem-psk-1")
    ->Arg(1)
    ->Arg(5)
    ->Arg(30)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(prediction_at_half, fsk, "micromodem-fsk")->Arg(5)->Unit(benchmark::kMicrosecond);

void mean_level(benchmark::State& state) {
  const auto paths = paths_of(state.range(0), 25'000);
  for (auto _ : state) benchmark::DoNotOptimize(mean_power(kSea, paths, {22'500, 27'500}));
}
BENCHMARK(mean_level)->Arg(1)->Arg(5)->Arg(30)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace halocline::channel_server

// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/ostream.h>

#include "bus/logs/log_reader.h"
#include "bus/transport/event_log.h"
#include "channel_server/channel_server_config.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/elementary.h"
#include "core/sim_time.h"
#include "core/units.h"
#include "halocline/commands.h"
#include "runs/analysis/recording.h"
#include "runs/analysis/run_files.h"
#include "simulation/composition.h"
#include "simulation/vehicle_track.h"
#include "simulation/waveform/received_waveform.h"
#include "simulation/waveform/wav_file.h"

namespace halocline::clients {
namespace {

struct WaveformOptions {
  std::string input, scenario, from, to, output, log;
  std::vector<std::string> also, overrides;
  double at_s = 0, tail_s = 0.5, sensitivity_db = -190;
  std::optional<double> source_level_db;
  bool quiet_sea = false, force = false;
};

struct Transmission {
  std::string vehicle, file;
  double at_s = 0;
};

// Parses "VEHICLE=FILE" or "VEHICLE=FILE@SECONDS".
Transmission transmission_of(const std::string& text, double at_s) {
  const auto equals = text.find('='), at = text.rfind('@');
  require(equals != std::string::npos && equals > 0,
          "--also is '" + text + "'; allowed is VEHICLE=FILE or VEHICLE=FILE@SECONDS");
  const std::string vehicle = text.substr(0, equals);
  if (at != std::string::npos && at > equals) {
    if (const auto seconds = parse_number(text.substr(at + 1)))
      return {vehicle, text.substr(equals + 1, at - equals - 1), *seconds};
  }
  return {vehicle, text.substr(equals + 1), at_s};
}

std::vector<Transmission> transmissions_of(const WaveformOptions& options) {
  std::vector<Transmission> all{{options.from, options.input, options.at_s}};
  for (const std::string& text : options.also) all.push_back(transmission_of(text, options.at_s));
  return all;
}

std::vector<SentWaveform> sent_by(const std::vector<Transmission>& transmissions,
                                  const WaveformOptions& options, const ScenarioConfig& config) {
  const auto modems = make_modems(config.channel_server);
  std::vector<SentWaveform> sent;
  for (const auto& [vehicle, file, at_s] : transmissions) {
    require(config.scenario.find(vehicle) != nullptr, "'" + vehicle + "' is no vehicle of the scenario");
    require(at_s >= 0, "waveforms leave from time 0 on");
    const Decibels level = modems.of(vehicle).modem.source_level;
    sent.push_back({vehicle, read_sound(file), Decibels{options.source_level_db.value_or(level.value)}});
    sent.back().sound.begin_s = at_s;
  }
  return sent;
}

int convolve(const WaveformOptions& options) {
  bus::set_log_level(bus::LogLevel::kWarning);
  const std::vector<Transmission> transmissions = transmissions_of(options);
  std::vector<std::string> inputs{options.scenario, options.log};
  for (const Transmission& each : transmissions) inputs.push_back(each.file);
  require_free({{options.output}, options.force}, inputs);
  const ScenarioConfig config = load_scenario(options.scenario, options.overrides);
  const std::vector<SentWaveform> sent = sent_by(transmissions, options, config);
  const auto terrain = make_terrain(config);
  double end_s = 0;
  for (const SentWaveform& wave : sent)
    end_s = std::max(end_s,
                     wave.sound.begin_s + static_cast<double>(wave.sound.values.size()) / wave.sound.rate_hz);
  Recording run;
  bool is_whole = true;
  if (options.log.empty()) {
    // The recording ends 5 s after the last departure; vehicles are extrapolated along straight lines beyond
    // it.
    run = record_run(config, terrain, SimTime::from_seconds(end_s + 5));
  } else {
    LogReader log(options.log);
    run = read_recording(log, config.scenario, Played::kWithEquipment);
    is_whole = report_damage(std::cerr, log);
  }
  const acoustics::Samples received = received_waveform(config, terrain, run, sent,
                                                        {.receiver = options.to,
                                                         .begin_s = options.at_s,
                                                         .tail_s = options.tail_s,
                                                         .sensitivity = Decibels{options.sensitivity_db},
                                                         .has_noise = !options.quiet_sea});
  write_wav(options.output, received);
  double peak = 0, squares = 0;
  for (const double value : received.values) {
    peak = std::max(peak, std::abs(value));
    squares += value * value;
  }
  const double rms = std::sqrt(squares / static_cast<double>(received.values.size()));
  const auto level_db = [&](double value) {
    return 20 * elementary::log10(std::max(value, 1e-30)) - options.sensitivity_db;
  };
  fmt::print(std::cout,
             "{}: {} samples of {:g} Hz from {:g} s on\nrms {:.1f} dB re 1 uPa, peak {:.1f} dB, {:.3g} of "
             "full scale\n",
             options.output, received.values.size(), received.rate_hz, received.begin_s, level_db(rms),
             level_db(peak), peak);
  return is_whole ? kDone : kFailed;
}

}  // namespace

void add_waveform_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<WaveformOptions>();
  CLI::App* command = app.add_subcommand(
      "waveform", "What a vehicle's hydrophone records of a sound file that another transmits");
  command
      ->add_option("input", options->input,
                   "sound file of one channel that --from transmits (WAV, FLAC, ...)")
      ->required();
  command->add_option("--scenario", options->scenario, "scenario file (TOML): water, terrain, vehicles, seed")
      ->required();
  command->add_option("--from", options->from, "vehicle that transmits")->required();
  command->add_option("--to", options->to, "vehicle that receives")->required();
  command->add_option("--out", options->output, "WAV file of 32-bit floating-point samples")->required();
  command
      ->add_option("--at", options->at_s,
                   "simulation time at which the first sample leaves, and the recording begins, s")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--also", options->also,
                   "another transmission: VEHICLE=FILE or VEHICLE=FILE@SECONDS (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--tail", options->tail_s, "recorded after the last sound has arrived, s; default 0.5")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--source-level-db", options->source_level_db,
                      "of a sine of amplitude 1, dB re 1 uPa at 1 m; default: the modem's");
  command->add_option("--sensitivity-db", options->sensitivity_db,
                      "of the receiver, dB re 1/uPa: samples for a pressure; default -190");
  command->add_flag("--quiet-sea", options->quiet_sea, "no ambient noise");
  command->add_option("--log", options->log,
                      "takes the vehicles' ways from this log instead of running the scenario");
  command->add_option("--set", options->overrides, "change a key: section.key=value (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  add_force_option(*command, options->force);
  command->footer(
      footer("  halocline waveform ping.wav --scenario scenarios/harbour.toml --from scout-1 --to quay --at "
             "30 --out heard.wav"));
  command->callback([options, &exit_code] { exit_code = convolve(*options); });
}

}  // namespace halocline::clients

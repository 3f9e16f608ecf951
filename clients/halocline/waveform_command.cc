#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/ostream.h>

#include "bus/event_log.h"
#include "bus/logs/log_reader.h"
#include "channel_server/channel_server_config.h"
#include "clients/halocline/analysis/recording.h"
#include "clients/halocline/analysis/run_files.h"
#include "clients/halocline/commands.h"
#include "clients/halocline/scenario/composition.h"
#include "clients/halocline/waveform/received_waveform.h"
#include "clients/halocline/waveform/wav_file.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/elementary.h"
#include "core/sim_time.h"
#include "core/units.h"

namespace halocline::clients {
namespace {

struct WaveformOptions {
  std::string input, scenario, from, to, output, log;
  std::vector<std::string> also, overrides;
  double at_s = 0, tail_s = 0.5, sensitivity_db = -190;
  std::optional<double> source_level_db;
  bool quiet_sea = false, force = false;
};

// "VEHICLE=FILE" or "VEHICLE=FILE@SECONDS".
SentWaveform also_sent(const std::string& text, double at_s) {
  const auto equals = text.find('='), at = text.rfind('@');
  require(equals != std::string::npos && equals > 0,
          "--also is '" + text + "'; allowed is VEHICLE=FILE or VEHICLE=FILE@SECONDS");
  SentWaveform sent{text.substr(0, equals), {}, {}};
  std::string file = text.substr(equals + 1);
  if (at != std::string::npos && at > equals) {
    if (const auto seconds = parse_number(text.substr(at + 1))) {
      file = text.substr(equals + 1, at - equals - 1);
      at_s = *seconds;
    }
  }
  sent.sound = read_sound(file);
  sent.sound.begin_s = at_s;
  return sent;
}

std::vector<SentWaveform> sent_by(const WaveformOptions& options, const ScenarioConfig& config) {
  std::vector<SentWaveform> sent{{options.from, read_sound(options.input), {}}};
  sent.front().sound.begin_s = options.at_s;
  for (const std::string& text : options.also) sent.push_back(also_sent(text, options.at_s));
  const auto modems = make_modems(config.channel_server);
  for (SentWaveform& wave : sent) {
    require(config.scenario.find(wave.vehicle) != nullptr,
            "'" + wave.vehicle + "' is no vehicle of the scenario");
    require(wave.sound.begin_s >= 0, "waveforms leave from time 0 on");
    wave.source_level = modems.of(wave.vehicle).modem.source_level;
    if (options.source_level_db) wave.source_level = Decibels{*options.source_level_db};
  }
  return sent;
}

int convolve(const WaveformOptions& options) {
  bus::set_log_level(bus::LogLevel::kWarning);
  std::vector<std::string> inputs{options.input, options.scenario, options.log};
  require_free({{options.output}, options.force}, inputs);
  const ScenarioConfig config = load_scenario(options.scenario, options.overrides);
  const std::vector<SentWaveform> sent = sent_by(options, config);
  double end_s = 0;
  for (const SentWaveform& wave : sent)
    end_s = std::max(end_s,
                     wave.sound.begin_s + static_cast<double>(wave.sound.values.size()) / wave.sound.rate_hz);
  Recording run;
  if (options.log.empty()) {
    // Beyond what sound takes, vehicles go straight on.
    run = record_run(config, SimTime::from_seconds(end_s + 5));
  } else {
    LogReader log(options.log);
    run = read_recording(log, config.scenario);
  }
  const acoustics::Samples received = received_waveform(config, run, sent,
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
  return kDone;
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

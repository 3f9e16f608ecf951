// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/ostream.h>

#include "acoustics/link/link_budget.h"
#include "acoustics/modem/modem.h"
#include "acoustics/reception/disturbing_powers.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/links/link_table.h"
#include "core/check.h"
#include "core/frames.h"
#include "halocline/commands.h"
#include "runs/analysis/run_files.h"
#include "simulation/arrivals/arrival_output.h"
#include "simulation/arrivals/arrival_plot.h"
#include "simulation/composition.h"
#include "simulation/ensemble/ensemble_output.h"
#include "simulation/ensemble/link_ensemble.h"
#include "simulation/link_output.h"
#include "simulation/link_survey.h"

namespace halocline::clients {
namespace {

struct LinkOptions {
  std::string scenario, from, to;
  std::vector<std::string> overrides;
  std::optional<double> source_level_db, cutoff_level_db, center_frequency_hz, bandwidth_hz;
  std::string from_velocity, to_velocity, format = "table", plot;
  double impulse_rate_hz = 0;
  std::size_t members = kStandardMembers;
  bool json = false, arrivals = false, force = false;
};

void apply(const LinkOptions& options, acoustics::Modem& modem) {
  if (options.source_level_db) modem.source_level = {*options.source_level_db};
  if (options.cutoff_level_db) modem.min_receivable_level = {*options.cutoff_level_db};
  if (options.center_frequency_hz) modem.centre_frequency_hz = *options.center_frequency_hz;
  if (options.bandwidth_hz) modem.bandwidth_hz = *options.bandwidth_hz;
}

void print_table(const LinkSurveyEnd& from, const LinkSurveyEnd& to, const LinkSurvey& answer) {
  const acoustics::LinkBudget& b = answer.reception.budget;
  const auto line = [](const char* what, double value, int digits, const char* unit) {
    fmt::print(std::cout, "{:<22}{:>14.{}f} {}\n", what, value, digits, unit);
  };
  const auto place = [](const LinkSurveyEnd& end) {
    const Vec3& p = end.position_ned_m;
    return fmt::format("{} ({:g}, {:g}, {:g})", end.name, p.x(), p.y(), p.z());
  };
  fmt::print(std::cout, "from {} to {}, NED m\n", place(from), place(to));
  line("range", b.range_m, 3, "m");
  line("delay", b.delay_s, 6, "s");
  line("mean sound speed", b.mean_sound_speed_mps, 3, "m/s");
  line("absorption", b.absorption_db_per_km, 4, "dB/km");
  line("transmission loss", b.transmission_loss.value, 3, "dB");
  line("received level", b.received_level.value, 3, "dB re 1 uPa");
  line("noise in the band", b.noise_level.value, 3, "dB re 1 uPa");
  if (!answer.noise_place.empty()) fmt::print(std::cout, "noise of the place    {}\n", answer.noise_place);
  line("SNR", b.snr.value, 3, "dB");
  line("capacity", b.capacity_bps, 1, "bit/s");
  fmt::print(std::cout,
             "receivable            {}\nbottom echo           {}\npaths                 {}, {}, {}\n",
             b.receivable ? "yes" : "no", name_of(answer.multipath),
             channel_server::number_of_paths(answer.reception.paths), name_of(answer.reception.state),
             name_of(answer.reception.used));
  if (answer.reception.diffuse_level > channel_server::kSilence)
    line("diffuse level", answer.reception.diffuse_level.value, 3, "dB re 1 uPa");
  line("delay spread", answer.reception.delay_spread_s, 6, "s");
  const channel_server::LinkForecast& f = answer.forecast;
  line("rms delay spread", f.rms_delay_spread_s, 6, "s");
  line("first path's delay", f.first_path_delay_s, 6, "s");
  line("coherence time", f.coherence_time_s, 3, "s");
  line("Doppler spread", f.doppler_spread_hz, 3, "Hz");
  line("SINR", f.sinr_db, 3, "dB");
  const auto beside = [&](const char* what, double power) {
    if (power > 0) line(what, channel_server::level_of(power).value, 1, "dB re signal");
  };
  beside("  noise", f.powers.noise);
  beside("  late echoes", f.powers.late_echoes);
  beside("  fast fading", f.powers.fast_fading);
  beside("  impulses", f.powers.impulses);
  line("acquisition", f.acquisition_probability, 4, "of preambles");
  line("delivery", f.delivery_probability, 4, "of packets");
  line("delivery, low", f.delivery_low, 4, "of packets, in one hour of ten");
  line("delivery, high", f.delivery_high, 4, "of packets, in nine hours of ten");
  if (f.reason != acoustics::LossReason::kNone)
    fmt::print(std::cout, "losses mostly to       {}\n", name_of(f.reason));
  line("best rate", f.best_rate_bps, 0, "bit/s");
}

void check(const LinkOptions& options) {
  require(
      options.arrivals || (options.plot.empty() && options.impulse_rate_hz == 0 && options.format != "csv"),
      "--plot, --impulse-response-rate-hz and --format csv go with --arrivals");
  require(options.impulse_rate_hz == 0 || (!options.json && options.format == "table"),
          "--impulse-response-rate-hz writes CSV of its own: not with --json or --format");
  if (!options.plot.empty()) require_plot_file(options.plot);
  require_free({{options.plot}, options.force}, {options.scenario});
}

void print_paths(const LinkOptions& options, const LinkSurveyEnd& from, const LinkArrivals& found) {
  if (!options.plot.empty())
    write_plot(arrival_plot({found}, options.from + " to " + options.to), options.plot);
  if (options.impulse_rate_hz > 0) {
    print_impulse_response(std::cout, found, from.modem.modem.centre_frequency_hz, options.impulse_rate_hz);
    if (found.eigenrays.silent()) std::cerr << why_silent(found) << "\n";
    return;
  }
  const bool json = options.json || options.format == "json";
  print_arrivals(std::cout, {found},
                 json                      ? OutputFormat::kJson
                 : options.format == "csv" ? OutputFormat::kCsv
                                           : OutputFormat::kTable);
}

int link(const LinkOptions& options) {
  check(options);
  const ScenarioConfig config = load_scenario(options.scenario, options.overrides, ScenarioUse::kWater);
  LinkSurveyEnd from = link_end(config, options.from), to = link_end(config, options.to);
  apply(options, from.modem.modem);
  apply(options, to.modem.modem);
  if (!options.from_velocity.empty())
    from.velocity_ned_mps = parse_vector(options.from_velocity, "--from-velocity");
  if (!options.to_velocity.empty()) to.velocity_ned_mps = parse_vector(options.to_velocity, "--to-velocity");
  const LinkSurvey answer = survey_link(config, from, to);
  for (const std::string& note : answer.notes) std::cerr << "note: " << note << "\n";
  if (options.arrivals) {
    print_paths(options, from, answer.arrivals);
    return kDone;
  }
  LinkBands bands;
  if (options.members > 0) bands = link_bands(config, from, to, options.members);
  if (options.json || options.format == "json") {
    std::cout << with_bands(to_json(from, to, answer), bands) << "\n";
  } else {
    print_table(from, to, answer);
    if (options.members > 0) std::cout << to_text(bands);
  }
  return kDone;
}

}  // namespace

void add_link_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<LinkOptions>();
  CLI::App* command = app.add_subcommand("link", "The budget of one link between two points of a scenario");
  command->add_option("scenario", options->scenario, "scenario file (TOML)")->required();
  const std::string end = "a vehicle of the scenario (where it starts), or NORTH,EAST,DOWN in metres";
  command->add_option("--from", options->from, end)->required();
  command->add_option("--to", options->to, end)->required();
  command->add_option("--source-level-db", options->source_level_db, "of the modems, dB re 1 uPa at 1 m");
  command->add_option("--cutoff-level-db", options->cutoff_level_db, "of the modems, dB re 1 uPa");
  command->add_option("--center-frequency-hz", options->center_frequency_hz, "of the modems, hertz");
  command->add_option("--bandwidth-hz", options->bandwidth_hz, "of the modems, hertz");
  command
      ->add_option("--ensemble", options->members,
                   "number of seas, drawn from [uncertainty], of which the band is told: 10, 50 and 90 % of "
                   "level, SNR and delivery; default 20, 0: none")
      ->check(CLI::Range(std::size_t{0}, kMostMembers));
  command->add_option("--set", options->overrides, "change a key: section.key=value (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command->add_flag("--json", options->json, "as JSON: short for --format json");
  command->add_flag("--arrivals", options->arrivals, "every path of sound instead of the budget");
  command->add_option("--format", options->format, "table, csv (with --arrivals) or json")
      ->check(CLI::IsMember({"table", "csv", "json"}));
  command->add_option("--from-velocity", options->from_velocity, "north,east,down in m/s, for Doppler");
  command->add_option("--to-velocity", options->to_velocity, "likewise");
  command
      ->add_option("--impulse-response-rate-hz", options->impulse_rate_hz,
                   "with --arrivals: CSV of the taps, sampled at this rate, instead")
      ->check(CLI::PositiveNumber);
  command->add_option("--plot", options->plot,
                      "with --arrivals: also draw level and angle against delay, FILE.png or FILE.svg");
  add_force_option(*command, options->force);
  command->footer(
      footer("  halocline link scenarios/seamount.toml --from auv-1 --to auv-2 --arrivals --plot a.svg\n"
             "  halocline link scenarios/shelf.toml --from 0,0,60 --to 2000,0,60 --json"));
  command->callback([options, &exit_code] { exit_code = link(*options); });
}

}  // namespace halocline::clients

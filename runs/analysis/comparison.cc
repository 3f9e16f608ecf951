// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/comparison.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>

#include "bus/logs/channel_types.h"
#include "bus/messages/channels.h"
#include "runs/timeline/packet_reasons.h"

namespace halocline::clients {
namespace {

constexpr double kLevelStep_db = 0.05, kRangeStep_m = 0.1, kFactorStep = 1e-6, kDurationStep_s = 1e-6;
constexpr double kNoInterference_db = -300;

// Key of a packet at a receiver, without the time of departure.
using PlaceKey =
    std::tuple<std::int32_t, std::int8_t, std::int64_t, std::int64_t, std::int32_t, std::int32_t>;
PlaceKey key_of(const packet_outcome_t& o) {
  return {o.source_id, o.packet_kind, o.send_session, o.packet_sequence, o.destination_id, o.receiver_id};
}

using Outcomes = std::vector<const packet_outcome_t*>;
std::map<PlaceKey, Outcomes> by_place(const OutcomeSummary& summary) {
  std::map<PlaceKey, Outcomes> places;
  for (const packet_outcome_t& outcome : summary.outcomes()) places[key_of(outcome)].push_back(&outcome);
  for (auto& [key, outcomes] : places) {
    std::stable_sort(outcomes.begin(), outcomes.end(),
                     [](auto* a, auto* b) { return a->departure_utime < b->departure_utime; });
  }
  return places;
}

// Removes from `others` the outcome with the same departure and returns it; null when there is none.
const packet_outcome_t* take_departed_with(Outcomes& others, std::int64_t departure_utime) {
  const auto same = std::find_if(others.begin(), others.end(),
                                 [&](auto* o) { return o->departure_utime == departure_utime; });
  if (same == others.end()) return nullptr;
  const packet_outcome_t* found = *same;
  others.erase(same);
  return found;
}

std::string level_text(double level_db) {
  return level_db <= kNoInterference_db ? "none" : fmt::format("{:.1f} dB", level_db);
}

// Inputs of a decision that differ between two outcomes, as names and as text.
class Differences {
 public:
  Differences(const packet_outcome_t& before, const packet_outcome_t& after) {
    level("level", before.received_level_db, after.received_level_db);
    level("noise", before.noise_level_db, after.noise_level_db);
    level("interference", before.interference_level_db, after.interference_level_db);
    number("paths", before.num_paths, after.num_paths, 0, "{:.0f}");
    number("propagation", before.propagation_used, after.propagation_used, 0, "{:.0f}");
    level("cutoff", before.cutoff_level_db, after.cutoff_level_db);
    number("range", before.range_m, after.range_m, kRangeStep_m, "{:.1f} m");
    number("duration", before.duration_s, after.duration_s, kDurationStep_s, "{:.3f} s");
    number("doppler", before.strongest_path_doppler_factor, after.strongest_path_doppler_factor, kFactorStep,
           "{:.6f}");
    if (before.acquisition_draw != after.acquisition_draw || before.success_draw != after.success_draw)
      add("draws", "");
    if (colliders(before) != colliders(after)) add("colliders", "");
  }
  const std::vector<std::string>& names() const { return names_; }
  std::string text() const { return text_; }

 private:
  using Names = std::vector<std::pair<std::int32_t, std::int64_t>>;
  static Names colliders(const packet_outcome_t& outcome) {
    Names names;
    for (const packet_name_t& packet : outcome.colliders)
      names.emplace_back(packet.source_id, packet.packet_sequence);
    return names;
  }
  void level(const char* name, double was, double is) {
    if (std::abs(is - was) >= kLevelStep_db) add(name, " " + level_text(was) + " -> " + level_text(is));
  }
  void number(const char* name, double was, double is, double step, const char* format) {
    const auto text = [&](double value) { return fmt::format(fmt::runtime(format), value); };
    if (std::abs(is - was) > step) add(name, " " + text(was) + " -> " + text(is));
  }
  void add(const char* name, const std::string& values) {
    names_.emplace_back(name);
    text_ += (text_.empty() ? "" : ", ") + std::string(name) + values;
  }

  std::vector<std::string> names_;
  std::string text_;
};

// True when two outcomes agree in every field except the publisher's session and sequence.
bool are_identical(packet_outcome_t a, packet_outcome_t b) {
  const auto bytes = [](packet_outcome_t& o) {
    o.session = o.sequence = 0;
    std::vector<std::uint8_t> text(static_cast<std::size_t>(o.getEncodedSize()));
    o.encode(text.data(), 0, static_cast<int>(text.size()));
    return text;
  };
  return bytes(a) == bytes(b);
}

// Returns why a log has no outcome that corresponds to one of the other log.
std::string absent_outcome(const LoggedOutcomes& log, const packet_outcome_t& other,
                           const std::string& sender) {
  if (log.summary.outcomes().empty()) return log.receipts.empty() ? "not recorded" : "no outcome";
  const auto receipt = log.receipts.find({sender, other.send_session, other.packet_sequence});
  if (receipt != log.receipts.end() && receipt->second != modem_receipt_t::ACCEPTED &&
      receipt->second != modem_receipt_t::QUEUED)
    return receipt_name(static_cast<std::size_t>(receipt->second));
  return other.utime >= log.end_utime ? "undecided at the end" : "no outcome";
}

std::string outcome_text(const packet_outcome_t& outcome) { return outcome_name(number_of(outcome)); }

}  // namespace

LoggedOutcomes outcomes_of(LogReader& log, std::int64_t zero_us) {
  LoggedOutcomes logged;
  for (LoggedEvent event; log.next(event);) {
    with_type_of(event.channel, [&]<class Message>() {
      if constexpr (std::is_same_v<Message, modem_receipt_t>) {
        Message message;
        if (!decode_checked(event.data, message)) return;
        const std::string vehicle = event.channel.substr(bus::channels::kReceipt.prefix.size());
        logged.receipts[{vehicle, message.send_session, message.packet_sequence}] = message.receipt_result;
        logged.end_utime = std::max(logged.end_utime, message.utime - zero_us);
      } else if constexpr (std::is_same_v<Message, modem_send_t>) {
        ++logged.sends;
      }
    });
    logged.summary.count(event, zero_us);
  }
  for (const packet_outcome_t& outcome : logged.summary.outcomes())
    logged.end_utime = std::max(logged.end_utime, outcome.utime);
  return logged;
}

Comparison::Comparison(const LoggedOutcomes& before, const LoggedOutcomes& after)
    : names_(before.summary.names()), anything_before_(!before.summary.outcomes().empty()) {
  names_.insert(after.summary.names().begin(), after.summary.names().end());
  auto was = by_place(before.summary), is = by_place(after.summary);
  for (auto& [key, outcomes] : was) {
    Outcomes& others = is[key];
    Outcomes moved;
    for (const packet_outcome_t* outcome : outcomes) {
      const packet_outcome_t* other = take_departed_with(others, outcome->departure_utime);
      if (other != nullptr)
        add(before, after, outcome, other);
      else
        moved.push_back(outcome);
    }
    for (std::size_t i = 0; i < std::max(moved.size(), others.size()); ++i)
      add(before, after, i < moved.size() ? moved[i] : nullptr, i < others.size() ? others[i] : nullptr);
    is.erase(key);
  }
  for (const auto& [key, outcomes] : is) {
    for (const packet_outcome_t* outcome : outcomes) add(before, after, nullptr, outcome);
  }
  std::stable_sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) {
    const auto order = [](const packet_outcome_t& o) {
      return std::tuple(o.departure_utime, o.source_id, o.packet_sequence, o.receiver_id);
    };
    return order(a.any()) < order(b.any());
  });
}

void Comparison::add(const LoggedOutcomes& before, const LoggedOutcomes& after, const packet_outcome_t* was,
                     const packet_outcome_t* is) {
  const auto named = [this](std::int32_t id) { return name(id); };
  const std::string sender = name((was != nullptr ? was : is)->source_id);
  Row row;
  if (was != nullptr) row.before = *was;
  if (is != nullptr) row.after = *is;
  row.outcome_before = was != nullptr ? outcome_text(*was) : absent_outcome(before, *is, sender);
  row.outcome_after = is != nullptr ? outcome_text(*is) : absent_outcome(after, *was, sender);
  if (row.before && row.after) {
    const Differences differences(*row.before, *row.after);
    row.moved = differences.names();
    identical_ += are_identical(*row.before, *row.after) ? 1 : 0;
    if (row.changed())
      row.why = deciding_reason(*row.after, named) + (row.moved.empty() ? "" : "; " + differences.text());
  } else if (row.after) {
    row.why = deciding_reason(*row.after, named);
  }
  ++transitions_[{row.outcome_before, row.outcome_after}];
  if (row.changed()) {
    ++changed_;
    for (const std::string& input : row.moved) ++moved_inputs_[input];
  }
  rows_.push_back(std::move(row));
}

std::string Comparison::name(std::int32_t vehicle_id) const {
  const auto found = names_.find(vehicle_id);
  return found != names_.end() ? found->second : std::to_string(vehicle_id);
}

}  // namespace halocline::clients

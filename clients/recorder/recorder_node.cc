// SPDX-License-Identifier: BSD-3-Clause
#include "clients/recorder/recorder_node.h"

#include <algorithm>
#include <ostream>
#include <stdexcept>
#include <utility>

#include "bus/logs/log_reader.h"
#include "core/names.h"

namespace halocline::clients {

RecorderNode::RecorderNode(lcm::LCM& lcm, bus::NodeIdentity identity, RecordedFile& file, std::ostream& out)
    : Node(lcm, std::move(identity)), file_(file), out_(out) {
  bus().subscribe_to_all_flows(
      [this](std::string_view channel, std::span<const std::uint8_t> message) {
        return head_of(channel, message);
      },
      [this](std::string_view channel, const void* data, std::size_t size) {
        record(channel, {static_cast<const std::uint8_t*>(data), size});
      });
  if (file_.goes_on()) recall();
  file_.log();
}

// Receives all messages of the file, so that those missing in it, published before or while no recorder ran,
// are requested.
void RecorderNode::recall() {
  recalls_ = true;
  file_.read([this](const LoggedEvent& event) {
    receive(event.channel, event.data);
    ++recalled_;
  });
  recalls_ = false;
  bus().continue_flows([](std::string_view) { return true; });
}

std::optional<bus::FlowHead> RecorderNode::head_of(std::string_view channel,
                                                   std::span<const std::uint8_t> message) {
  auto found = types_.find(channel);
  if (found == types_.end()) {
    if (types_.size() >= bus::FlowWatch::kMaxChannels) types_.clear();  // bounds the memory
    found = types_.emplace(std::string(channel), bus::flow_type_of(channel)).first;
  }
  return bus::flow_head(found->second, message);
}

void RecorderNode::record(std::string_view channel, std::span<const std::uint8_t> message) {
  if (!recalls_) file_.log().record(bus().received_at(), channel, message);
}

void RecorderNode::on_step(const bus::Now& now) {
  if (next_flush_ == SimTime::at_once()) out_ << "records to " << printable(file_.path()) << std::endl;
  next_flush_ = now.steady + kFlushPeriod;
  file_.log().hand_over();
  report_refusals();
}

void RecorderNode::report_refusals() {
  const std::int64_t refused = file_.log().events_refused();
  if (refused == refused_) return;
  if (refused_ == 0) bus().log().error("log-refused", "reason=\"disk full?\" file=" + file_.path());
  refused_ = refused;
}

// Excludes packets of programs without heartbeats, which may number them arbitrarily.
std::vector<bus::FlowWatch::Lacking> RecorderNode::lacking() const {
  std::vector<bus::FlowWatch::Lacking> all = bus().flows().lacking();
  std::erase_if(all, [](const bus::FlowWatch::Lacking& one) {
    return !one.is_listed && bus::flow_type_of(one.channel).is_packet_to_send;
  });
  return all;
}

std::string RecorderNode::summary() const {
  const std::int64_t refused = file_.log().events_refused();
  std::string text = std::to_string(recalled_ + file_.log().events() - refused) + " messages in " +
                     printable(file_.path()) + "; it lacks " + lacking_text(lacking());
  if (refused > 0) text += "; the disk refused " + std::to_string(refused);
  return text;
}

std::string RecorderNode::status_text() const { return summary(); }

int RecorderNode::finish() {
  bool is_written = true;
  try {
    file_.log().close();
  } catch (const std::runtime_error&) {  // the disk refused some messages, now or earlier
    is_written = false;
  }
  out_ << "recorded " << summary() << std::endl;
  if (!is_written) return 1;
  return lacking().empty() ? 0 : kExitLacking;
}

std::string lacking_text(std::vector<bus::FlowWatch::Lacking> lacking) {
  constexpr std::size_t kNamed = 10;
  if (lacking.empty()) return "none";
  std::stable_sort(lacking.begin(), lacking.end(),
                   [](const auto& a, const auto& b) { return a.messages > b.messages; });
  std::int64_t all = 0;
  std::string named;
  for (std::size_t i = 0; i < lacking.size(); ++i) {
    all = bus::saturating_sum(all, lacking[i].messages);
    if (i < kNamed)
      named += (i == 0 ? "" : ", ") + lacking[i].channel + " " + std::to_string(lacking[i].messages);
  }
  if (lacking.size() > kNamed) named += " and " + std::to_string(lacking.size() - kNamed) + " more channels";
  return std::to_string(all) + ": " + named;
}

}  // namespace halocline::clients

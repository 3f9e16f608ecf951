// SPDX-License-Identifier: BSD-3-Clause
// What pages of the monitor ask, and clients of Foxglove's protocol: requests, one a line, as the monitor
// takes them (monitor.cc), with a tenth of a second between them. What is no JSON or cannot be is an
// exception, which it answers.
#include <exception>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "core/check.h"
#include "runs/foxglove/foxglove_session.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/viewer/run_for_pages.h"
#include "viewer/pages/binary_messages.h"
#include "viewer/pages/command_desk.h"
#include "viewer/pages/packet_json.h"
#include "viewer/pages/page_session.h"
#include "viewer/pages/query_desk.h"
#include "viewer/pages/request_fields.h"
#include "viewer/pages/requests.h"
#include "viewer/pages/terrain_window.h"

namespace {

using namespace halocline;
using namespace halocline::monitor;
using nlohmann::json;

class Page {
 public:
  explicit Page(bool is_log)
      : source_(is_log),
        session_(source_, true, [this](const std::string& message, bool) { bytes_ += message.size(); }),
        foxglove_("test", [this](const std::string& message, bool) { bytes_ += message.size(); }) {}

  void take(const std::string& line, double now_s) {
    foxglove_.take(line);
    json reply = {{"type", "reply"}};
    try {
      answer(json::parse(line), reply);
    } catch (const std::exception& problem) {
      reply["error"] = problem.what();
    }
    session_.send(reply);
    const SimTime at = source_.now();
    session_.tick(now_s, true, packets_);
    foxglove_.tick(now_s, true, source_.timeline(), session_.at());
    commands_.tick(now_s, source_.timeline(), at);
    queries_.tick(now_s);
    ensure(bytes_ < 256u << 20, "what is sent is within bounds");
  }

 private:
  void answer(const json& request, json& reply) {
    reply["id"] = request_id(request);
    const std::string ask = text_in(request, "ask");
    if (ask == "command") return commands_.command(source_.timeline(), request);
    if (ask == "send")
      return commands_.send(source_.timeline(), request, source_.now(), [](const std::string&) {});
    if (ask == "terrain")
      return collect_terrain(queries_, terrain_window_in(request),
                             [](const DepthGrid*, const std::string&) {});
    if (!session_.take(request)) reply.update(answer_request(source_.timeline(), packets_, request));
  }

  std::size_t bytes_ = 0;
  testing::FixedSource source_;
  PacketIndex packets_;
  PageSession session_;
  clients::FoxgloveSession foxglove_;
  CommandDesk commands_{1, [](const std::string&, const bus::Bytes&) {}};
  QueryDesk queries_{"monitor-1", [](const std::string&, const bus::Bytes&) {}};
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  Page page(input.below(2) == 0);
  std::istringstream lines(std::string(input.rest_as_text()));
  double now_s = 0;
  for (std::string line; std::getline(lines, line);) page.take(line, now_s += 0.1);
  return 0;
}

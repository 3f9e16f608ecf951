// SPDX-License-Identifier: BSD-3-Clause
// A log, whatever state it is in: its events, what it lacks, and the timeline in it.
#include <sstream>
#include <string>
#include <string_view>

#include "bus/logs/channel_types.h"
#include "bus/logs/log_reader.h"
#include "core/check.h"
#include "runs/timeline/run_timeline.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/scratch_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace halocline;
  static fuzz::ScratchFile file(".lcm");
  file.write({reinterpret_cast<const char*>(data), size});
  try {
    clients::LogReader log(file.path());
    clients::RunTimeline timeline;
    std::size_t bytes = 0;
    for (clients::LoggedEvent event; log.next(event);) {
      bytes += event.data.size() + event.channel.size() + 28;  // and the head
      clients::with_type_of(event.channel, [&]<class Message>() {
        Message message;
        [[maybe_unused]] const bool is_sound = clients::decode_checked(event.data, message);
      });
      timeline.add(event.stamp_us, event.channel, event.data);
    }
    ensure(bytes + static_cast<std::size_t>(log.bytes_skipped()) <= size, "no byte is read twice");
    std::ostringstream text;
    clients::report_damage(text, log);
  } catch (const InvalidArgument&) {  // no log
  }
  return 0;
}

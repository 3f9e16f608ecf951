// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/channel_record_reader.h"

#include <memory>
#include <utility>

#include "core/files/guarded_reading.h"
#include "core/shared_module.h"

namespace halocline::acoustics {

ChannelRecord read_channel_record(const std::string& path, std::size_t receiver) {
  static const auto read = reinterpret_cast<ChannelRecordReader*>(
      module_symbol("halocline_channel_records.so", "halocline_read_channel_record"));
  return guarded_reading({path},
                         [&] { return std::move(*std::unique_ptr<ChannelRecord>(read(path, receiver))); });
}

}  // namespace halocline::acoustics

// SPDX-License-Identifier: BSD-3-Clause
// Reads measured channels from files (acoustics/fading/channel_record.h has the layout).
//
// HDF5 is in a module of its own (halocline_channel_records.so), loaded by the first file. Calls may not
// overlap between threads.
#pragma once

#include <cstddef>
#include <string>

#include "acoustics/fading/channel_record.h"

namespace halocline::acoustics {

// The channel to one of the file's receivers, from 0. Throws InvalidArgument that names the file, what in it
// is wrong and what is allowed; also when HDF5 cannot be loaded.
ChannelRecord read_channel_record(const std::string& path, std::size_t receiver);

// What the module halocline_channel_records.so exports as halocline_read_channel_record; the caller owns the
// result.
using ChannelRecordReader = ChannelRecord*(const std::string& path, std::size_t receiver);

}  // namespace halocline::acoustics

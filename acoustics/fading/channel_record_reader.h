// SPDX-License-Identifier: BSD-3-Clause
// Reads measured channels from files; acoustics/fading/channel_record.h describes the layout.
//
// HDF5 is linked into a module of its own (halocline_channel_records.so), which is loaded with the first
// file. Thread rule: calls must not overlap between threads.
#pragma once

#include <cstddef>
#include <string>

#include "acoustics/fading/channel_record.h"

namespace halocline::acoustics {

// The channel to one of the file's receivers, counted from 0. Throws InvalidArgument that names the file, the
// error in it and what is permitted; also when HDF5 cannot be loaded.
ChannelRecord read_channel_record(const std::string& path, std::size_t receiver);

// The function that the module exports as halocline_read_channel_record. The caller owns the result.
using ChannelRecordReader = ChannelRecord*(const std::string& path, std::size_t receiver);

}  // namespace halocline::acoustics

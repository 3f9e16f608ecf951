// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/waveform/wav_file.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <sndfile.h>

#include "core/atomic_file.h"
#include "core/check.h"
#include "core/files/input_file.h"

namespace halocline::clients {
namespace {

struct Closer {
  void operator()(SNDFILE* file) const { sf_close(file); }
};
using File = std::unique_ptr<SNDFILE, Closer>;

// Reads block by block, because a damaged header may claim any number of samples.
std::vector<double> read_samples(SNDFILE* file, sf_count_t count) {
  constexpr sf_count_t kBlock = 1 << 16;
  std::vector<double> values;
  for (sf_count_t got = kBlock; got == kBlock && static_cast<sf_count_t>(values.size()) < count;) {
    const std::size_t before = values.size();
    values.resize(before + kBlock);
    got = std::max<sf_count_t>(sf_readf_double(file, values.data() + before, kBlock), 0);
    values.resize(before + static_cast<std::size_t>(got));
  }
  return values;
}

}  // namespace

acoustics::Samples read_sound(const std::string& path) {
  require_input_file(path);
  SF_INFO info{};
  const File file(sf_open(path.c_str(), SFM_READ, &info));
  require(file != nullptr, path + ": cannot be read as sound: " + sf_strerror(nullptr));
  require(info.channels == 1, path + " has " + std::to_string(info.channels) + " channels; allowed is 1");
  require(info.frames > 0, path + " holds no sample");
  acoustics::Samples sound{0, static_cast<double>(info.samplerate), {}};
  sound.values = read_samples(file.get(), info.frames);
  const auto read = static_cast<sf_count_t>(sound.values.size());
  require(read == info.frames,
          path + " ends after " + std::to_string(read) + " of " + std::to_string(info.frames) + " samples");
  for (const double value : sound.values)
    require(std::isfinite(value), path + " holds a sample that is no number");
  return sound;
}

void write_wav(const std::string& path, const acoustics::Samples& sound) {
  SF_INFO info{};
  info.samplerate = static_cast<int>(sound.rate_hz);
  info.channels = 1;
  info.format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
  AtomicFile replacement(path);
  File file(sf_open(replacement.temporary_path().c_str(), SFM_WRITE, &info));
  require(file != nullptr, path + ": cannot be written: " + sf_strerror(nullptr));
  sf_command(file.get(), SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);  // it would contain the time of day
  const auto count = static_cast<sf_count_t>(sound.values.size());
  require(sf_writef_double(file.get(), sound.values.data(), count) == count && sf_close(file.release()) == 0,
          path + ": cannot be written whole");
  replacement.commit();
}

}  // namespace halocline::clients

// SPDX-License-Identifier: BSD-3-Clause
// Writes measured channels as HDF5 files for tests, right ones and malformed ones.
#pragma once

#include <complex>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace halocline::testing {

// Right unless told otherwise. Sizes are those of h_hat as C writes it: [time, receiver, delay].
struct ChannelFile {
  std::size_t instants = 4, receivers = 1, delays = 2;
  std::vector<std::complex<double>> h_hat;  // as many as the sizes say
  double version = 1, fs_delay = 5000, fs_time = 10, fc = 25'000;
  std::pair<const char*, const char*> names{"real", "imag"};  // of the parts of a complex number
  bool is_real = false;                                       // h_hat holds real parts alone
  bool is_flat = false;                                       // h_hat has one axis
  std::pair<std::size_t, std::size_t> theta_hat{0, 0};        // sizes; 0: none
  std::set<std::string> without;                              // datasets that are left out, by path

  std::complex<double>& at(std::size_t instant, std::size_t receiver, std::size_t delay) {
    return h_hat[(instant * receivers + receiver) * delays + delay];
  }
};

// A file of zeros of these sizes.
ChannelFile channel_file(std::size_t instants, std::size_t receivers, std::size_t delays);

// Where files are written: a folder of this process alone, as tests run at the same time. It ends with a
// slash.
std::string channel_file_folder();

// Writes the file into the folder of temporary files; returns its path.
std::string write_channel_file(const ChannelFile& file, const std::string& name);

// Changes a file so that its first group states no address of the names in it: libhdf5 1.10 follows it all
// the same (H5HL_protect), and the process dies.
void lose_names(const std::string& path);

}  // namespace halocline::testing

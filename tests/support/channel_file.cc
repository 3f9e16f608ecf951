// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/channel_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

namespace halocline::testing {
namespace {

void check(bool good, const std::string& what) {
  if (!good) throw std::runtime_error("cannot write " + what);
}

void write_set(hid_t file, const std::string& name, hid_t stored, hid_t given,
               const std::vector<hsize_t>& sizes, const void* values) {
  const hid_t space = H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr);
  const hid_t set = H5Dcreate2(file, name.c_str(), stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  check(H5Dwrite(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0, name);
  H5Dclose(set);
  H5Sclose(space);
}

void write_number(hid_t file, const ChannelFile& contents, const std::string& name, double value) {
  if (!contents.without.contains(name)) {
    write_set(file, name, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, {1, 1}, &value);
  }
}

void write_taps(hid_t file, const ChannelFile& contents) {
  std::vector<hsize_t> sizes{contents.instants, contents.receivers, contents.delays};
  if (contents.is_flat) sizes = {contents.h_hat.size()};
  if (contents.is_real) {
    std::vector<double> real;
    for (const std::complex<double> value : contents.h_hat) real.push_back(value.real());
    return write_set(file, "h_hat", H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, sizes, real.data());
  }
  const hid_t type = H5Tcreate(H5T_COMPOUND, sizeof(std::complex<double>));
  H5Tinsert(type, contents.names.first, 0, H5T_NATIVE_DOUBLE);
  H5Tinsert(type, contents.names.second, sizeof(double), H5T_NATIVE_DOUBLE);
  write_set(file, "h_hat", type, type, sizes, contents.h_hat.data());
  H5Tclose(type);
}

}  // namespace

ChannelFile channel_file(std::size_t instants, std::size_t receivers, std::size_t delays) {
  ChannelFile file;
  file.instants = instants;
  file.receivers = receivers;
  file.delays = delays;
  file.h_hat.resize(instants * receivers * delays);
  return file;
}

std::string channel_file_folder() {
  const std::string folder = ::testing::TempDir() + "halocline-channels-" + std::to_string(getpid()) + "/";
  std::filesystem::create_directories(folder);
  return folder;
}

std::string write_channel_file(const ChannelFile& contents, const std::string& name) {
  const std::string path = channel_file_folder() + name;
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  check(file >= 0, path);
  write_number(file, contents, "version", contents.version);
  if (!contents.without.contains("params")) {
    H5Gclose(H5Gcreate2(file, "params", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    write_number(file, contents, "params/fs_delay", contents.fs_delay);
    write_number(file, contents, "params/fs_time", contents.fs_time);
    write_number(file, contents, "params/fc", contents.fc);
  }
  if (!contents.without.contains("h_hat")) write_taps(file, contents);
  const auto [times, receivers] = contents.theta_hat;
  if (times > 0) {
    const std::vector<double> zeros(times * receivers);
    write_set(file, "theta_hat", H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, {times, receivers}, zeros.data());
  }
  H5Fclose(file);
  return path;
}

void lose_names(const std::string& path) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::size_t heap = bytes.find("HEAP");
  check(heap != std::string::npos, path);
  // Signature and version, size of the names, first free place, address (HDF5 File Format Specification,
  // III.D).
  constexpr std::size_t kAddress = 24;
  const std::string none(8, '\xff');
  file.clear();
  file.seekp(static_cast<std::streamoff>(heap + kAddress)).write(none.data(), 8);
}

}  // namespace halocline::testing

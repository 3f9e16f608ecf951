// SPDX-License-Identifier: BSD-3-Clause
// Reads measured channels from HDF5 files. This file is part of the module halocline_channel_records.so,
// which only channel_record_reader.cc loads.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "acoustics/fading/channel_record.h"
#include "acoustics/fading/channel_record_reader.h"
#include "core/check.h"
#include "core/files/input_file.h"

namespace halocline::acoustics {
namespace {

constexpr double kOldestVersion = 1, kFirstUnknownVersion = 2;
// Largest size of one number in a file. A limit is needed because HDF5 allocates whatever a damaged header
// claims.
constexpr std::size_t kMaxNumberBytes = 16;

// Owner of an HDF5 identifier, which it closes by the function for its kind.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  hid_t id() const { return id_; }
  bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  Close close_;
};

// A dataset, with its place in the file for messages.
class Dataset {
 public:
  Dataset(hid_t file, const std::string& path, const std::string& name)
      : place_(path + ": " + name),
        set_(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose),
        type_(set_.good() ? H5Dget_type(set_.id()) : -1, H5Tclose),
        space_(set_.good() ? H5Dget_space(set_.id()) : -1, H5Sclose) {
    require(set_.good() && type_.good() && space_.good(),
            place_ + ": is not there as a dataset; it is needed");
    const int axes = H5Sget_simple_extent_ndims(space_.id());
    require(axes >= 0, place_ + ": has no values");
    dimensions_.resize(static_cast<std::size_t>(axes));
    H5Sget_simple_extent_dims(space_.id(), dimensions_.data(), nullptr);
  }
  const std::string& place() const { return place_; }
  hid_t id() const { return set_.id(); }
  hid_t type() const { return type_.id(); }
  hid_t space() const { return space_.id(); }
  const std::vector<hsize_t>& dimensions() const { return dimensions_; }
  std::string dimensions_text() const {
    std::string text;
    for (const hsize_t size : dimensions_) text += (text.empty() ? "" : ", ") + std::to_string(size);
    return "[" + text + "]";
  }
  void require_real() const {
    const H5T_class_t kind = H5Tget_class(type());
    require((kind == H5T_FLOAT || kind == H5T_INTEGER) && H5Tget_size(type()) <= kMaxNumberBytes,
            place_ + ": is not of numbers; allowed are real numbers");
  }

 private:
  std::string place_;
  Handle set_, type_, space_;
  std::vector<hsize_t> dimensions_;
};

bool has(hid_t file, const std::string& name) { return H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0; }

double read_number(hid_t file, const std::string& path, const std::string& name) {
  const Dataset set(file, path, name);
  set.require_real();
  require(H5Sget_simple_extent_npoints(set.space()) == 1,
          set.place() + ": is of size " + set.dimensions_text() + "; allowed is one number");
  double value = 0;
  require(H5Dread(set.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0,
          set.place() + ": cannot be read");
  return require_finite(value, set.place());
}

// Names of the real and imaginary parts of a complex number in the file.
std::pair<const char*, const char*> complex_names(const Dataset& set) {
  if (H5Tget_class(set.type()) == H5T_COMPOUND && H5Tget_size(set.type()) <= 2 * kMaxNumberBytes &&
      H5Tget_nmembers(set.type()) == 2) {
    for (const auto& [real, imaginary] : {std::pair("real", "imag"), std::pair("r", "i")}) {
      if (H5Tget_member_index(set.type(), real) >= 0 && H5Tget_member_index(set.type(), imaginary) >= 0) {
        return {real, imaginary};
      }
    }
  }
  throw InvalidArgument(set.place() +
                        ": is not complex; allowed is a compound of two numbers called real and "
                        "imag, or r and i");
}

std::vector<std::complex<float>> read_taps(const Dataset& set, std::size_t receiver) {
  const auto [real, imaginary] = complex_names(set);
  const std::vector<hsize_t>& size = set.dimensions();
  const Handle type(H5Tcreate(H5T_COMPOUND, sizeof(std::complex<float>)), H5Tclose);
  H5Tinsert(type.id(), real, 0, H5T_NATIVE_FLOAT);
  H5Tinsert(type.id(), imaginary, sizeof(float), H5T_NATIVE_FLOAT);
  const hsize_t first[3] = {0, receiver, 0}, count[3] = {size[0], 1, size[2]};
  H5Sselect_hyperslab(set.space(), H5S_SELECT_SET, first, nullptr, count, nullptr);
  const hsize_t values = size[0] * size[2];
  const Handle memory(H5Screate_simple(1, &values, nullptr), H5Sclose);
  std::vector<std::complex<float>> taps(values);
  require(H5Dread(set.id(), type.id(), memory.id(), set.space(), H5P_DEFAULT, taps.data()) >= 0,
          set.place() + ": cannot be read");
  return taps;
}

// Checks the size of the motion of the measured ends, if the file has it: it has to cover the record's
// duration, within the half instant that rounding permits, and its receivers.
void check_motion(hid_t file, const std::string& path, const std::string& name, const ChannelRecord& record,
                  hsize_t receivers) {
  if (!has(file, name)) return;
  const Dataset set(file, path, name);
  set.require_real();
  const std::vector<hsize_t>& size = set.dimensions();
  const double duration_s = size.empty() ? 0 : static_cast<double>(size[0]) / record.delay_rate_hz;
  const bool fits = size.size() == 2 && size[1] == receivers &&
                    std::abs(duration_s - record.duration_s()) * record.time_rate_hz <= 0.5;
  require(fits, set.place() + ": is of size " + set.dimensions_text() +
                    "; allowed is [time at fs_delay, receiver] with as long a time and as many receivers as "
                    "h_hat, which is [time, receiver, delay], of " +
                    std::to_string(record.instants()) + ", " + std::to_string(receivers) + " and " +
                    std::to_string(record.delays));
}

ChannelRecord read_record(const std::string& path, std::size_t receiver) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // failures are reported by exceptions, not on stderr
  require_input_file(path);
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  require(file.good(), path + ": cannot be read as HDF5 (netCDF-4, MATLAB 7.3)");
  const double version = read_number(file.id(), path, "version");
  require(version >= kOldestVersion && version < kFirstUnknownVersion,
          path + ": version: is " + std::to_string(version) + "; allowed is 1 and up, below 2");
  const bool has_rates = has(file.id(), "params");
  require(has_rates, path + ": params: is not there; allowed is a group of fs_delay, fs_time and fc");
  ChannelRecord record;
  record.name = path + ", receiver " + std::to_string(receiver);
  record.delay_rate_hz = read_number(file.id(), path, "params/fs_delay");
  record.time_rate_hz = read_number(file.id(), path, "params/fs_time");
  record.carrier_hz = read_number(file.id(), path, "params/fc");
  const Dataset taps(file.id(), path, "h_hat");
  const std::vector<hsize_t>& size = taps.dimensions();
  require(size.size() == 3,
          taps.place() + ": is of size " + taps.dimensions_text() +
              "; allowed are the axes [time, receiver, delay], in MATLAB [delay, receiver, time]");
  require(receiver < size[1], taps.place() + ": has " + std::to_string(size[1]) +
                                  " receivers; given is number " + std::to_string(receiver) + " (from 0)");
  require(size[2] <= kMaxRecordDelays && size[0] <= kMaxRecordTaps / std::max<hsize_t>(size[2], 1),
          taps.place() + ": is of size " + taps.dimensions_text() + "; allowed are " +
              std::to_string(kMaxRecordDelays) + " delays and " + std::to_string(kMaxRecordTaps) +
              " values a receiver");
  // Deflate expands a byte to at most 1032 bytes; the check rejects sizes that a damaged header claims but no
  // file of this size can contain.
  constexpr std::uintmax_t kMaxCompression = 1032;
  hsize_t file_bytes = 0;
  require(H5Fget_filesize(file.id(), &file_bytes) >= 0, path + ": has no size");
  require(size[0] * size[2] <= kMaxCompression * file_bytes / sizeof(std::complex<float>),
          taps.place() + ": is of size " + taps.dimensions_text() + "; the file is too short for that");
  record.delays = size[2];
  record.taps = read_taps(taps, receiver);
  validate(record);
  check_motion(file.id(), path, "theta_hat", record, size[1]);
  check_motion(file.id(), path, "phi_hat", record, size[1]);
  return record;
}

}  // namespace
}  // namespace halocline::acoustics

extern "C" halocline::acoustics::ChannelRecordReader halocline_read_channel_record;

halocline::acoustics::ChannelRecord* halocline_read_channel_record(const std::string& path,
                                                                   std::size_t receiver) {
  return new halocline::acoustics::ChannelRecord(halocline::acoustics::read_record(path, receiver));
}

// SPDX-License-Identifier: BSD-3-Clause
#include "ocean/netcdf_header.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/files/input_file.h"

namespace halocline::ocean {
namespace {

using Number = std::uint64_t;
constexpr std::string_view kHdf5Signature("\x89HDF\r\n\x1a\n", 8);
constexpr Number kMaxEntries = 1'000'000;  // longer lists are damaged; netCDF allows 8192
constexpr std::array<Number, 12> kTypeBytes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};  // for types 1 to 11
constexpr Number kDimensions = 10, kVariables = 11, kAttributes = 12;             // list tags
constexpr Number kMinDimension = 8, kMinVariable = 28, kMinAttribute = 12, kMinIndex = 4;  // in bytes

Number padded(Number bytes) { return (bytes + 3) / 4 * 4; }

// Cursor over the bytes of a file; each step is checked against the end of the file.
class Cursor {
 public:
  explicit Cursor(const std::string& path)
      : path_(path),
        file_(open_input(path)),
        size_(static_cast<Number>(file_.seekg(0, std::ios::end).tellg())) {
    file_.seekg(0);
  }

  Number size() const { return size_; }
  Number at() const { return at_; }
  Number left() const { return size_ - at_; }

  void go_to(Number place) {
    at_ = place;
    file_.seekg(static_cast<std::streamoff>(place));
  }
  std::string bytes(Number count) {
    bounded(count, 1);
    std::string text(count, '\0');
    file_.read(text.data(), static_cast<std::streamsize>(count));
    if (!file_) damaged("cannot be read");
    at_ += count;
    return text;
  }
  void skip(Number count) {
    bounded(count, 1);
    if (count > 0) go_to(at_ + count);
  }
  Number big_endian(Number count) {
    Number value = 0;
    for (const char byte : bytes(count)) value = value << 8 | static_cast<unsigned char>(byte);
    return value;
  }
  Number little_endian(Number count) {
    std::string text = bytes(count);
    Number value = 0;
    std::reverse(text.begin(), text.end());
    for (const char byte : text) value = value << 8 | static_cast<unsigned char>(byte);
    return value;
  }
  // Returns `count` after checking that so many items, of `least_bytes` or more each, fit into the remaining
  // bytes.
  Number bounded(Number count, Number least_bytes) const {
    if (count > left() / least_bytes)
      damaged("it names " + std::to_string(count) + " things where " + std::to_string(left()) +
              " bytes are left");
    return count;
  }
  [[noreturn]] void damaged(const std::string& what) const {
    throw InvalidArgument(path_ + ": its header is damaged or cut off: " + what + " (byte " +
                          std::to_string(at_) + " of " + std::to_string(size_) + "): fetch it again");
  }
  [[noreturn]] void refuse(const std::string& what) const { throw InvalidArgument(path_ + ": " + what); }

 private:
  std::string path_;
  std::ifstream file_;
  Number size_ = 0, at_ = 0;
};

struct Variable {
  std::string name;
  Number begin = 0, bytes = 0;  // for one record, if the variable has records
  bool has_records = false;
};

// Header of a classic file: where its variables lie.
class ClassicHeader {
 public:
  explicit ClassicHeader(Cursor& in) : in_(in) {
    in_.go_to(3);
    version_ = in_.big_endian(1);
    records_ = count();
    read_dimensions();
    skip_attributes();
    for (Number n = list(kVariables, kMinVariable); n > 0; --n) variables_.push_back(read_variable());
  }

  void require_whole() const {
    const Number unstated = version_ == 5 ? std::numeric_limits<Number>::max() : 0xFFFFFFFFU;
    const bool has_records =
        std::any_of(variables_.begin(), variables_.end(), [](const Variable& v) { return v.has_records; });
    if (has_records && records_ == unstated)
      in_.refuse(
          "its number of records is not stated, as a stream writes it: `nccopy` makes a file that states it");
    const Number step = record_bytes();
    for (const Variable& variable : variables_) {
      if (variable.has_records && records_ == 0) continue;
      const Number before = variable.has_records ? product(records_ - 1, step) : 0;
      const Number end = sum(variable.begin, sum(before, variable.bytes));
      if (end > in_.size())
        in_.refuse("is cut short: its variable " + variable.name + " ends at byte " + std::to_string(end) +
                   ", the file has " + std::to_string(in_.size()) + ": fetch it again");
    }
  }

 private:
  Number count() { return in_.big_endian(version_ == 5 ? 8 : 4); }

  Number list(Number tag, Number least_bytes) {
    const Number found = in_.big_endian(4), entries = count();
    if (found != tag && (found != 0 || entries != 0)) in_.damaged("a list has another kind");
    if (entries > kMaxEntries) in_.damaged("a list has " + std::to_string(entries) + " entries");
    return in_.bounded(entries, least_bytes);
  }

  std::string name() {
    constexpr Number kLongest = 4096;
    const Number length = in_.bounded(count(), 1);
    if (length > kLongest) in_.damaged("a name has " + std::to_string(length) + " bytes");
    std::string text = in_.bytes(length);
    in_.skip(padded(length) - length);
    return text;
  }

  void read_dimensions() {
    for (Number n = list(kDimensions, kMinDimension); n > 0; --n) {
      name();
      lengths_.push_back(count());
    }
    if (std::count(lengths_.begin(), lengths_.end(), Number{0}) > 1)
      in_.damaged("it has two dimensions of records");
  }

  Number type_bytes() {
    const Number type = in_.big_endian(4);
    if (type == 0 || type >= kTypeBytes.size()) in_.damaged("it has a type " + std::to_string(type));
    return kTypeBytes[type];
  }

  void skip_attributes() {
    for (Number n = list(kAttributes, kMinAttribute); n > 0; --n) {
      name();
      const Number bytes = type_bytes();
      in_.skip(padded(in_.bounded(count(), bytes) * bytes));
    }
  }

  Variable read_variable() {
    Variable variable{name()};
    std::vector<Number> dimensions(in_.bounded(count(), kMinIndex));
    for (Number& dimension : dimensions) {
      dimension = count();
      if (dimension >= lengths_.size()) in_.damaged(variable.name + " has a dimension that is not there");
    }
    skip_attributes();
    variable.bytes = type_bytes();
    count();  // the stored vsize
    variable.begin = in_.big_endian(version_ == 1 ? 4 : 8);
    for (std::size_t i = 0; i < dimensions.size(); ++i) {
      const Number length = lengths_[dimensions[i]];
      if (length == 0 && i > 0) in_.damaged(variable.name + " has its records inside");
      variable.has_records |= length == 0;
      variable.bytes = product(variable.bytes, length == 0 ? 1 : length);
    }
    return variable;
  }

  // Returns the distance from one record to the next, over all record variables, bytes.
  Number record_bytes() const {
    Number total = 0, with_records = 0, only = 0;
    for (const Variable& variable : variables_) {
      if (!variable.has_records) continue;
      ++with_records;
      only = variable.bytes;
      total = sum(total, padded(std::min(variable.bytes, kMax)));
    }
    return with_records == 1 ? only : total;
  }

  // Sums and products saturate here, beyond the size of any file.
  static constexpr Number kMax = Number{1} << 62;
  static Number product(Number a, Number b) { return b != 0 && a > kMax / b ? kMax : a * b; }
  static Number sum(Number a, Number b) { return std::min(kMax, std::min(a, kMax) + std::min(b, kMax)); }

  Cursor& in_;
  Number version_ = 1, records_ = 0;
  std::vector<Number> lengths_;
  std::vector<Variable> variables_;
};

// The superblock lies at byte 0, 512, 1024, 2048, ...
std::optional<Number> superblock_of(Cursor& in) {
  for (Number place = 0; place + kHdf5Signature.size() < in.size(); place = place == 0 ? 512 : 2 * place) {
    in.go_to(place);
    if (in.bytes(kHdf5Signature.size()) == kHdf5Signature) return place;
  }
  return std::nullopt;
}

void require_whole_hdf5(Cursor& in, Number superblock) {
  in.go_to(superblock + kHdf5Signature.size());
  const Number version = in.little_endian(1);
  if (version > 3) in.damaged("HDF5 superblocks of version " + std::to_string(version) + " are not known");
  const bool is_old = version < 2;
  if (is_old) in.skip(4);
  const Number offset_bytes = in.little_endian(1);
  if (offset_bytes < 2 || offset_bytes > 8)
    in.damaged("an offset has " + std::to_string(offset_bytes) + " bytes");
  in.skip(is_old ? (version == 1 ? 14 : 10) : 2);
  in.skip(2 * offset_bytes);  // base and extension, or base and free-space addresses
  const Number end = in.little_endian(offset_bytes);
  if (end > in.size())
    in.refuse("is cut short: by its header it ends at byte " + std::to_string(end) + ", the file has " +
              std::to_string(in.size()) + ": fetch it again");
}

struct Signature {
  std::string_view bytes, kind;
};
constexpr std::array<Signature, 9> kOtherKinds{{{"<", "HTML or XML, as a failed download leaves it"},
                                                {"MATLAB 5", "a MATLAB 5 file: save it with -v7.3"},
                                                {"\x1f\x8b", "compressed (gzip): unpack it"},
                                                {"BZh", "compressed (bzip2): unpack it"},
                                                {"PK", "a zip archive: unpack it"},
                                                {"GRIB", "GRIB: `cdo -f nc copy` makes netCDF of it"},
                                                {"RIFF", "a sound file"},
                                                {"II*", "a TIFF image"},
                                                {"{", "JSON"}}};

std::string kind_in_words(const std::string& start) {
  for (const Signature& one : kOtherKinds) {
    if (start.starts_with(one.bytes)) return "it is " + std::string(one.kind);
  }
  return "it starts like neither classic netCDF nor HDF5";
}

std::string start_of(Cursor& in) {
  in.go_to(0);
  return in.bytes(std::min<Number>(in.size(), 16));
}

NetcdfKind kind_of(Cursor& in) {
  const std::string start = start_of(in);
  const bool is_classic =
      start.size() >= 4 && start.starts_with("CDF") && (start[3] == 1 || start[3] == 2 || start[3] == 5);
  if (is_classic) return NetcdfKind::kClassic;
  return superblock_of(in) ? NetcdfKind::kHdf5 : NetcdfKind::kNone;
}

}  // namespace

NetcdfKind netcdf_kind_of(const std::string& path) {
  Cursor in(path);
  return kind_of(in);
}

void require_whole_netcdf(const std::string& path) {
  Cursor in(path);
  switch (kind_of(in)) {
    case NetcdfKind::kClassic:
      return ClassicHeader(in).require_whole();
    case NetcdfKind::kHdf5:
      return require_whole_hdf5(in, *superblock_of(in));
    case NetcdfKind::kNone:
      in.refuse(in.size() == 0 ? "is empty" : "cannot be read as netCDF: " + kind_in_words(start_of(in)));
  }
}

}  // namespace halocline::ocean

// SPDX-License-Identifier: BSD-3-Clause
// Files that a configuration names and carries along, so that a log, or the configuration beside it, replays
// anywhere.
//
// A configuration that is written to travel ends with a table for each file that its keys name:
//
//   [[file]]
//   name = "modem.toml"
//   xxh3 = "a9ca6625fbec8fdf"
//   lines = ["source_level_db = 181.0", ""]
//
// Keys name the file by `name`. A text is carried by its lines, other bytes as `base64`. What is above
// kMaxCarriedBytes, or made of several files, is not carried: its table has `place` and `bytes`, and the file
// is read there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/files/file_path.h"

namespace halocline::bus {

struct ConfigDocument;

// Texts of a key that name files; the others stay as they are.
enum class FileNames {
  kFiles,    // all
  kShipped,  // those ending in .toml; others are what ships by that name
  kRasters,  // those that are no names of GDAL's own ("NETCDF:...", "/vsi...")
};
[[nodiscard]] bool names_a_file(const std::string& text, FileNames names);

inline constexpr std::size_t kMaxCarriedBytes = 1'000'000;  // of one file
inline constexpr std::size_t kMaxCarriedInAll = 4'000'000;  // of all files of a configuration

// The files of a configuration that was read, unpacked into a folder of their own. The folder is removed with
// the last path into it.
class UnpackedFiles {
 public:
  struct Named {
    std::string place;
    std::uint64_t bytes = 0;
    std::string xxh3;  // 16 hexadecimal digits
  };

  UnpackedFiles();  // throws std::runtime_error when there is no room for temporary files
  ~UnpackedFiles();
  UnpackedFiles(const UnpackedFiles&) = delete;
  UnpackedFiles& operator=(const UnpackedFiles&) = delete;

  // Throw InvalidArgument for a name that is none of a file within a folder, and for bytes of another hash.
  void add(const std::string& name, const std::string& bytes, const std::string& xxh3);
  void add(const std::string& name, Named named);

  [[nodiscard]] std::optional<std::string> place_of(const std::string& name) const;
  // Difference of the file of that name from the recorded one, as a sentence; empty where there is none, or
  // where its bytes were carried.
  [[nodiscard]] std::string difference(const std::string& name) const;

 private:
  std::string folder_;
  std::map<std::string, Named> files_;
};

// Origin of a FilePath that was read from a configuration, as its origin() holds it.
struct FileOrigin {
  std::shared_ptr<UnpackedFiles> unpacked;   // that hold the file; null for one that lies where it is named
  std::shared_ptr<ConfigDocument> document;  // of a file in TOML that has been read
};

// Collects the files that a configuration names while it is written.
class CarriedFiles {
 public:
  enum class Which { kAll, kUnpacked };  // kUnpacked: the others are written by their absolute place
  explicit CarriedFiles(Which which) : which_(which) {}

  // The text by which the configuration is to name this file.
  std::string name_of(const FilePath& path, FileNames names);
  // The tables; empty for no files.
  [[nodiscard]] std::string to_toml() const;

 private:
  std::string new_name(const std::string& place) const;
  std::string table_of(const std::string& name, const std::string& place, const FilePath& path,
                       FileNames names);

  Which which_;
  std::size_t carried_bytes_ = 0;
  std::map<std::string, std::string> names_;   // by place
  std::map<std::string, std::string> tables_;  // by name
};

}  // namespace halocline::bus

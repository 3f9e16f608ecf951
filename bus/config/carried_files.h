// SPDX-License-Identifier: BSD-3-Clause
// Carried files: files that a configuration names and contains, so that a log, or its configuration, can be
// replayed on any host.
//
// A portable configuration ends with a table for each file that its keys name:
//
//   [[file]]
//   name = "modem.toml"
//   xxh3 = "a9ca6625fbec8fdf"
//   lines = ["source_level_db = 181.0", ""]
//
// A text is carried by its lines, other content as `base64`. A file larger than kMaxCarriedBytes, or one that
// consists of several files, is not carried: its table has `place` and `bytes`, and the file is read from
// there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/files/file_path.h"

namespace halocline::bus {

struct ConfigDocument;

// Texts of a key that are file names; other texts are left unchanged.
enum class FileNames {
  kFiles,    // all
  kShipped,  // texts that end in .toml; others name a shipped file
  // All but GDAL's own names: "/vsi...", and those that start with a driver in capitals, "NETCDF:...".
  kRasters,
};
[[nodiscard]] bool names_a_file(const std::string& text, FileNames names);

inline constexpr std::size_t kMaxCarriedBytes = 1'000'000;  // limit for one file
inline constexpr std::size_t kMaxCarriedInAll = 4'000'000;  // limit for all files of a configuration

// Carried files of a configuration that was read, unpacked into a temporary folder. The folder is removed
// with the last path into it.
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

  // Throws InvalidArgument for a name that is not that of a file within a folder, and for bytes with another
  // hash.
  void add(const std::string& name, const std::string& bytes, const std::string& xxh3);
  void add(const std::string& name, Named named);

  [[nodiscard]] std::optional<std::string> place_of(const std::string& name) const;
  // Returns how the file of that name differs from the recorded one, as a sentence; empty if it does not, or
  // if its bytes were carried.
  [[nodiscard]] std::string difference(const std::string& name) const;

 private:
  std::string folder_;
  std::map<std::string, Named> files_;
};

// Origin of a FilePath that was read from a configuration, stored as its origin().
struct FileOrigin {
  std::shared_ptr<UnpackedFiles> unpacked;   // hold the file; null for a file at its original place
  std::shared_ptr<ConfigDocument> document;  // null unless the file is a TOML file that has been read
};

// Collects the files that a configuration names while the configuration is written.
class CarriedFiles {
 public:
  enum class Which { kAll, kUnpacked };  // kUnpacked: other files are written by their absolute place
  explicit CarriedFiles(Which which) : which_(which) {}

  // Returns the text by which the configuration is to name this file.
  std::string name_of(const FilePath& path, FileNames names);
  // Returns the tables; empty if there are no files.
  [[nodiscard]] std::string to_toml() const;

 private:
  struct Table {
    std::string text;
    std::size_t carried_bytes = 0;  // size of the file; 0 if it is not carried
    bool has_its_files = false;     // made from a TOML file whose files are known
  };
  std::string new_name(const std::string& place) const;
  Table table_of(const std::string& name, const std::string& place, const FilePath& path, FileNames names);

  Which which_;
  std::size_t carried_bytes_ = 0;
  std::map<std::string, std::string> names_;  // keyed by place
  std::map<std::string, Table> tables_;       // keyed by name
};

}  // namespace halocline::bus

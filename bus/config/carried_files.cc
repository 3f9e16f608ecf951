// SPDX-License-Identifier: BSD-3-Clause
#include "bus/config/carried_files.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "bus/config/config.h"
#include "bus/config/config_document.h"
#include "core/check.h"
#include "core/files/input_file.h"
#include "core/hash.h"
#include "core/text/base64.h"
#include "core/text/hex_digits.h"
#include "core/text/lower_case.h"

namespace halocline::bus {
namespace {

namespace fs = std::filesystem;

// Limit for a line of text; files with longer lines are written as base 64.
constexpr std::size_t kMaxLine = 1000;
constexpr std::size_t kBytesOfBase64 = 750;  // bytes in one line of base 64

// Hashes a file in pieces; each piece is hashed with the hash of the previous ones as its seed.
std::string hash_of_file(const std::string& place) {
  std::ifstream file(place, std::ios::binary);
  std::vector<char> piece(1u << 20);
  std::uint64_t hash = 0;
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    if (file.gcount() > 0)
      hash = xxh3(std::string_view(piece.data(), static_cast<std::size_t>(file.gcount())), hash);
  }
  return hex_digits(hash);
}

// A large file is hashed only once in a process, unless it changes.
std::string known_hash_of_file(const std::string& place, std::uint64_t bytes) {
  static std::mutex mutex;
  static std::map<std::tuple<std::string, std::uint64_t, std::int64_t>, std::string> known;
  const std::lock_guard lock(mutex);
  std::error_code error;
  const auto changed = fs::last_write_time(place, error).time_since_epoch().count();
  std::string& hash = known[{place, bytes, static_cast<std::int64_t>(changed)}];
  if (hash.empty()) hash = hash_of_file(place);
  return hash;
}

std::string bytes_of_file(const std::string& place) {
  std::ifstream file(place, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

bool is_plain_text(const std::string& bytes) {
  std::size_t line = 0;
  for (const char c : bytes) {
    line = c == '\n' ? 0 : line + 1;
    if (line > kMaxLine || static_cast<unsigned char>(c) >= 0x80 || c == '\0') return false;
  }
  return true;
}

std::string array_of(const std::string& key, const std::vector<std::string>& elements) {
  std::string text = key + " = [\n";
  for (const std::string& element : elements) text += toml_quoted(element) + ",\n";
  return text + "]\n";
}

std::string lines_of(const std::string& text) {
  std::vector<std::string> lines{""};
  for (const char c : text) {
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  return array_of("lines", lines);
}

std::string base64_lines_of(const std::string& bytes) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < bytes.size(); i += kBytesOfBase64) {
    const std::string piece = bytes.substr(i, kBytesOfBase64);
    lines.push_back(base64_of({reinterpret_cast<const std::uint8_t*>(piece.data()), piece.size()}));
  }
  return array_of("base64", lines);
}

// True for the endings, after the raster's name or its stem, that GDAL's drivers look for. `own` is the
// raster's own: the ending of a world file is that with a w.
bool is_of_companion(const std::string& ending, const std::string& own) {
  static constexpr std::array<std::string_view, 21> kEndings{
      "prj", "hdr", "wld", "tfw", "bpw",  "jgw",  "pgw",     "gfw", "clr", "stx", "tab",
      "ovr", "msk", "aux", "rrd", "sgrd", "mgrd", "aux.xml", "ige", "eww", "rde"};
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end() ||
         (!own.empty() && ending == own + "w");
}

// True if files next to the raster belong to it, by their endings in any case, or if it is a description that
// names other files.
bool has_companions(const fs::path& raster) {
  const std::string name = raster.filename().string(), stem = raster.stem().string(),
                    own = lower_case(raster.extension().string()).erase(0, 1);
  if (own == "vrt") return true;
  std::error_code error;
  for (fs::directory_iterator entry(raster.parent_path(), error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string other = entry->path().filename().string();
    for (const std::string& base : {stem + ".", name + "."}) {
      if (other.starts_with(base) && is_of_companion(lower_case(other.substr(base.size())), own)) return true;
    }
  }
  return false;
}

const FileOrigin* origin_of(const FilePath& path) {
  return static_cast<const FileOrigin*>(path.origin().get());
}

// True for a TOML file that was read, and that names files.
bool is_known_to_name_files(const FilePath& path) {
  const FileOrigin* origin = origin_of(path);
  return origin != nullptr && origin->document && !origin->document->files.empty();
}

// Returns the content to carry: the file unchanged, except for the file names in a TOML file that was read.
std::string content_of(const std::string& place, const FilePath& path, CarriedFiles& files) {
  return is_known_to_name_files(path) ? to_text(*origin_of(path)->document, {}, files) : bytes_of_file(place);
}

// True for the names by which GDAL finds other things than files: "NETCDF:...", "GTIFF_DIR:...", "/vsi...".
bool is_name_of_gdal(std::string_view text) {
  const std::string_view driver = text.substr(0, text.find(':'));
  const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  return text.starts_with("/vsi") ||
         (driver.size() < text.size() && !driver.empty() && is_upper(driver.front()) &&
          std::all_of(driver.begin(), driver.end(),
                      [&](char c) { return is_upper(c) || (c >= '0' && c <= '9') || c == '_'; }));
}

std::string text_in(const toml::table& table, std::string_view key) {
  return table[key].value_or(std::string());
}

std::string joined(const toml::array& lines, std::string_view between) {
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i)
    text += std::string(i == 0 ? "" : between) + lines.get(i)->value_or(std::string());
  return text;
}

}  // namespace

void unpack(const toml::table& table, UnpackedFiles& files) {
  const std::string name = text_in(table, "name"), xxh3_text = text_in(table, "xxh3");
  if (const toml::array* lines = table["lines"].as_array()) {
    files.add(name, joined(*lines, "\n"), xxh3_text);
  } else if (const toml::array* rows = table["base64"].as_array()) {
    const auto bytes = bytes_of_base64(joined(*rows, ""));
    require(bytes.has_value(), "base64 is none");
    files.add(name, std::string(bytes->begin(), bytes->end()), xxh3_text);
  } else {
    const std::string place = text_in(table, "place");
    require(!place.empty(), "lines, base64 or place is missing");
    files.add(name, {place, table["bytes"].value_or(std::uint64_t{0}), xxh3_text});
  }
}

bool names_a_file(const std::string& text, FileNames names) {
  if (text.empty()) return false;
  if (names == FileNames::kShipped) return text.ends_with(".toml");
  return names == FileNames::kFiles || !is_name_of_gdal(text);
}

UnpackedFiles::UnpackedFiles() {
  std::string folder = (fs::temp_directory_path() / "halocline-files-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr)
    throw std::runtime_error("cannot make a folder for the files of a configuration, " + folder + ": " +
                             std::strerror(errno));
  folder_ = folder;
}

UnpackedFiles::~UnpackedFiles() {
  std::error_code error;
  fs::remove_all(folder_, error);
}

void UnpackedFiles::add(const std::string& name, const std::string& bytes, const std::string& xxh3_text) {
  require(hex_digits(xxh3(bytes)) == xxh3_text, "its bytes have the hash " + hex_digits(xxh3(bytes)));
  Named named{(fs::path(folder_) / name).string(), bytes.size(), ""};
  add(name, named);
  std::ofstream file(named.place, std::ios::binary);
  file << bytes;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + named.place);
}

void UnpackedFiles::add(const std::string& name, Named named) {
  require(!name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos,
          "allowed is the name of a file without a folder");
  files_[name] = std::move(named);
}

std::optional<std::string> UnpackedFiles::place_of(const std::string& name) const {
  const auto found = files_.find(name);
  return found == files_.end() ? std::nullopt : std::optional(found->second.place);
}

std::string UnpackedFiles::difference(const std::string& name) const {
  const Named& named = files_.at(name);
  std::error_code error;
  const auto bytes = fs::file_size(named.place, error);
  if (named.xxh3.empty()) return "";
  if (error) return "a file of " + std::to_string(named.bytes) + " bytes was there when this was recorded";
  const bool is_same = bytes == named.bytes && known_hash_of_file(named.place, bytes) == named.xxh3;
  return is_same ? ""
                 : "it is another file than the one of " + std::to_string(named.bytes) +
                       " bytes that was there when this was recorded";
}

std::string CarriedFiles::name_of(const FilePath& path, FileNames names) {
  std::error_code error;
  if (!names_a_file(path.given(), names) || !fs::is_regular_file(path.place(), error)) return path.given();
  const std::string place = absolute_place(path.place());
  const FileOrigin* origin = origin_of(path);
  const bool is_unpacked = origin != nullptr && origin->unpacked != nullptr;
  if (which_ == Which::kUnpacked && !is_unpacked) return place;
  // A file may be met before it is read: the table is made again once the files that it names are known.
  const bool names_files = is_known_to_name_files(path);
  const auto known = names_.find(place);
  if (known != names_.end() && (!names_files || tables_[known->second].has_its_files)) return known->second;
  const std::string name = known != names_.end() ? known->second : names_[place] = new_name(place);
  carried_bytes_ -= tables_[name].carried_bytes;
  tables_[name] = {"", 0, names_files};  // reserves the name while the files that it names are visited
  tables_[name] = table_of(name, place, path, names);
  return name;
}

std::string CarriedFiles::new_name(const std::string& place) const {
  const fs::path own = fs::path(place).filename();
  std::string name = own.string();
  for (int number = 2; tables_.contains(name); ++number)
    name = own.stem().string() + "-" + std::to_string(number) + own.extension().string();
  return name;
}

CarriedFiles::Table CarriedFiles::table_of(const std::string& name, const std::string& place,
                                           const FilePath& path, FileNames names) {
  const std::string head = "\n[[file]]\nname = " + toml_quoted(name) + "\n";
  const std::size_t size = fs::file_size(place);
  const bool names_files = is_known_to_name_files(path);
  const bool is_carried = size <= kMaxCarriedBytes && carried_bytes_ + size <= kMaxCarriedInAll &&
                          !(names == FileNames::kRasters && has_companions(place));
  if (!is_carried)
    return {head + "xxh3 = \"" + known_hash_of_file(place, size) + "\"\nbytes = " + std::to_string(size) +
                "\nplace = " + toml_quoted(place) + "\n",
            0, names_files};
  carried_bytes_ += size;
  const std::string bytes = content_of(place, path, *this);
  return {head + "xxh3 = \"" + hex_digits(xxh3(bytes)) + "\"\n" +
              (is_plain_text(bytes) ? lines_of(bytes) : base64_lines_of(bytes)),
          size, names_files};
}

std::string CarriedFiles::to_toml() const {
  std::string text;
  for (const auto& [name, table] : tables_) text += table.text;
  return text;
}

}  // namespace halocline::bus

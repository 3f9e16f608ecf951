// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/input_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "core/check.h"

namespace halocline {
namespace {

std::string kind_in_words(std::filesystem::file_type type) {
  switch (type) {
    case std::filesystem::file_type::directory:
      return "it is a folder";
    case std::filesystem::file_type::fifo:
      return "it is a pipe";
    case std::filesystem::file_type::socket:
      return "it is a socket";
    default:
      return "it is a device";
  }
}

}  // namespace

std::string why_unreadable(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::none) return error.message();
  if (!std::filesystem::exists(status)) return "there is no such file";
  if (!std::filesystem::is_regular_file(status))
    return kind_in_words(status.type()) + "; allowed is a regular file";
  return std::ifstream(path) ? "" : "it must not be read: " + std::string(std::strerror(errno));
}

void require_input_file(const std::string& path) {
  const std::string why = why_unreadable(path);
  require(why.empty(), "cannot read " + path + ": " + why);
}

std::string absolute_place(const std::string& path) {
  const std::filesystem::path absolute = std::filesystem::absolute(path);
  std::error_code error;
  const auto folder = std::filesystem::canonical(absolute.parent_path(), error);
  return (error ? absolute.lexically_normal() : folder / absolute.filename()).string();
}

std::ifstream open_input(const std::string& path) {
  require_input_file(path);
  return std::ifstream(path, std::ios::binary);
}

}  // namespace halocline

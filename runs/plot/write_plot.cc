// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/atomic_file.h"
#include "runs/plot/plot.h"

namespace halocline::clients {
namespace {

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

File nameless_file() {
  File file(std::tmpfile());
  if (!file) throw std::runtime_error("cannot make a temporary file for gnuplot");
  return file;
}

std::string text_of(std::FILE* file) {
  std::rewind(file);
  std::string text;
  std::array<char, 4096> part{};
  for (std::size_t got = 0; (got = std::fread(part.data(), 1, part.size(), file)) > 0;)
    text.append(part.data(), got);
  return text;
}

// True when a picture is complete: gnuplot does not report a full disk, but only a complete file has its end
// marker.
bool has_end(std::string_view picture, bool is_png) {
  constexpr std::size_t kEndBytes = 64;
  picture.remove_prefix(picture.size() - std::min(kEndBytes, picture.size()));
  return picture.find(is_png ? "IEND" : "</svg>") != std::string_view::npos;
}

}  // namespace

std::string run_gnuplot(const std::string& commands) {
  const File in = nameless_file(), out = nameless_file(), errors = nameless_file();
  if (std::fwrite(commands.data(), 1, commands.size(), in.get()) != commands.size() ||
      std::fflush(in.get()) != 0)
    throw std::runtime_error("cannot write the commands for gnuplot");
  if (lseek(fileno(in.get()), 0, SEEK_SET) != 0) throw std::runtime_error("cannot rewind gnuplot's commands");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(in.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(out.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(errors.get()), STDERR_FILENO);
  std::string program = "gnuplot", defaults = "--default-settings";
  std::array<char*, 3> arguments{program.data(), defaults.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) throw NoGnuplot();
  if (error != 0) throw std::runtime_error(std::string("cannot start gnuplot: ") + std::strerror(error));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error("gnuplot failed: " + text_of(errors.get()));
  return text_of(out.get());
}

void run_gnuplot(const std::string& commands, const std::string& file) {
  const std::string picture = run_gnuplot(commands);
  if (!has_end(picture, file.ends_with(".png")))
    throw std::runtime_error("cannot write " + file + ": gnuplot's picture is cut off; the disk may be full");
  replace_file(file, picture);
}

void write_plot(const Plot& plot, const std::string& file) { run_gnuplot(gnuplot_script(plot, file), file); }

}  // namespace halocline::clients

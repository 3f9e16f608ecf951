// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/input_file.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "core/check.h"

namespace halocline {
namespace {

using ::testing::HasSubstr;

std::string fresh(const std::string& name) {
  const std::string path = ::testing::TempDir() + "input-" + std::to_string(getpid()) + "-" + name;
  std::filesystem::remove(path);
  return path;
}

std::string refusal(const std::string& path) {
  try {
    open_input(path);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "opened";
}

TEST(InputFile, ARegularFileIsOpenedAlsoThroughALink) {
  const std::string path = fresh("text"), link = fresh("link");
  std::ofstream(path) << "depth_m";
  std::filesystem::create_symlink(path, link);
  for (const std::string& name : {path, link}) {
    std::ifstream in = open_input(name);
    std::string word;
    EXPECT_TRUE(in >> word);
    EXPECT_EQ(word, "depth_m");
  }
}

// Nobody writes to the pipe: opening it would wait for ever.
TEST(InputFile, APipeIsRefusedWithoutWaitingForAWriter) {
  const std::string path = fresh("pipe"), link = fresh("link-to-pipe");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  std::filesystem::create_symlink(path, link);
  EXPECT_EQ(refusal(path), "cannot read " + path + ": it is a pipe; allowed is a regular file");
  EXPECT_THAT(refusal(link), HasSubstr("it is a pipe"));
}

TEST(InputFile, FoldersDevicesSocketsAndMissingFilesAreRefusedByName) {
  EXPECT_THAT(refusal(::testing::TempDir()), HasSubstr("it is a folder; allowed is a regular file"));
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("it is a device; allowed is a regular file"));
  EXPECT_THAT(refusal(fresh("nothing")), HasSubstr("there is no such file"));
  EXPECT_THAT(refusal("/dev/null/below"), HasSubstr("cannot read /dev/null/below: "));
  const std::string path = fresh("socket");
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  ASSERT_LT(path.size(), sizeof address.sun_path);
  path.copy(address.sun_path, path.size());
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_THAT(refusal(path), HasSubstr("it is a socket"));
  close(socket);
}

}  // namespace
}  // namespace halocline

// SPDX-License-Identifier: BSD-3-Clause
#include "core/atomic_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace halocline {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public ::testing::Test {
 protected:
  AtomicFileTest() { fs::create_directories(folder_); }
  ~AtomicFileTest() override { fs::remove_all(folder_); }

  std::string content() const {
    std::ostringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }
  std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(folder_), {}); }

  std::string folder_ = ::testing::TempDir() + "halocline-atomic-file-" + std::to_string(getpid()) + "-" +
                        ::testing::UnitTest::GetInstance()->current_test_info()->name();
  std::string path_ = folder_ + "/result.json";
};

TEST_F(AtomicFileTest, ReplacesAllOfTheOldContent) {
  replace_file(path_, "a longer first text");
  replace_file(path_, "second");
  EXPECT_EQ(content(), "second");
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFileTest, KeepsTheOldContentUntilTheCommit) {
  replace_file(path_, "old");
  AtomicFile file(path_);
  std::ofstream(file.temporary_path()) << "new";
  EXPECT_EQ(content(), "old");
  file.commit();
  EXPECT_EQ(content(), "new");
}

TEST_F(AtomicFileTest, LeavesNothingOfAnAbandonedWrite) {
  replace_file(path_, "old");
  {
    AtomicFile file(path_);
    std::ofstream(file.temporary_path()) << "half of the n";
  }
  EXPECT_EQ(content(), "old");
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFileTest, APipeIsWrittenToAndStaysAPipe) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  std::fstream reader(path_);  // for reading and writing: waits for no other end
  replace_file(path_, "text\n");
  EXPECT_TRUE(fs::is_fifo(path_));
  std::string text;
  ASSERT_TRUE(fs::is_fifo(path_) && std::getline(reader, text));
  EXPECT_EQ(text, "text");
  EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFileTest, ALinkStaysOneAndItsFileIsReplaced) {
  replace_file(path_, "old");
  const std::string link = folder_ + "/latest.json";
  fs::create_symlink("result.json", link);
  replace_file(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content(), "new");
}

TEST_F(AtomicFileTest, AFolderThatDoesNotExistIsReportedWithThePath) {
  try {
    replace_file(folder_ + "/none/result.json", "text");
    FAIL() << "must throw";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/none/result.json"), std::string::npos);
  }
}

}  // namespace
}  // namespace halocline

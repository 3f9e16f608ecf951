// SPDX-License-Identifier: BSD-3-Clause
// Linked into each test: ::testing::TempDir() is a folder of this process alone, removed when it ends.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include <unistd.h>

namespace halocline {
namespace {

class ScratchFolder {
 public:
  ScratchFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "halocline-test-XXXXXX").string();
    if (mkdtemp(path.data()) == nullptr) return;  // tests that need it fail by themselves
    path_ = path + "/";
    setenv("TEST_TMPDIR", path_.c_str(), 1);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty() && getpid() == owner_) std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

 private:
  std::string path_;
  pid_t owner_ = getpid();  // children that a test forks leave it
};

const ScratchFolder scratch_folder;

}  // namespace
}  // namespace halocline

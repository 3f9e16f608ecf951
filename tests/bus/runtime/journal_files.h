// SPDX-License-Identifier: BSD-3-Clause
// The files of a journal for one test: none at first, removed at its end.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/recovery/state_journal.h"

namespace halocline::bus::testing {

class JournalFiles {
 public:
  JournalFiles() { remove(); }
  ~JournalFiles() { remove(); }
  JournalFiles(const JournalFiles&) = delete;
  JournalFiles& operator=(const JournalFiles&) = delete;

  // As a process that is started opens it.
  std::unique_ptr<StateJournal> open(std::uint64_t digest = 1) const {
    return std::make_unique<StateJournal>(path_, digest);
  }
  std::string file(int which) const { return path_ + "." + std::to_string(which); }

 private:
  void remove() const {
    for (const int which : {0, 1}) std::remove(file(which).c_str());
  }

  std::string path_ = ::testing::TempDir() + "halocline-state-" + std::to_string(getpid());
};

}  // namespace halocline::bus::testing

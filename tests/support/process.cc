// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/process.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace halocline::testing {

Process::Process(const std::vector<std::string>& command) {
  char path[] = "/tmp/halocline-process-XXXXXX";
  const int output = mkstemp(path);
  if (output < 0) throw std::runtime_error("cannot make a file for a child's output");
  output_path_ = path;
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves nothing behind
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    execv(arguments[0], arguments.data());
    std::perror(arguments[0]);
    _exit(127);
  }
  close(output);
  if (pid_ < 0) throw std::runtime_error("cannot fork");
}

Process::~Process() {
  if (running()) {
    signal(SIGKILL);
    wait();
  }
  std::remove(output_path_.c_str());
}

void Process::signal(int number) const {
  if (status_ < 0) kill(pid_, number);
}

bool Process::running() { return wait(std::chrono::milliseconds(0)) == -1; }

int Process::wait(std::chrono::milliseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (status_ < 0) {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_) {
      status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    } else if (std::chrono::steady_clock::now() >= end) {
      return -1;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
  return status_;
}

std::string Process::output() const {
  std::ostringstream text;
  text << std::ifstream(output_path_).rdbuf();
  return text.str();
}

}  // namespace halocline::testing

// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/thread_pool.h"

#include <exception>
#include <mutex>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "core/check.h"

namespace halocline::bus {
namespace {

constexpr int kMaxThreads = 1024;

// Exception of the lowest index.
class FirstFailure {
 public:
  void note(std::size_t index) {
    const std::lock_guard lock(mutex_);
    if (failure_ && index > index_) return;
    failure_ = std::current_exception();
    index_ = index;
  }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::size_t index_ = 0;
};

}  // namespace

struct ThreadPool::Arena : tbb::task_arena {
  explicit Arena(int threads) : task_arena(threads) {
    // Raises oneTBB's limit: by default it warns about, and does not start, more threads than there are
    // cores.
    static const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, kMaxThreads);
  }
};

ThreadPool::ThreadPool(int threads) {
  require_in_range(threads, 1, kMaxThreads, "threads of a pool");
  if (threads > 1) arena_ = std::make_unique<Arena>(threads);
}

ThreadPool::~ThreadPool() = default;

void ThreadPool::for_each(std::size_t count, const std::function<void(std::size_t)>& body) {
  FirstFailure failure;
  const auto guarded = [&](std::size_t i) {
    try {
      body(i);
    } catch (...) {
      failure.note(i);
    }
  };
  if (arena_) {
    arena_->execute([&] { tbb::parallel_for(std::size_t{0}, count, guarded); });
  } else {
    one_after_the_other(count, guarded);
  }
  failure.rethrow();
}

}  // namespace halocline::bus

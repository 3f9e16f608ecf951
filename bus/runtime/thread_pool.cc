#include "bus/runtime/thread_pool.h"

#include <utility>

#include "core/check.h"

namespace halocline::bus {

ThreadPool::ThreadPool(int threads) {
  require_in_range(threads, 1, 1024, "threads of a pool");
  for (int i = 1; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  begun_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ThreadPool::for_each(std::size_t count, const std::function<void(std::size_t)>& body) {
  {
    const std::lock_guard lock(mutex_);
    body_ = &body;
    count_ = count;
    next_ = 0;
    busy_ = threads_.size();
    ++round_;
  }
  begun_.notify_all();
  take_turns();
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return busy_ == 0; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ThreadPool::work() {
  std::size_t seen = 0;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      begun_.wait(lock, [&] { return stopping_ || round_ != seen; });
      if (stopping_) return;
      seen = round_;
    }
    take_turns();
    const std::lock_guard lock(mutex_);
    if (--busy_ == 0) done_.notify_all();
  }
}

// A body is some hundred microseconds of work: taking turns one by one under the lock costs nothing beside it.
void ThreadPool::take_turns() {
  for (;;) {
    std::size_t turn = 0;
    {
      const std::lock_guard lock(mutex_);
      if (next_ >= count_) return;
      turn = next_++;
    }
    try {
      (*body_)(turn);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_ || turn < failed_at_) {
        failure_ = std::current_exception();
        failed_at_ = turn;
      }
    }
  }
}

}  // namespace halocline::bus

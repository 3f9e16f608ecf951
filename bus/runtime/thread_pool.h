// Thread pool with a parallel for.
//
//   ThreadPool pool(2);
//   pool.for_each(links.size(), [&](std::size_t i) { rows[i] = row_of(links[i]); });
//
// The caller is one of the threads; a pool of one starts none. Bodies share no mutable state, so results do not depend on
// the number of threads. One caller at a time.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace halocline::bus {

class ThreadPool {
 public:
  // `threads` 1..1024, the caller's among them. Throws InvalidArgument otherwise.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  // A ForEach (core/for_each.h). When bodies throw, the rest is still done, and the exception of the lowest index is
  // thrown.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& body);

 private:
  void work();
  void take_turns();

  std::mutex mutex_;
  std::condition_variable begun_, done_;
  const std::function<void(std::size_t)>* body_ = nullptr;
  std::size_t count_ = 0, next_ = 0, busy_ = 0, failed_at_ = 0;
  std::exception_ptr failure_;
  std::size_t round_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace halocline::bus

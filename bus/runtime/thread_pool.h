// SPDX-License-Identifier: BSD-3-Clause
// Thread pool with a parallel for, based on oneTBB: all pools of a process share its threads.
//
//   ThreadPool pool(2);
//   pool.for_each(links.size(), [&](std::size_t i) { rows[i] = row_of(links[i]); });
//
// The caller is one of the threads; a pool of one starts none. The bodies must not share mutable state, so
// that results do not depend on the number of threads. One caller at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "core/for_each.h"

namespace halocline::bus {

class ThreadPool {
 public:
  // `threads` is 1 to 1024, including the caller's. Throws InvalidArgument otherwise.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  // A ForEach (core/for_each.h). When bodies throw, the others are still executed, and the exception of the
  // lowest index is thrown.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& body);
  // Returns for_each() as a value; the pool must outlive it.
  ForEach sharing_out() {
    return [this](std::size_t count, const std::function<void(std::size_t)>& body) { for_each(count, body); };
  }

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;  // null: the caller's thread only
};

}  // namespace halocline::bus

// SPDX-License-Identifier: BSD-3-Clause
// Thread pool with a parallel for, by oneTBB: all pools of a process share its threads.
//
//   ThreadPool pool(2);
//   pool.for_each(links.size(), [&](std::size_t i) { rows[i] = row_of(links[i]); });
//
// The caller is one of the threads; a pool of one starts none. Bodies share no mutable state, so results do
// not depend on the number of threads. One caller at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "core/for_each.h"

namespace halocline::bus {

class ThreadPool {
 public:
  // `threads` 1..1024, the caller's among them. Throws InvalidArgument otherwise.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  // A ForEach (core/for_each.h). When bodies throw, the rest is still done, and the exception of the lowest
  // index is thrown.
  void for_each(std::size_t count, const std::function<void(std::size_t)>& body);
  // The same as a value; the pool must outlive it.
  ForEach sharing_out() {
    return [this](std::size_t count, const std::function<void(std::size_t)>& body) { for_each(count, body); };
  }

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;  // null: the caller alone
};

}  // namespace halocline::bus

// SPDX-License-Identifier: BSD-3-Clause
#include "bathymetry/terrain/wide_trace.h"

#include <array>
#include <bit>
#include <cstddef>

#include "core/vector_clones.h"

namespace halocline::bathymetry {
namespace {

// Number of rays followed at a time. While the lanes of one group compute, the next data of the other groups
// is fetched into the cache.
constexpr int kRaysUnderWay = 64;

// Vectors of N numbers. Comparisons give -1 in the lanes where they hold.
template <int N>
struct Vectors;
#define HALOCLINE_VECTORS(N)                                \
  template <>                                               \
  struct Vectors<(N)> {                                     \
    using Reals [[gnu::vector_size((N)*8)]] = double;       \
    using Integers [[gnu::vector_size((N)*8)]] = long long; \
  }
HALOCLINE_VECTORS(2);
HALOCLINE_VECTORS(4);
HALOCLINE_VECTORS(8);
#undef HALOCLINE_VECTORS

// Shallowest posts of a level's blocks; the posts themselves for level 0.
struct LevelRows {
  const float* first;
  std::size_t row_length;
};

// N rays side by side; names as in grid_trace.cc.
template <int N>
struct Group {
  using Reals = typename Vectors<N>::Reals;
  using Integers = typename Vectors<N>::Integers;

  Reals origin_x, origin_y, origin_z, direction_x, direction_y, direction_z;
  Reals t, end;
  Reals exit_x, exit_y;           // crossings of the boundaries ahead of the block
  Integers first_x, first_y;      // the block's first cell
  Integers size, level;           // cells along the block's side, 2^level
  Integers forward_x, forward_y;  // -1 where the ray goes towards greater coordinates
  Integers busy;                  // -1 where there is a ray
  const float* post[N];           // shallowest post of the block, or first post of the cell
  GridTrace* trace[N];
  int running = N;
};

template <int N>
class WideWalk {
 public:
  WideWalk(const HeightGrid& grid, const ShallowestPyramid& pyramid, std::span<GridTrace* const> traces)
      : grid_(grid), pyramid_(pyramid), traces_(traces) {
    rows_[0] = {grid.posts().data(), static_cast<std::size_t>(grid.geometry().posts_y)};
    for (int level = 1; level <= pyramid.top_level(); ++level)
      rows_[static_cast<std::size_t>(level)] = {pyramid.first(level), pyramid.row_length(level)};
    for (Group<N>& group : groups_) {
      for (int k = 0; k < N; ++k) load_next(group, k);
      for (int k = 0; k < N; ++k) fetch(group, k);
    }
  }

  [[gnu::always_inline]] inline void run() {
    for (bool running = true; running;) {
      running = false;
      for (Group<N>& group : groups_) {
        if (group.running == 0) continue;
        step(group);
        running = true;
      }
    }
  }

 private:
  using Reals = typename Vectors<N>::Reals;
  using Integers = typename Vectors<N>::Integers;

  // Converts integers from 0 to 2^31 to reals: 2^52 + n has n in its last bits. No instruction before AVX-512
  // converts 64 bits. The result is returned by reference because the way in which vectors are returned
  // depends on the instructions that a function may use.
  [[gnu::always_inline]] static inline void to_reals(const Integers& n, Reals& out) {
    constexpr double kTwoTo52 = 0x1p52;
    out = reinterpret_cast<Reals>(n | std::bit_cast<long long>(kTwoTo52)) - kTwoTo52;
  }

  // Loads the next ray that is not decided at once into lane k; leaves it idle when there is none.
  void load_next(Group<N>& group, int k) {
    group.busy[k] = 0;
    while (next_ < traces_.size()) {
      GridTrace& trace = *traces_[next_++];
      trace.result = {};
      if (clears_grid(pyramid_, trace.ray, trace.interval)) continue;
      load(group, k, trace);
      return;
    }
    --group.running;
  }

  void load(Group<N>& group, int k, GridTrace& trace) {
    const GridRay& ray = trace.ray;
    group.trace[k] = &trace;
    group.origin_x[k] = ray.origin_x;
    group.origin_y[k] = ray.origin_y;
    group.origin_z[k] = ray.origin_z_m;
    group.direction_x[k] = ray.direction_x;
    group.direction_y[k] = ray.direction_y;
    group.direction_z[k] = ray.direction_z;
    group.t[k] = trace.interval.begin_m;
    group.end[k] = trace.interval.end_m;
    const bool forward_x = ray.direction_x > 0, forward_y = ray.direction_y > 0;
    const PyramidBlock at = start_block(grid_.geometry(), pyramid_, ray, trace.interval.begin_m);
    group.exit_x[k] = ray.crossing_x((at.i + forward_x) << at.level);
    group.exit_y[k] = ray.crossing_y((at.j + forward_y) << at.level);
    group.first_x[k] = at.i << at.level;
    group.first_y[k] = at.j << at.level;
    group.size[k] = 1 << at.level;
    group.level[k] = at.level;
    group.forward_x[k] = -forward_x;
    group.forward_y[k] = -forward_y;
    group.busy[k] = -1;
  }

  // Prefetches what lane k reads in its next step.
  [[gnu::always_inline]] inline void fetch(Group<N>& group, int k) {
    const long long level = group.level[k];
    const LevelRows& rows = rows_[static_cast<std::size_t>(level)];
    const float* post = rows.first + static_cast<std::size_t>(group.first_x[k] >> level) * rows.row_length +
                        static_cast<std::size_t>(group.first_y[k] >> level);
    group.post[k] = post;
    __builtin_prefetch(post);
    __builtin_prefetch(post + (level == 0 ? rows.row_length : 0));
  }

  [[gnu::always_inline]] inline void step(Group<N>& group);
  [[gnu::always_inline]] inline void clear_cells(Group<N>& group, const Integers& in_cell, const Reals& exit,
                                                 Integers& cleared);
  void decide_cells(Group<N>& group, const Integers& open, const Reals& exit, Integers& cleared);

  const HeightGrid& grid_;
  const ShallowestPyramid& pyramid_;
  std::span<GridTrace* const> traces_;
  std::size_t next_ = 0;
  std::array<LevelRows, 32> rows_ = {};
  std::array<Group<N>, kRaysUnderWay / N> groups_ = {};
};

template <int N>
void WideWalk<N>::step(Group<N>& w) {
  const Reals exit_xy = w.exit_y < w.exit_x ? w.exit_y : w.exit_x;
  const Reals exit = w.end < exit_xy ? w.end : exit_xy;
  const Integers in_cell = w.busy & (w.level == 0), in_block = w.busy & (w.level != 0);

  // Blocks: descend into a quarter unless the ray clears the shallowest post.
  Reals shallowest;
  int cells = 0;
  for (int k = 0; k < N; ++k) {
    shallowest[k] = *w.post[k];
    cells -= static_cast<int>(in_cell[k]);
  }
  const Reals deepest = w.origin_z + w.direction_z * (w.direction_z > 0 ? exit : w.t);
  const Integers descend = in_block & (deepest + kSlackM >= shallowest);
  Integers advance = in_block & ~descend;

  // Cells: examined when enough lanes wait for it.
  if (2 * cells >= w.running) clear_cells(w, in_cell, exit, advance);

  const Integers passed = advance & (exit >= w.end);
  advance &= ~passed;
  w.t = (advance & (w.t < exit)) != 0 ? exit : w.t;

  // Advance across the nearer boundary, and up a level when it is also the parent's.
  const Integers across_x = advance & (w.exit_x <= w.exit_y), across_y = advance & ~across_x;
  const Integers ahead_x = w.first_x + (w.forward_x & w.size), ahead_y = w.first_y + (w.forward_y & w.size);
  const Integers crossed = across_x != 0 ? ahead_x : ahead_y;
  const Integers climb = advance & ((crossed & (2 * w.size - 1)) == 0) &
                         (w.level != static_cast<long long>(pyramid_.top_level()));
  const Integers next_size = w.size + (climb & w.size);
  // The sum is +size or -size: (s ^ -1) - -1 = -s.
  const Integers moved_x = w.first_x + (across_x & ((w.size ^ ~w.forward_x) - ~w.forward_x));
  const Integers moved_y = w.first_y + (across_y & ((w.size ^ ~w.forward_y) - ~w.forward_y));
  const Integers next_x = moved_x & -next_size, next_y = moved_y & -next_size;

  // Boundaries to cross next: the middle lines when descending, else those ahead.
  const Integers half = w.size >> 1;
  const Integers middle_x = w.first_x + half, middle_y = w.first_y + half;
  const Integers line_x = descend != 0 ? middle_x : next_x + (w.forward_x & next_size);
  const Integers line_y = descend != 0 ? middle_y : next_y + (w.forward_y & next_size);
  Reals crossing_x, crossing_y;
  to_reals(line_x, crossing_x);
  to_reals(line_y, crossing_y);
  crossing_x = (crossing_x - w.origin_x) / w.direction_x;
  crossing_y = (crossing_y - w.origin_y) / w.direction_y;
  const Integers beyond_x = descend & (w.t >= crossing_x), beyond_y = descend & (w.t >= crossing_y);

  // A quarter entered beyond the middle line keeps the boundary ahead.
  w.exit_x = beyond_x != 0 ? w.exit_x : crossing_x;
  w.exit_y = beyond_y != 0 ? w.exit_y : crossing_y;
  w.first_x = descend != 0 ? w.first_x + (half & ~(beyond_x ^ w.forward_x)) : next_x;
  w.first_y = descend != 0 ? w.first_y + (half & ~(beyond_y ^ w.forward_y)) : next_y;
  w.size = descend != 0 ? half : next_size;
  w.level += descend - climb;

  for (int k = 0; k < N; ++k) {
    if (passed[k] != 0) load_next(w, k);
  }
  for (int k = 0; k < N; ++k) fetch(w, k);
}

template <int N>
void WideWalk<N>::clear_cells(Group<N>& w, const Integers& in_cell, const Reals& exit, Integers& cleared) {
  const std::size_t row = rows_[0].row_length;
  Reals z00, z01, z10, z11;
  for (int k = 0; k < N; ++k) {
    const float* low = in_cell[k] != 0 ? w.post[k] : rows_[0].first;
    z00[k] = low[0];
    z01[k] = low[1];
    z10[k] = low[row];
    z11[k] = low[row + 1];
  }
  const Reals slope_u0 = z10 - z00, slope_v0 = z01 - z00, twist = (z00 - z10) + (z11 - z01);
  Reals i, j;
  to_reals(w.first_x, i);
  to_reals(w.first_y, j);
  Reals u = w.origin_x + w.direction_x * w.t - i, v = w.origin_y + w.direction_y * w.t - j;
  const Reals zero = {}, one = zero + 1;
  u = u < zero ? zero : u;
  v = v < zero ? zero : v;
  u = one < u ? one : u;
  v = one < v ? one : v;
  const Reals length = exit - w.t;
  const Reals a = (z00 + slope_u0 * u + (slope_v0 + twist * u) * v) - (w.origin_z + w.direction_z * w.t);
  const Reals b =
      (slope_u0 + twist * v) * w.direction_x + (slope_v0 + twist * u) * w.direction_y - w.direction_z;
  const Reals c = twist * w.direction_x * w.direction_y;
  const Reals at_end = a + (b + c * length) * length;
  const Reals least = at_end < a ? at_end : a, sag = (c < zero ? zero : c) * (0.25 * length * length);
  const Integers clears = in_cell & (least - sag > kSlackM);
  cleared |= clears;
  decide_cells(w, in_cell & ~clears, exit, cleared);
}

template <int N>
void WideWalk<N>::decide_cells(Group<N>& w, const Integers& open, const Reals& exit, Integers& cleared) {
  for (int k = 0; k < N; ++k) {
    if (open[k] == 0) continue;
    GridTrace& trace = *w.trace[k];
    const int i = static_cast<int>(w.first_x[k]), j = static_cast<int>(w.first_y[k]);
    trace.result = trace_cell(grid_.cell(i, j), trace.ray, i, j, {w.t[k], exit[k]});
    if (trace.result.end == TraceEnd::kPassed) {
      cleared[k] = -1;
    } else {
      load_next(w, k);
    }
  }
}

void run_sse2(WideWalk<2>& walk) { walk.run(); }
#if HALOCLINE_HAS_X86_VECTORS
[[gnu::target("avx2")]] void run_avx2(WideWalk<4>& walk) { walk.run(); }
[[gnu::target("avx512f,avx512dq,avx512vl")]] void run_avx512(WideWalk<8>& walk) { walk.run(); }
#endif

}  // namespace

VectorUnit widest_vector_unit() {
#if HALOCLINE_HAS_X86_VECTORS
  static const VectorUnit widest = [] {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl")) {
      return VectorUnit::kAvx512;
    }
    return __builtin_cpu_supports("avx2") ? VectorUnit::kAvx2 : VectorUnit::kSse2;
  }();
  return widest;
#else
  return VectorUnit::kSse2;
#endif
}

void trace_grid(const HeightGrid& grid, const ShallowestPyramid& pyramid, std::span<GridTrace* const> traces,
                VectorUnit unit) {
  if (traces.empty()) return;
#if HALOCLINE_HAS_X86_VECTORS
  if (unit == VectorUnit::kAvx512) {
    WideWalk<8> walk(grid, pyramid, traces);
    return run_avx512(walk);
  }
  if (unit == VectorUnit::kAvx2) {
    WideWalk<4> walk(grid, pyramid, traces);
    return run_avx2(walk);
  }
#endif
  (void)unit;
  WideWalk<2> walk(grid, pyramid, traces);
  run_sse2(walk);
}

}  // namespace halocline::bathymetry

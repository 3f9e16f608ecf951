// SPDX-License-Identifier: BSD-3-Clause
#include "bus/runtime/node_process.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <exception>
#include <string_view>

#include <malloc.h>
#include <poll.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "bus/recovery/state_journal.h"
#include "bus/runtime/lockstep_process.h"
#include "bus/runtime/message_batches.h"
#include "bus/runtime/node_command_line.h"
#include "bus/runtime/output_check.h"
#include "bus/runtime/tile_groups.h"
#include "bus/transport/event_log.h"
#include "bus/transport/transport.h"
#include "core/check.h"

namespace halocline::bus {
namespace {

// Set in a signal handler, read by any thread.
std::atomic<bool> stop_signal_seen = false, interrupt_seen = false;
static_assert(std::atomic<bool>::is_always_lock_free);
// Deadline that ends the process if it is still running 0.9 s after the first signal.
std::atomic<bool> has_deadline = false;
std::atomic<int> exit_code_at_deadline = 0;
timer_t deadline_timer;

void on_stop_signal(int number) {
  if (number == SIGINT) interrupt_seen = true;
  if (stop_signal_seen.exchange(true) || !has_deadline) return;
  const itimerspec once{{0, 0}, {0, 900'000'000}};
  timer_settime(deadline_timer, 0, &once, nullptr);
}

// Calls only async-signal-safe functions.
void on_deadline(int) {
  constexpr std::string_view kWords = "stopped in the middle of a step\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kWords.data(), kWords.size());
  _exit(exit_code_at_deadline);
}

void stop_by_deadline(int exit_code) {
  exit_code_at_deadline = exit_code;
  struct sigaction action {};
  action.sa_handler = on_deadline;
  sigaction(SIGALRM, &action, nullptr);
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGALRM;
  has_deadline = timer_create(CLOCK_MONOTONIC, &event, &deadline_timer) == 0;
}

// Longest sleep; a stop requested by other means than a signal is noticed within this time.
constexpr SimDuration kLongestSleep = SimDuration::from_milliseconds(100);
constexpr SimDuration kMemoryPeriod = SimDuration::from_milliseconds(60'000);
// Maximum number of messages dispatched between two steps, so that a flood cannot keep a node from its steps.
constexpr int kMaxMessagesPerTurn = 2000;

// Handles delivered messages when a stop is requested, until the bus has been silent for a moment, as LCM's
// own thread passes on the messages of the socket one by one. Other nodes may never be silent, so it takes at
// most 0.3 s.
void dispatch_until_silent(lcm::LCM& lcm) {
  const SimTime end = steady_now() + SimDuration::from_milliseconds(300);
  while (steady_now() < end && lcm.handleTimeout(100) > 0) {
  }
}

// Repairs after the last step: without it, lost datagrams of the last messages could not be repaired. Lasts
// until nobody has requested anything for kQuiet, or until `end`.
void repair_after_stop(lcm::LCM& lcm, Node& node, Now now, SimTime end) {
  constexpr SimDuration kQuiet = SimDuration::from_milliseconds(250);
  SimTime quiet_since = steady_now(), next = quiet_since;
  while (now.steady < end && (now.steady - quiet_since < kQuiet || node.wants_repair())) {
    if (lcm.handleTimeout(5) > 0) dispatch_waiting(lcm);
    node.set_steady(now.steady = steady_now());
    const bool announces = now.steady >= next;
    if (announces) next = now.steady + SimDuration::from_milliseconds(20);
    if (node.repair_after_stop(now, announces)) quiet_since = now.steady;
  }
}

// Sleeps; a signal ends the sleep.
void sleep_for(SimDuration duration) {
  if (duration <= SimDuration()) return;
  const timespec time{0, duration.nanoseconds()};
  nanosleep(&time, nullptr);
}

// Gives free memory back to the system once a minute, so that the process holds only what the node needs.
void give_back_memory(SimTime steady, SimTime& due) {
  if (steady < due) return;
  due = steady + kMemoryPeriod;
  malloc_trim(0);
}

// Returns the steady time of the next step; at_once() for a node that is due at once.
SimTime wake_time(const Node& node, const TimeSource& time) {
  const Due due = node.due();
  return due.sim == SimTime::at_once() ? due.sim : std::min(due.steady, time.steady_at(due.sim));
}

// Returns the processor time of the process, all threads; POSIX counts microseconds.
SimDuration processor_time() { return SimDuration::from_microseconds(std::clock()); }

// Time of a node's steps. It catches up with its source by slices, between which the node handles messages
// and the process handles signals.
class NodeTime {
 public:
  NodeTime(Node& node, TimeSource& source) : node_(node), source_(source) {}
  const Now& now() const { return now_; }
  SimTime wake() const {
    constexpr SimDuration kPollPeriod = SimDuration::from_milliseconds(10);
    if (halt_.holds()) return std::min(node_.due().steady, now_.steady + kPollPeriod);
    return is_behind_ ? SimTime::at_once() : wake_time(node_, source_);
  }

  void update() {
    now_.steady = steady_now();
    halt_.look(now_.steady, processor_time(), node_.waits_for_repair(), node_.misses_messages());
    const bool restarted = source_.restarted();
    const auto known = source_.now(now_.steady);
    if (known) now_.clock = *known;
    if (known && !(halt_.holds() && now_.sim_known && !restarted)) {
      const bool goes_on = now_.sim_known && !restarted;
      const SimTime begin = goes_on ? std::max(now_.sim, std::min(node_.due().sim, *known)) : *known;
      now_.sim = std::min(*known, begin + slice_);
      now_.sim_known = true;
      is_behind_ = now_.sim < *known;
    }
    const std::int64_t refused = source_.num_refused();
    node_.count_refused_clocks(refused - std::exchange(refused_, refused));
    if (restarted) node_.restart(now_);
  }

  void step_if_due() {
    const Due due = node_.due();
    if (due.steady <= now_.steady || due.sim == SimTime::at_once() ||
        (now_.sim_known && due.sim <= now_.sim)) {
      node_.step(now_);
      adapt_slice(steady_now() - now_.steady);
    }
  }

 private:
  // Halves or doubles the next slice so that a step takes about kAim, given the duration of the last step.
  void adapt_slice(SimDuration took) {
    constexpr SimDuration kAim = SimDuration::from_milliseconds(100);
    constexpr SimDuration kShortest = SimDuration::from_milliseconds(10);
    if (took > kAim) slice_ = std::max(kShortest, SimDuration::from_nanoseconds(slice_.nanoseconds() / 2));
    if (took + took < kAim) slice_ = std::min(kLongestSlice, slice_ * 2);
  }

  static constexpr SimDuration kLongestSlice = SimDuration::from_milliseconds(10'000);
  Node& node_;
  TimeSource& source_;
  Now now_{SimTime(), steady_now(), false};
  Halt halt_{steady_now(), processor_time()};
  bool is_behind_ = false;
  SimDuration slice_ = kLongestSlice;
  std::int64_t refused_ = 0;
};

// Runs the node on a bus of its own, with an identity that is the same in every lockstep run.
int run_in_lockstep(const NodeRun& run, const NodeProgram& program) {
  lcm::LCM memq("memq://");
  const NodeIdentity identity{run.identity.name, session_of(run.scenario.seed, run.identity.name),
                              program.stage};
  const auto node = program.make_node({memq, identity, run.scenario, run.sync_url, true, run.file.get()});
  run_lockstep_participant(*node, run.sync_url, run.scenario, stop_requested);
  return 0;
}

int run_on_transport(const NodeRun& run, const NodeProgram& program, EventLog& log) {
  const std::string url = effective_url(run.lcm_url);
  const auto lcm = open_transport(url);
  if (const std::string warning = receive_buffer_warning(url); !warning.empty()) {
    log.warning("small-receive-buffer", warning);
  }
  std::unique_ptr<StateJournal> journal;
  NodeIdentity identity = run.identity;
  if (!run.journal.empty()) {
    journal = std::make_unique<StateJournal>(run.journal, run.config_digest);
    if (journal->inherited()) identity.session = journal->inherited()->session;  // continues its flows
  }
  const NodeProgram::Context context{*lcm,  identity,       run.scenario,      run.sync_url,
                                     false, run.file.get(), run.config_digest, url};
  if (program.run_otherwise && program.run_otherwise(context)) return 0;
  ReceiveFilter filter(*lcm, url, accepted_hosts(run.scenario.accept, url));  // before any subscription
  const auto time = program.make_time_source ? program.make_time_source(context)
                                             : make_time_source(run.time_source, *lcm, run.identity.name,
                                                                wall_now() - (steady_now() - SimTime()));
  const auto tiles = run.scenario.tile_m > 0 ? std::make_unique<TileGroups>(url, run.scenario)
                                             : std::unique_ptr<TileGroups>();
  const auto node = program.make_node(context);
  node->enable_repair();
  if (journal) node->keep_state_in(std::move(journal));
  if (tiles) {
    require_every_group(*lcm, url);
    tiles->join(tiles->groups_of(node->subscribed()));
    node->set_route([&](std::string_view channel) -> lcm::LCM& { return tiles->carrier_of(channel, *lcm); });
  }
  log.info("started", "url=" + url);
  node->set_clock([&] { return time->now(steady_now()); }, run.scenario.state_lag);
  run_node(*lcm, *node, *time, stop_requested, &filter);
  if (const auto now = time->now(steady_now())) log.set_time(*now);
  return program.finish ? program.finish() : 0;
}

int run_checked(int argc, char** argv, const NodeProgram& program) {
  const auto run = parse_node_command_line(argc, argv, program);
  if (!run) return 0;
  set_log_level(run->log_level);
  stop_by_deadline(program.exit_code_when_cut);
  catch_stop_signals();
  EventLog log(run->identity.name);
  const int exit_code = run->time_source == TimeSourceKind::kLockstep ? run_in_lockstep(*run, program)
                                                                      : run_on_transport(*run, program, log);
  log.info("stopped");
  return exit_code;
}

}  // namespace

void catch_stop_signals() {
  struct sigaction action {};
  action.sa_handler = on_stop_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};  // SIGHUP of a closed terminal; nohup ignores it
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

bool stop_requested() { return stop_signal_seen; }

bool interrupt_requested() { return interrupt_seen; }

// Signals are unblocked only while sleeping, so that none is missed between the check and the sleep.
Readable wait_for_bus(lcm::LCM& lcm, SimTime wake, int other_file) {
  const SimDuration left = std::min(std::max(wake, steady_now()) - steady_now(), kLongestSleep);
  std::array<pollfd, 2> files{{{lcm.getFileno(), POLLIN, 0}, {other_file, POLLIN, 0}}};  // negative: ignored
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGINT);
  sigaddset(&blocked, SIGTERM);
  sigaddset(&blocked, SIGHUP);
  sigprocmask(SIG_BLOCK, &blocked, &before);
  const timespec timeout{0, stop_requested() ? 0 : std::max<long>(left.nanoseconds(), 0)};
  const bool any = ppoll(files.data(), files.size(), &timeout, &before) > 0;
  sigprocmask(SIG_SETMASK, &before, nullptr);
  return {any && files[0].revents != 0, any && files[1].revents != 0};
}

void wait_and_dispatch(lcm::LCM& lcm, SimTime wake) {
  if (!wait_for_bus(lcm, wake).bus) return;
  lcm.handle();
  pollfd bus{lcm.getFileno(), POLLIN, 0};
  for (int i = 1; i < kMaxMessagesPerTurn && poll(&bus, 1, 0) > 0; ++i) lcm.handle();
}

int dispatch_waiting(lcm::LCM& lcm) {
  int handled = 0;
  while (handled < kMaxMessagesPerTurn && lcm.handleTimeout(0) > 0) ++handled;
  return handled;
}

void sleep_precisely() { prctl(PR_SET_TIMERSLACK, 1); }

SimTime wall_now() {
  const auto unix_time = std::chrono::system_clock::now().time_since_epoch();
  return SimTime::from_utime(std::chrono::duration_cast<std::chrono::microseconds>(unix_time).count());
}

SimTime steady_now() {
  static const auto start = std::chrono::steady_clock::now();
  const auto elapsed = std::chrono::steady_clock::now() - start;
  return SimTime::from_nanoseconds(std::chrono::duration_cast<std::chrono::nanoseconds>(elapsed).count());
}

void run_node(lcm::LCM& lcm, Node& node, TimeSource& time, const std::function<bool()>& should_stop,
              ReceiveFilter* filter) {
  NodeTime node_time(node, time);
  sleep_precisely();
  MessageBatches batches;
  SimTime memory_due = steady_now() + kMemoryPeriod;
  bool is_behind = false;
  SimTime emptied = steady_now();  // time at which no message was waiting
  while (!should_stop()) {
    if (filter != nullptr) filter->follow(&node.receives(), time.receives());
    const SimTime wake = node_time.wake();
    const Readable readable = wait_for_bus(lcm, wake, node.ready_file());
    if (readable.other) node.note_due_changed();
    if (readable.bus && !readable.other) {
      const SimTime steady = steady_now();
      sleep_for(std::min(batches.wait_at(steady), std::max(wake, steady) - steady));
    }
    time.set_steady(steady_now(), wall_now(), steady_now() - emptied);
    node.set_steady(steady_now(), is_behind);
    const int handled = dispatch_waiting(lcm);
    is_behind = handled == kMaxMessagesPerTurn;
    if (!is_behind) emptied = steady_now();
    batches.note_handled(handled);
    node_time.update();
    node_time.step_if_due();
    give_back_memory(node_time.now().steady, memory_due);
  }
  const SimTime repaired_until = steady_now() + SimDuration::from_milliseconds(600);
  time.set_steady(steady_now(), wall_now());
  dispatch_until_silent(lcm);
  node_time.update();
  node_time.step_if_due();
  node.stop(node_time.now());
  if (node.has_repair()) repair_after_stop(lcm, node, node_time.now(), repaired_until);
}

int run_node_program(int argc, char** argv, const NodeProgram& program) {
  try {
    const int exit_code = run_checked(argc, argv, program);
    if (output_is_whole()) return exit_code;
    print_failure(program.program, "standard output could not be written");
    return 1;
  } catch (const InvalidArgument& error) {
    print_failure(program.program, error.what());
    return kExitConfiguration;
  } catch (const NetworkError& error) {
    print_failure(program.program, error.what());
    return kExitNetwork;
  } catch (const std::exception& error) {
    print_failure(program.program, error.what());
    return 1;
  }
}

}  // namespace halocline::bus

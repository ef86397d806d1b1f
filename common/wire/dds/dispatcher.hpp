#pragma once
// The one thread on which a program hears from DDS: a WaitSet, never a listener.
//
//   subscribe_imu(*dispatcher, "robot1", [](Result<ImuSample> sample) { ... });   // sensors.hpp
//   dispatcher->every(std::chrono::seconds(1), [] { ... });
//   dispatcher->start();   // callbacks run from now on, one at a time, on the dispatcher's thread
//   dispatcher->stop();    // none runs after this returned
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "common/wire/dds/entity.hpp"
#include "common/wire/dds/participant.hpp"

namespace liloc::wire {

/// Runs a callback. One that throws (out of memory, a library's complaint) must not take the program, nor the
/// callbacks after it, with it: the log has what it threw.
void guarded(const std::function<void()>& callback);

class Dispatcher {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Dispatcher>> create(const Participant& participant);
  ~Dispatcher();
  Dispatcher(const Dispatcher&) = delete;
  Dispatcher& operator=(const Dispatcher&) = delete;

  /// Calls `task` about every `period`. Before `start` alone.
  void every(std::chrono::milliseconds period, std::function<void()> task);
  /// Calls `on_ready` while `condition` (a read condition or an entity with a status mask) is triggered; keeps
  /// `owned` (readers and conditions) until the thread has ended. Before `start` alone.
  [[nodiscard]] Status attach(std::int32_t condition, std::vector<Entity> owned,
                              std::function<void()> on_ready);

  void start();
  /// Waits for the callback in progress; then none runs. Safe to call twice; not from a callback.
  void stop();

  [[nodiscard]] const Participant& participant() const;
  /// Samples that DDS had to drop before this dispatcher's readers saw them, since the start. After `start`;
  /// any thread.
  [[nodiscard]] std::uint64_t samples_lost() const;

 private:
  struct Impl;
  explicit Dispatcher(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc::wire

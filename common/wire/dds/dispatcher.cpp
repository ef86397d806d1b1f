#include "common/wire/dds/dispatcher.hpp"

#include <dds/dds.h>

#include <array>
#include <atomic>
#include <exception>
#include <optional>
#include <thread>

#include "common/base/log.hpp"

namespace liloc::wire {
namespace {

using Clock = std::chrono::steady_clock;

struct Task {
  std::chrono::milliseconds period;
  std::function<void()> run;
  Clock::time_point due;
};

struct Attachment {
  std::function<void()> on_ready;
  std::vector<Entity> owned;
};

}  // namespace

void guarded(const std::function<void()>& callback) {
  try {
    callback();
  } catch (const std::exception& trouble) {
    log::error("a callback failed: {}", trouble.what());
  }
}

struct Dispatcher::Impl {
  explicit Impl(const Participant& seat) : participant(seat) {}

  void loop();
  void run_due_tasks();
  [[nodiscard]] dds_duration_t until_next_task() const;

  Participant participant;
  std::vector<Attachment> attachments;
  std::vector<Task> tasks;
  std::atomic<bool> stopping = false;
  Entity guard, waitset;  // the waitset goes first
  std::thread thread;
};

Dispatcher::Dispatcher(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Dispatcher::~Dispatcher() {
  stop();
}

Result<std::unique_ptr<Dispatcher>> Dispatcher::create(const Participant& participant) {
  auto impl = std::make_unique<Impl>(participant);
  auto waitset = checked(dds_create_waitset(participant.handle()), "waitset");
  if (!waitset) return tl::unexpected(waitset.error());
  auto guard = checked(dds_create_guardcondition(participant.handle()), "guard condition");
  if (!guard) return tl::unexpected(guard.error());
  if (auto attached = check(dds_waitset_attach(waitset->handle(), guard->handle(), -1), "attach of the guard");
      !attached)
    return tl::unexpected(attached.error());
  impl->waitset = std::move(*waitset);
  impl->guard = std::move(*guard);
  return std::unique_ptr<Dispatcher>(new Dispatcher(std::move(impl)));
}

const Participant& Dispatcher::participant() const {
  return impl_->participant;
}

std::uint64_t Dispatcher::samples_lost() const {
  std::uint64_t lost = 0;
  for (const Attachment& attachment : impl_->attachments)
    for (const Entity& entity : attachment.owned) {
      dds_sample_lost_status_t status{};  // what is no reader has none
      if (dds_get_sample_lost_status(entity.handle(), &status) == DDS_RETCODE_OK) lost += status.total_count;
    }
  return lost;
}

void Dispatcher::every(std::chrono::milliseconds period, std::function<void()> task) {
  impl_->tasks.push_back({period, std::move(task), Clock::now() + period});
}

Status Dispatcher::attach(std::int32_t condition, std::vector<Entity> owned, std::function<void()> on_ready) {
  const auto index = static_cast<dds_attach_t>(impl_->attachments.size());
  if (auto attached = check(dds_waitset_attach(impl_->waitset.handle(), condition, index), "attach"); !attached)
    return attached;
  impl_->attachments.push_back({std::move(on_ready), std::move(owned)});
  return {};
}

void Dispatcher::start() {
  if (!impl_->thread.joinable() && !impl_->stopping) impl_->thread = std::thread([this] { impl_->loop(); });
}

void Dispatcher::stop() {
  impl_->stopping = true;
  dds_set_guardcondition(impl_->guard.handle(), true);
  if (impl_->thread.joinable()) impl_->thread.join();
}

dds_duration_t Dispatcher::Impl::until_next_task() const {
  if (tasks.empty()) return DDS_INFINITY;
  auto next = tasks.front().due;
  for (const auto& task : tasks) next = std::min(next, task.due);
  const auto wait = std::chrono::duration_cast<std::chrono::nanoseconds>(next - Clock::now()).count();
  return std::max<dds_duration_t>(wait, 0);
}

void Dispatcher::Impl::run_due_tasks() {
  for (auto& task : tasks) {
    const auto now = Clock::now();
    if (now < task.due) continue;
    task.due = std::max(task.due + task.period, now);  // after a stall: no burst to catch up
    guarded(task.run);
  }
}

void Dispatcher::Impl::loop() {
  std::array<dds_attach_t, 64> ready;
  while (!stopping) {
    const auto count = dds_waitset_wait(waitset.handle(), ready.data(), ready.size(), until_next_task());
    if (count < 0) {
      log::error("{}; this thread ends", check(count, "wait").error().message);
      return;
    }
    const auto triggered = std::min(static_cast<std::size_t>(count), ready.size());
    for (std::size_t i = 0; i < triggered && !stopping; ++i)
      if (ready[i] >= 0) guarded(attachments[static_cast<std::size_t>(ready[i])].on_ready);
    if (!stopping) run_due_tasks();
  }
}

}  // namespace liloc::wire

#include "server/service/request_scheduler.hpp"

#include <pthread.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "common/base/log.hpp"

namespace liloc {
namespace {

/// Of two requests of one client: a later run of the client is newer, and within a run the higher seq.
bool is_newer(const wire::Arrival& a, const wire::Arrival& b) {
  const bool same_run = a.from.publication == b.from.publication && a.from.session == b.from.session;
  return same_run ? a.request.seq > b.request.seq : a.at > b.at;
}

}  // namespace

RequestScheduler::RequestScheduler(ServiceOptions options, ServiceBackend backend, Answer answer)
    : options_(std::move(options)),
      backend_(std::move(backend)),
      answer_(std::move(answer)),
      sessions_(options_.max_rate_hz),
      queue_(options_.queue),
      begun_(static_cast<std::size_t>(options_.workers)) {
  for (std::size_t i = 0; i < begun_.size(); ++i) workers_.emplace_back([this, i] { work(i); });
}

RequestScheduler::~RequestScheduler() {
  stop();
}

void RequestScheduler::submit(wire::Arrival arrival) {
  bool stopping = false, first = false, begins = false, late = false, has_twin = false;
  {
    const std::scoped_lock lock(mutex_);
    stopping = stopping_;
    if (!stopping && !sessions_.admit(arrival)) arrival.problem = Reason::rate_limit;
    if (!stopping && arrival.problem == Reason::none) {
      has_twin = sessions_.has_twin(arrival.from);
      first = !sessions_.is_current(arrival.from);
      begins = sessions_.begins(arrival.from);
      late = sessions_.is_late(arrival.from, arrival.request.seq);
    }
  }
  if (stopping) return refuse(arrival, Reason::shutting_down, "the server stops");
  if (arrival.problem == Reason::rate_limit)
    return refuse(arrival, Reason::rate_limit,
                  fmt::format("more than {} requests a second", options_.max_rate_hz));
  if (arrival.problem != Reason::none) return refuse(arrival, arrival.problem, arrival.text);
  if (has_twin)
    if (const auto held = may_say(twins_, arrival.from.client_id))
      log::warning("two devices ask as {}: neither is located by more than one spot; give each its own id{}",
                   arrival.from.client_id, held_back(*held));
  if (late) return refuse(arrival, Reason::late, "a request as new as this was answered already");
  if (begins && backend_.forget) backend_.forget(arrival.from.client_id);
  if (first && backend_.begin) backend_.begin(arrival.from.client_id, arrival.from.session);

  if (auto older = take_waiting(arrival.from.client_id)) {
    if (is_newer(*older, arrival)) std::swap(*older, arrival);  // they came in the wrong order
    refuse(*older, Reason::superseded, "a newer request took its place");
  }
  if (must_wait(arrival)) {
    const std::scoped_lock lock(mutex_);
    if (!stopping_ && held_.size() < options_.queue) {
      held_.push_back(std::move(arrival));
      return;
    }
  }
  enqueue(std::move(arrival));
}

/// For the ceiling to be seen as of its stamp.
bool RequestScheduler::must_wait(const wire::Arrival& arrival) const {
  if (options_.hold.count() == 0 || !backend_.seen_until) return false;
  const auto seen_ns = backend_.seen_until();
  return seen_ns && arrival.request.match_stamp_ns() > *seen_ns;
}

std::optional<wire::Arrival> RequestScheduler::take_waiting(const std::string& client_id) {
  const std::scoped_lock lock(mutex_);
  const auto held = std::ranges::find_if(held_, [&](const auto& h) { return h.from.client_id == client_id; });
  if (held == held_.end()) return queue_.take(client_id);
  std::optional<wire::Arrival> taken(std::move(*held));
  held_.erase(held);
  return taken;
}

void RequestScheduler::enqueue(wire::Arrival arrival) {
  std::optional<wire::Arrival> displaced;
  bool stopping = false;
  {
    const std::scoped_lock lock(mutex_);
    stopping = stopping_;
    displaced = stopping ? std::move(arrival) : queue_.push(sessions_.waiting(std::move(arrival)));
  }
  may_begin_.notify_one();
  if (!displaced) return;
  if (stopping)
    refuse(*displaced, Reason::shutting_down, "the server stops");
  else
    refuse(*displaced, Reason::overloaded, fmt::format("{} requests are waiting", options_.queue));
}

void RequestScheduler::release() {
  {
    const std::scoped_lock lock(mutex_);
    if (held_.empty()) return;
  }
  const auto seen_ns = backend_.seen_until();  // it asks every LiDAR: once, and outside of the lock
  const auto now = std::chrono::steady_clock::now();
  std::vector<wire::Arrival> due;
  {
    const std::scoped_lock lock(mutex_);
    std::erase_if(held_, [&](wire::Arrival& held) {
      if (seen_ns && held.request.match_stamp_ns() > *seen_ns && now - held.at < options_.hold) return false;
      due.push_back(std::move(held));
      return true;
    });
  }
  for (auto& arrival : due) {
    tell(Stage::hold, arrival.at);
    enqueue(std::move(arrival));
  }
}

void RequestScheduler::tell(Stage stage, std::chrono::steady_clock::time_point since) const {
  if (backend_.on_stage)
    backend_.on_stage(stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count());
}

void RequestScheduler::work(std::size_t worker) {
  pthread_setname_np(pthread_self(), "worker");  // as `top -H` shows it
  std::unique_lock lock(mutex_);
  for (;;) {
    std::optional<Waiting> begun;
    may_begin_.wait(lock, [&] {
      begun = queue_.begin();
      return begun || (stopping_ && queue_.empty());
    });
    if (!begun) return;
    const auto start = std::chrono::steady_clock::now();
    begun_[worker] = start;
    lock.unlock();
    work_on(begun->arrival);
    lock.lock();
    begun_[worker].reset();
    queue_.end(*begun, std::chrono::steady_clock::now() - start);
    may_begin_.notify_all();
  }
}

void RequestScheduler::work_on(const wire::Arrival& arrival) {
  SpotReply reply;
  tell(Stage::wait, arrival.at);
  const auto begun = std::chrono::steady_clock::now();
  try {
    reply = backend_.locate(arrival.request);
  } catch (const std::exception& error) {  // a worker must not take the server with it
    if (const auto held = may_say(failures_, arrival.from.client_id))
      log::error("request {} of {}: {}{}", arrival.request.seq, arrival.from.client_id, error.what(),
                 held_back(*held));
    reply = refusal(arrival.request, Reason::not_found, fmt::format("internal error: {}", error.what()));
  }
  if (backend_.on_located) backend_.on_located(arrival.from.client_id, arrival.from.session);
  tell(Stage::work, begun);
  bool goes_on = false;
  {
    const std::scoped_lock lock(mutex_);
    sessions_.answered(arrival, reply);
    goes_on = sessions_.goes_on(arrival.from);
  }
  finish(arrival, std::move(reply));
  // The client left or began anew meanwhile: what this request and its answer have left behind is nobody's. A
  // run that came back with another writer has taken it up.
  if (!goes_on && backend_.forget) backend_.forget(arrival.from.client_id);
}

std::optional<std::uint64_t> RequestScheduler::may_say(SourceLimit& lines, const std::string& of) {
  const std::scoped_lock lock(mutex_);
  return lines.pass(of, std::chrono::steady_clock::now());
}

void RequestScheduler::refuse(const wire::Arrival& arrival, Reason reason, std::string text) {
  if (const auto held = may_say(refusals_, fmt::format("{} {}", arrival.from.client_id, name_of(reason))))
    log::debug("request {} of {} refused: {}: {}{}", arrival.request.seq, arrival.from.client_id,
               name_of(reason), text, held_back(*held));
  finish(arrival, refusal(arrival.request, reason, std::move(text)));
}

void RequestScheduler::finish(const wire::Arrival& arrival, SpotReply reply) {
  reply.latency_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - arrival.at).count();
  reply.request_sent_ns = arrival.request.sent_ns;
  if (backend_.ceiling_now) {
    reply.server_received_ns = backend_.ceiling_now(arrival.at);
    reply.server_sent_ns = backend_.ceiling_now(std::chrono::steady_clock::now());
  }
  ++answered_;
  if (reply.status == SpotStatus::verified) ++verified_;
  if (reply.status == SpotStatus::refused) ++refused_;
  if (backend_.on_answer) backend_.on_answer(reply);
  answer_(arrival.from, std::move(reply));
}

void RequestScheduler::client_left(const std::string& client_id) {
  {
    const std::scoped_lock lock(mutex_);
    sessions_.forget_client(client_id);
  }
  if (const auto waiting = take_waiting(client_id)) refuse(*waiting, Reason::superseded, "the client has left");
  if (backend_.forget) backend_.forget(client_id);
}

void RequestScheduler::publication_gone(std::uint64_t publication) {
  const std::scoped_lock lock(mutex_);
  sessions_.forget_publication(publication);
}

bool RequestScheduler::idle() const {
  const std::scoped_lock lock(mutex_);
  return queue_.empty();
}

void RequestScheduler::stop() {
  std::vector<wire::Arrival> displaced;
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    for (wire::Arrival& held : std::exchange(held_, {}))
      if (auto least = queue_.push(sessions_.waiting(std::move(held)))) displaced.push_back(std::move(*least));
  }
  may_begin_.notify_all();
  for (const auto& arrival : displaced) refuse(arrival, Reason::shutting_down, "the server stops");
  for (auto& worker : workers_)
    if (worker.joinable()) worker.join();
}

double RequestScheduler::longest_work_s() const {
  const auto now = std::chrono::steady_clock::now();
  double longest_s = 0;
  for (const auto& begun : begun_)
    if (begun) longest_s = std::max(longest_s, std::chrono::duration<double>(now - *begun).count());
  return longest_s;
}

ServiceCounters RequestScheduler::counters() const {
  const std::scoped_lock lock(mutex_);
  return {answered_,
          verified_,
          refused_,
          static_cast<std::uint32_t>(held_.size() + queue_.size()),
          sessions_.clients(SpotStatus::verified),
          sessions_.clients(SpotStatus::provisional),
          sessions_.clients(SpotStatus::refused),
          longest_work_s()};
}

}  // namespace liloc

#pragma once
// Between the network and the localizer: admits requests, keeps them in a bounded queue, has workers answer
// them. Whatever happens to a request, it is answered exactly once.
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "common/base/line_limit.hpp"
#include "server/service/request_queue.hpp"
#include "server/service/service_options.hpp"
#include "server/service/sessions.hpp"

namespace liloc {

struct ServiceCounters {
  std::uint64_t answered = 0, verified = 0, refused = 0;  ///< since the start; answered counts every reply
  std::uint32_t queued = 0;                               ///< waiting now, held ones included
  /// Clients by the localizer's last answer; those without one are in none.
  std::uint32_t clients_verified = 0, clients_provisional = 0, clients_refused = 0;
  double longest_work_s = 0;  ///< of the requests in work now, since the first of them was begun
};

class RequestScheduler {
 public:
  using Answer = std::function<void(const wire::Sender&, SpotReply)>;

  /// `answer` is called from any of the scheduler's threads and from `submit`; never while a lock is held.
  RequestScheduler(ServiceOptions options, ServiceBackend backend, Answer answer);
  ~RequestScheduler();
  RequestScheduler(const RequestScheduler&) = delete;
  RequestScheduler& operator=(const RequestScheduler&) = delete;

  /// Never blocks for long. Any thread.
  void submit(wire::Arrival arrival);
  /// Sends on the held requests whose time has come: that are ready, or have waited long enough. Any thread.
  void release();
  void client_left(const std::string& client_id);
  void publication_gone(std::uint64_t publication);
  /// Refuses new requests, finishes what waits, joins the workers. Safe to call twice.
  void stop();

  [[nodiscard]] ServiceCounters counters() const;
  /// Nobody waits for a worker: there is time for work that nobody asked for. Any thread, also a worker.
  [[nodiscard]] bool idle() const;

 private:
  void work(std::size_t worker);
  [[nodiscard]] double longest_work_s() const;
  void enqueue(wire::Arrival arrival);
  [[nodiscard]] bool must_wait(const wire::Arrival& arrival) const;
  [[nodiscard]] std::optional<wire::Arrival> take_waiting(const std::string& client_id);
  void tell(Stage stage, std::chrono::steady_clock::time_point since) const;
  void work_on(const wire::Arrival& arrival);
  [[nodiscard]] std::optional<std::uint64_t> may_say(SourceLimit& lines, const std::string& of);
  void refuse(const wire::Arrival& arrival, Reason reason, std::string text);
  void finish(const wire::Arrival& arrival, SpotReply reply);

  const ServiceOptions options_;
  const ServiceBackend backend_;
  const Answer answer_;
  mutable std::mutex mutex_;  // guards what follows, down to stopping_
  std::condition_variable
      may_begin_;  // a request is new, a client's last one was answered, or the scheduler stops
  Sessions sessions_;
  std::deque<wire::Arrival> held_;
  RequestQueue queue_;
  SourceLimit refusals_, failures_, twins_;  // lines of the log, by client (and reason)
  std::vector<std::optional<std::chrono::steady_clock::time_point>> begun_;  ///< by worker, while it is at work
  bool stopping_ = false;
  std::atomic<std::uint64_t> answered_ = 0, verified_ = 0, refused_ = 0;
  std::vector<std::thread> workers_;
};

}  // namespace liloc

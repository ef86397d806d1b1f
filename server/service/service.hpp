#pragma once
// Clients' requests over DDS, answered.
//
//   auto service = Service::create(dispatcher, {.workers = 2}, {.locate = ..., .forget = ..., .seen_until =
//   ...}); dispatcher.start();
//   ...
//   service->stop();     // refuses new requests, finishes what waits
//   dispatcher.stop();
#include <memory>

#include "common/wire/spots/server_link.hpp"
#include "server/service/request_scheduler.hpp"

namespace liloc {

class Service {
 public:
  /// Before the dispatcher starts; the dispatcher must be stopped before the service goes. Errors: an option
  /// out of range, DDS.
  [[nodiscard]] static Result<std::unique_ptr<Service>> create(wire::Dispatcher& dispatcher,
                                                               const ServiceOptions& options,
                                                               ServiceBackend backend);
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// A ceiling frame came: held requests may be ready. Any thread.
  void poke() { scheduler_.release(); }
  void stop() { scheduler_.stop(); }

  [[nodiscard]] ServiceCounters counters() const { return scheduler_.counters(); }
  /// Nobody waits for a worker. Any thread.
  [[nodiscard]] bool idle() const { return scheduler_.idle(); }
  [[nodiscard]] std::size_t clients() const { return link_->clients(); }

 private:
  Service(const ServiceOptions& options, ServiceBackend backend);

  std::unique_ptr<wire::ServerLink> link_;
  RequestScheduler scheduler_;  // after the link, which its workers use: it stops first
};

}  // namespace liloc

#include "server/service/service.hpp"

#include "common/base/line_limit.hpp"
#include "common/base/log.hpp"

namespace liloc {
namespace {

/// Clients come and go as they like, and under any name. For the dispatcher's thread.
class Comings {
 public:
  void say(const std::string& id, const char* what) {
    if (const auto held = limit_.pass(id, std::chrono::steady_clock::now()))
      log::info("client {} {}{}", id, what, held_back(*held));
  }

 private:
  SourceLimit limit_;
};

}  // namespace

Service::Service(const ServiceOptions& options, ServiceBackend backend)
    : scheduler_(options, std::move(backend), [this](const wire::Sender& to, SpotReply reply) {
        if (auto sent = link_->reply(to, std::move(reply)); !sent) log::debug("{}", sent.error().message);
      }) {}

Result<std::unique_ptr<Service>> Service::create(wire::Dispatcher& dispatcher, const ServiceOptions& options,
                                                 ServiceBackend backend) {
  const auto valid = options.validated();
  if (!valid) return tl::unexpected(valid.error());
  std::unique_ptr<Service> service(new Service(*valid, std::move(backend)));
  RequestScheduler* scheduler = &service->scheduler_;
  const auto here = std::make_shared<Comings>(), left = std::make_shared<Comings>();
  auto link = wire::ServerLink::create(
      dispatcher, {.server_id = valid->server_id, .max_clients = valid->max_clients},
      {.on_request = [scheduler](wire::Arrival arrival) { scheduler->submit(std::move(arrival)); },
       .on_join = [here](const std::string& id) { here->say(id, "is here"); },
       .on_leave =
           [scheduler, left](const std::string& id) {
             left->say(id, "has left");
             scheduler->client_left(id);
           },
       .on_gone = [scheduler](std::uint64_t publication) { scheduler->publication_gone(publication); }});
  if (!link) return tl::unexpected(link.error());
  service->link_ = std::move(*link);
  dispatcher.every(std::chrono::milliseconds(10), [scheduler] { scheduler->release(); });
  return service;
}

}  // namespace liloc

#include "server/service/service.hpp"

#include "common/base/log.hpp"

namespace liloc {

Service::Service(const ServiceOptions& options, ServiceBackend backend)
    : desk_(options, std::move(backend), [this](const wire::Sender& to, SpotReply reply) {
        if (auto sent = link_->reply(to, std::move(reply)); !sent) log::debug("{}", sent.error().message);
      }) {}

Result<std::unique_ptr<Service>> Service::create(wire::Dispatcher& dispatcher, const ServiceOptions& options,
                                                 ServiceBackend backend) {
  const auto valid = options.validated();
  if (!valid) return tl::unexpected(valid.error());
  std::unique_ptr<Service> service(new Service(*valid, std::move(backend)));
  Desk* desk = &service->desk_;
  auto link = wire::ServerLink::create(
      dispatcher, {.server_id = valid->server_id, .max_clients = valid->max_clients},
      {.on_request = [desk](wire::Arrival arrival) { desk->submit(std::move(arrival)); },
       .on_join = [](const std::string& id) { log::info("client {} is here", id); },
       .on_leave =
           [desk](const std::string& id) {
             log::info("client {} has left", id);
             desk->client_left(id);
           }});
  if (!link) return tl::unexpected(link.error());
  service->link_ = std::move(*link);
  dispatcher.every(std::chrono::milliseconds(10), [desk] { desk->release(); });
  return service;
}

}  // namespace liloc

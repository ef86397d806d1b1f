#include "client/api/network.hpp"

#include <condition_variable>

#include "common/base/log.hpp"

namespace liloc::client {
namespace {

constexpr auto kLookEvery = std::chrono::milliseconds(500);  // at the address; by hand

}  // namespace

Network::Network(wire::DomainOptions seat, std::string client_id, Callbacks callbacks)
    : seat_(std::move(seat)),
      client_id_(std::move(client_id)),
      callbacks_(std::move(callbacks)),
      addresses_([interface = seat_.interface] { return wire::addresses_of(interface); }) {}

Network::~Network() {
  stop();
}

Result<std::unique_ptr<Network>> Network::join(wire::DomainOptions seat, std::string client_id,
                                               Callbacks callbacks) {
  std::unique_ptr<Network> network(new Network(std::move(seat), std::move(client_id), std::move(callbacks)));
  if (const Status opened = network->open(); !opened) return tl::unexpected(opened.error());
  return network;
}

Status Network::open() {
  const std::scoped_lock lock(mutex_);
  auto participant = wire::Participant::create(seat_);
  if (!participant) return tl::unexpected(participant.error());
  auto dispatcher = wire::Dispatcher::create(*participant);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  auto link = wire::ClientLink::create(**dispatcher, client_id_, callbacks_.link, session_);
  if (!link) return tl::unexpected(link.error());
  // What cannot be read of a status says nothing of the codes; replies tell of another version.
  const Status subscribed =
      wire::subscribe_status(**dispatcher, [this](const Result<wire::ServerStatus>& status) {
        if (status && callbacks_.on_status) callbacks_.on_status(*status);
      });
  if (!subscribed) return subscribed;
  for (const auto& [period, task] : callbacks_.tasks) (*dispatcher)->every(period, task);
  participant_ = std::move(*participant);
  dispatcher_ = std::move(*dispatcher);
  link_ = std::move(*link);
  session_ = link_->session();
  return {};
}

void Network::start() {
  dispatcher_->start();
  keeper_ = std::jthread([this](const std::stop_token& stop) { keep(stop); });
}

void Network::stop() {
  keeper_ = {};
  if (dispatcher_) dispatcher_->stop();
}

void Network::leave() {
  if (dispatcher_) dispatcher_->stop();
  const std::scoped_lock lock(mutex_);
  link_.reset();
  dispatcher_.reset();
  participant_.reset();
}

void Network::keep(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  while (!stop.stop_requested()) {
    wake.wait_for(lock, stop, kLookEvery, [] { return false; });
    if (addresses_.changed() || away_) rejoin();
  }
}

void Network::rejoin() {
  if (!away_) {
    log::warning("{}: the address on {} has changed: joining the network anew", client_id_, seat_.interface);
    leave();
    if (callbacks_.link.on_server) callbacks_.link.on_server(false);
  }
  const Status opened = open();
  if (!opened && !away_) log::warning("{}: {}; it is tried again", client_id_, opened.error().message);
  away_ = !opened;
  if (opened) dispatcher_->start();
}

Status Network::send(const SpotRequest& request) {
  const std::scoped_lock lock(mutex_);
  if (!link_) return fail("not on the network; the request {} was not sent", request.seq);
  return link_->send(request);
}

void Network::announce() {
  link_->announce();
}

}  // namespace liloc::client

#include "client/api/network.hpp"

#include <condition_variable>
#include <utility>

#include "common/base/log.hpp"
#include "common/wire/dds/shared_domain.hpp"

namespace liloc::client {
namespace {

constexpr auto kLookEvery = std::chrono::milliseconds(500);  // at the address; by hand

}  // namespace

Network::Network(wire::DomainOptions seat, std::string client_id, Callbacks callbacks,
                 wire::AddressWatch::Addresses addresses)
    : seat_(std::move(seat)),
      client_id_(std::move(client_id)),
      callbacks_(std::move(callbacks)),
      addresses_(addresses ? std::move(addresses)
                           : [interface = seat_.interface] { return wire::addresses_of(interface); }) {}

Network::~Network() {
  stop();
}

Result<std::unique_ptr<Network>> Network::join(wire::DomainOptions seat, std::string client_id,
                                               Callbacks callbacks, wire::AddressWatch::Addresses addresses) {
  std::unique_ptr<Network> network(
      new Network(std::move(seat), std::move(client_id), std::move(callbacks), std::move(addresses)));
  if (const Status opened = network->open(); !opened) return tl::unexpected(opened.error());
  return network;
}

wire::ClientCallbacks Network::link_callbacks() {
  wire::ClientCallbacks link = callbacks_.link;
  link.on_server = [this](bool matched) {
    reached_ = matched;
    if (callbacks_.link.on_server) callbacks_.link.on_server(matched);
  };
  return link;
}

Status Network::open() {
  const std::scoped_lock lock(mutex_);
  auto participant = wire::Participant::create(seat_);
  if (!participant) return tl::unexpected(participant.error());
  auto dispatcher = wire::Dispatcher::create(*participant);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  auto link = wire::ClientLink::create(**dispatcher, client_id_, link_callbacks(), session_);
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
    if (addresses_.changed(reached_) || away_) rejoin();
    if (callbacks_.look) wire::guarded(callbacks_.look);
  }
}

void Network::rejoin() {
  if (!away_) {
    log::warning("{}: the address on {} has changed: joining the network anew", client_id_, seat_.interface);
    leave();
    reached_ = false;
    if (callbacks_.link.on_server) callbacks_.link.on_server(false);
    if (wire::domain_is_held(seat_.domain) && !std::exchange(held_told_, true))
      log::error(
          "{}: other DDS participants of this process keep domain {} on the address before: start the program "
          "again",
          client_id_, seat_.domain);
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

#include "proto-tests/faults/bad_network.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>

namespace liloc::faults {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestFrame = 2048;  // the interfaces' MTU is 1500
constexpr std::size_t kMostLate = 20'000;    // 5 s of a site's streams at 200 ms; what is more is lost; by hand
constexpr int kReadAtOnce = 64;              // of one host before the others have their turn; by hand
constexpr auto kLongestWait = 20ms;          // until a stop is noticed; by hand

bool for_all(const std::uint8_t* frame) {
  return (frame[0] & 1U) != 0;  // IEEE 802: the group bit
}

}  // namespace

Result<std::unique_ptr<BadNetwork>> BadNetwork::create(const std::vector<std::string>& names,
                                                       std::uint64_t seed) {
  std::unique_ptr<BadNetwork> network(new BadNetwork(seed));
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto host = NetworkHost::create(names[i], address(i));
    if (!host) return tl::unexpected(host.error());
    network->hosts_.push_back(std::move(*host));
  }
  network->weather_.resize(names.size());
  network->counters_.resize(names.size());
  network->thread_ = std::jthread([self = network.get()](const std::stop_token& stop) { self->carry(stop); });
  return network;
}

std::string BadNetwork::address(std::size_t host) {
  return fmt::format("10.77.0.{}", host + 1);
}

std::size_t BadNetwork::index_of(const std::string& name) const {
  const auto found = std::ranges::find_if(hosts_, [&](const auto& host) { return host->name() == name; });
  return static_cast<std::size_t>(found - hosts_.begin());
}

NetworkHost& BadNetwork::host(const std::string& name) {
  return *hosts_.at(index_of(name));
}

void BadNetwork::set(const std::string& name, const Weather& weather) {
  const std::scoped_lock lock(mutex_);
  weather_.at(index_of(name)) = weather;
}

void BadNetwork::carry(const std::stop_token& stop) {
  std::vector<pollfd> wires;
  for (const auto& host : hosts_) wires.push_back({host->wire(), POLLIN, 0});
  while (!stop.stop_requested()) {
    poll(wires.data(), wires.size(), wait_ms());
    for (std::size_t i = 0; i < wires.size(); ++i)
      if ((wires[i].revents & POLLIN) != 0) read_from(i);
    deliver_due();
  }
}

int BadNetwork::wait_ms() const {
  if (late_.empty()) return static_cast<int>(kLongestWait.count());
  const auto until = std::chrono::ceil<std::chrono::milliseconds>(late_.top().due - Clock::now());
  return static_cast<int>(std::clamp<std::chrono::milliseconds>(until, 0ms, kLongestWait).count());
}

void BadNetwork::read_from(std::size_t host) {
  std::array<std::uint8_t, kLongestFrame> frame{};
  for (int i = 0; i < kReadAtOnce; ++i) {
    const ssize_t size = read(hosts_[host]->wire(), frame.data(), frame.size());
    if (size < 14) return;  // nothing waits; a header of Ethernet has 14 bytes
    for (std::size_t to = 0; to < hosts_.size(); ++to)
      if (to != host && (for_all(frame.data()) ||
                         std::equal(hosts_[to]->mac().begin(), hosts_[to]->mac().end(), frame.data())))
        pass(host, to, frame.data(), static_cast<std::size_t>(size));
  }
}

void BadNetwork::pass(std::size_t from, std::size_t to, const std::uint8_t* frame, std::size_t size) {
  std::unique_lock lock(mutex_);
  const Weather a = weather_[from], b = weather_[to];
  lock.unlock();
  std::uniform_real_distribution<double> share(0, 1), either_way(-1, 1);
  const double loss_draws[] = {share(random_), share(random_)};
  const double delay_ms =
      a.delay_ms + b.delay_ms + a.jitter_ms * either_way(random_) + b.jitter_ms * either_way(random_);
  const bool lost =
      a.cut || b.cut || loss_draws[0] < a.loss || loss_draws[1] < b.loss || late_.size() >= kMostLate;
  count(from, to, lost);
  if (lost) return;
  if (delay_ms <= 0 && late_.empty()) return deliver(to, frame, size);
  const auto delay = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double, std::milli>(std::max(delay_ms, 0.0)));
  late_.push({Clock::now() + delay, order_++, to, {frame, frame + size}});
}

void BadNetwork::count(std::size_t from, std::size_t to, bool lost) {
  const std::scoped_lock lock(mutex_);
  for (const std::size_t host : {from, to}) ++(lost ? counters_[host].lost : counters_[host].carried);
}

BadNetwork::Counters BadNetwork::counters(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  return counters_.at(index_of(name));
}

/// What an interface does not take is lost there, as on a card.
void BadNetwork::deliver(std::size_t to, const std::uint8_t* frame, std::size_t size) {
  (void)!write(hosts_[to]->wire(), frame, size);
}

void BadNetwork::deliver_due() {
  const auto now = Clock::now();
  while (!late_.empty() && late_.top().due <= now) {
    deliver(late_.top().to, late_.top().frame.data(), late_.top().frame.size());
    late_.pop();
  }
}

}  // namespace liloc::faults

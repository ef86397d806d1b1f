#pragma once
// A switch between hosts of our own that loses, delays and reorders what passes, as its owner wishes.
#include <chrono>
#include <queue>
#include <random>
#include <vector>

#include "proto-tests/faults/network_host.hpp"

namespace liloc::faults {

/// What a host's link does to each frame of Ethernet, in either direction.
struct Weather {
  double loss = 0;       ///< share that is lost, 0..1
  double delay_ms = 0;   ///< one way
  double jitter_ms = 0;  ///< each frame is up to so much earlier or later: they overtake each other
  bool cut = false;      ///< nothing passes
};

/// Thread-safe. All links start fair. What happens to a frame follows from the seed and the order of frames.
class BadNetwork {
 public:
  /// Hosts named so, at 10.77.0.1, .2, ... Errors: the system does not permit it.
  [[nodiscard]] static Result<std::unique_ptr<BadNetwork>> create(const std::vector<std::string>& names,
                                                                  std::uint64_t seed);
  ~BadNetwork() = default;
  BadNetwork(const BadNetwork&) = delete;
  BadNetwork& operator=(const BadNetwork&) = delete;

  /// A name of `create`.
  [[nodiscard]] NetworkHost& host(const std::string& name);
  void set(const std::string& name, const Weather& weather);
  [[nodiscard]] static std::string address(std::size_t host);

  struct Counters {
    std::uint64_t carried = 0, lost = 0;  ///< frames of Ethernet
  };
  /// Of what a host sent and was sent.
  [[nodiscard]] Counters counters(const std::string& name);

 private:
  struct Late {
    std::chrono::steady_clock::time_point due;
    std::uint64_t order;  ///< of equal times the first comes first
    std::size_t to;
    std::vector<std::uint8_t> frame;
    bool operator>(const Late& other) const { return due != other.due ? due > other.due : order > other.order; }
  };
  explicit BadNetwork(std::uint64_t seed) : random_(seed) {}
  void carry(const std::stop_token& stop);
  void read_from(std::size_t host);
  void pass(std::size_t from, std::size_t to, const std::uint8_t* frame, std::size_t size);
  void deliver(std::size_t to, const std::uint8_t* frame, std::size_t size);
  void count(std::size_t from, std::size_t to, bool lost);
  void deliver_due();
  [[nodiscard]] int wait_ms() const;
  [[nodiscard]] std::size_t index_of(const std::string& name) const;

  std::vector<std::unique_ptr<NetworkHost>> hosts_;
  std::mutex mutex_;
  std::vector<Weather> weather_;  ///< by host, as is the next; guarded by the mutex
  std::vector<Counters> counters_;
  std::mt19937_64 random_;  ///< of the thread alone, as is the next
  std::priority_queue<Late, std::vector<Late>, std::greater<>> late_;
  std::uint64_t order_ = 0;
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace liloc::faults

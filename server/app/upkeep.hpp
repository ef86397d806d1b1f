#pragma once
#include <cstddef>
#include <functional>
#include <thread>

namespace liloc {

/// What a server does beside the requests, on a thread of its own, until it goes: builds the room's indices as
/// long as there is anyone who might ask, gives memory back when clients have left, and writes down what is to
/// outlive a restart.
class Upkeep {
 public:
  struct Duties {
    std::function<std::size_t()> clients;
    std::function<void()> prepare;        ///< the room's indices; may throw
    std::function<void()> save_sessions;  ///< each second
    std::function<void()> save_learned;   ///< each minute
  };
  explicit Upkeep(Duties duties);
  ~Upkeep() = default;
  Upkeep(const Upkeep&) = delete;
  Upkeep& operator=(const Upkeep&) = delete;

 private:
  void keep(const std::stop_token& stop);

  const Duties duties_;
  std::jthread thread_;  ///< last: it ends before what it uses
};

}  // namespace liloc

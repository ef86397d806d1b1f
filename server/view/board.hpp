#pragma once
// What every viewer is shown, in parts, each replaced by its newer one. A viewer that reads slowly misses what
// was replaced meanwhile: it holds up nobody, and nothing is queued for it.
#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace liloc::view {

enum class Part : std::uint8_t { site, now, moving, room, trails, charts, log };
constexpr std::size_t kParts = 7;

struct Message {
  std::string bytes;
  bool binary = false;  ///< else UTF-8
};

/// Not thread-safe.
class Board {
 public:
  /// What one viewer has been sent.
  class Seen {
    friend class Board;
    std::array<std::uint64_t, kParts> version_{};  ///< of each part
    std::array<std::uint64_t, kParts> turn_{};     ///< when each part was last sent to this viewer
    std::uint64_t turns_ = 0;
  };

  void put(Part part, Message message);
  void clear();
  /// The part to send next, which then counts as seen; null where all was seen. Of those that are new the one
  /// that was not sent for longest, so that a slow viewer gets each in turn.
  [[nodiscard]] std::shared_ptr<const Message> next(Seen& seen) const;

 private:
  struct Posted {
    std::shared_ptr<const Message> message;
    std::uint64_t version = 0;
  };
  std::array<Posted, kParts> parts_;
};

}  // namespace liloc::view

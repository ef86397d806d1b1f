#include "server/view/board.hpp"

namespace liloc::view {

void Board::put(Part part, Message message) {
  Posted& posted = parts_.at(static_cast<std::size_t>(part));
  posted.message = std::make_shared<const Message>(std::move(message));
  ++posted.version;
}

void Board::clear() {
  for (Posted& posted : parts_) posted.message.reset();
}

std::shared_ptr<const Message> Board::next(Seen& seen) const {
  std::size_t first = kParts;
  for (std::size_t i = 0; i < kParts; ++i)
    if (parts_.at(i).message && seen.version_.at(i) < parts_.at(i).version &&
        (first == kParts || seen.turn_.at(i) < seen.turn_.at(first)))
      first = i;
  if (first == kParts) return nullptr;
  seen.version_.at(first) = parts_.at(first).version;
  seen.turn_.at(first) = ++seen.turns_;
  return parts_.at(first).message;
}

}  // namespace liloc::view

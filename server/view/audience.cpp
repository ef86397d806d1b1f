#include "server/view/audience.hpp"

#include <algorithm>
#include <exception>

#include "common/base/log.hpp"
#include "server/view/page_server.hpp"
#include "server/view/viewer.hpp"

namespace liloc::view {
namespace {

constexpr std::chrono::milliseconds kEvery{200};  // ceiling LiDARs send 5 to 10 frames a second; by hand

}  // namespace

bool Audience::full() const {
  return viewers_.size() >= kMostViewers;
}

bool Audience::join(const std::shared_ptr<Viewer>& viewer) {
  if (full()) return false;
  viewers_.push_back(viewer);
  if (painting_)
    viewer->show();
  else
    paint();
  return true;
}

void Audience::leave(const Viewer* viewer) {
  std::erase_if(viewers_, [viewer](const auto& held) { return held.get() == viewer; });
}

void Audience::paint() {
  painting_ = !viewers_.empty();
  if (!painting_) return painter_.rest();
  try {
    painter_.paint(std::chrono::steady_clock::now());
    for (const auto& viewer : viewers_) viewer->show();
  } catch (const std::exception& trouble) {  // such as no memory: the next picture may do
    if (const auto held = troubles_.pass(std::chrono::steady_clock::now()))
      log::error("the page could not be drawn: {}{}", trouble.what(), held_back(*held));
  }
  timer_.expires_after(kEvery);
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error) paint();
  });
}

}  // namespace liloc::view

#pragma once
// Those who look, and what is shown to them. All of it runs on the page's thread.
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common/base/line_limit.hpp"
#include "server/view/painter.hpp"

namespace liloc::view {

class Viewer;

class Audience {
 public:
  Audience(boost::asio::io_context& io, Source source) : painter_(std::move(source), board_), timer_(io) {}

  [[nodiscard]] bool full() const;
  /// Has the site painted from now on, five times a second, until the last one leaves. False where it is full.
  [[nodiscard]] bool join(const std::shared_ptr<Viewer>& viewer);
  void leave(const Viewer* viewer);

  [[nodiscard]] const Board& board() const { return board_; }
  /// As the painter's.
  [[nodiscard]] std::shared_ptr<const std::string> scan_of(const std::string& client_id) {
    return painter_.scan_of(client_id);
  }

 private:
  void paint();

  Board board_;
  Painter painter_;
  boost::asio::steady_timer timer_;
  bool painting_ = false;
  LineLimit troubles_;
  std::vector<std::shared_ptr<Viewer>> viewers_;
};

}  // namespace liloc::view

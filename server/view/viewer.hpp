#pragma once
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <memory>

#include "server/view/audience.hpp"

namespace liloc::view {

/// A browser that looks on, over WebSocket. At most one message is on its way to it. All of it runs on the
/// page's thread.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::string_body>;

  /// `seat` is held as long as this lives.
  Viewer(boost::beast::tcp_stream stream, Audience& audience, std::shared_ptr<void> seat);

  /// Shakes hands and joins the audience.
  void accept(const std::shared_ptr<const Request>& request);
  /// Sends what is new on the board, unless something is on its way: then when that is over.
  void show();

 private:
  void listen();
  void close(boost::beast::websocket::close_code why);

  boost::beast::websocket::stream<boost::beast::tcp_stream, false> stream_;  // no deflate: 50 would cost a core
  Audience& audience_;
  const std::shared_ptr<void> seat_;
  boost::beast::flat_buffer heard_{128};
  Board::Seen seen_;
  bool sending_ = false, closing_ = false;
};

}  // namespace liloc::view

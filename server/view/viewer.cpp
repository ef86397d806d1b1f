#include "server/view/viewer.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

namespace liloc::view {
namespace {

namespace websocket = boost::beast::websocket;
using boost::system::error_code;

/// By hand.
constexpr int kSendBuffer = 256 * 1024;    // the kernel doubles it: all that a slow viewer holds there
constexpr std::size_t kFrame = 64 * 1024;  // pings get through between two such pieces of a message
constexpr std::size_t kHeard = 125;        // a viewer has nothing to say
constexpr std::chrono::seconds kHandshake{5}, kSilent{120};  // with pings: a slow one takes 20 s for a room

}  // namespace

Viewer::Viewer(boost::beast::tcp_stream stream, Audience& audience, std::shared_ptr<void> seat)
    : stream_(std::move(stream)), audience_(audience), seat_(std::move(seat)) {
  stream_.next_layer().expires_never();  // the WebSocket has its own
  stream_.set_option(websocket::stream_base::timeout{kHandshake, kSilent, true});
  stream_.write_buffer_bytes(kFrame);
  stream_.read_message_max(kHeard);
  error_code ignored;
  stream_.next_layer().socket().set_option(boost::asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  stream_.next_layer().socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
}

void Viewer::accept(const std::shared_ptr<const Request>& request) {
  stream_.async_accept(*request, [self = shared_from_this(), request](const error_code& error) {
    if (error) return;
    if (!self->audience_.join(self)) return self->close(websocket::close_code::try_again_later);
    self->listen();
  });
}

void Viewer::listen() {  // for pings, and the end
  stream_.async_read(heard_, [self = shared_from_this()](const error_code& error, std::size_t) {
    self->audience_.leave(self.get());
    if (!error) self->close(websocket::close_code::policy_error);  // it spoke: the page is read-only
  });
}

void Viewer::show() {
  if (sending_ || closing_) return;
  const auto message = audience_.board().next(seen_);
  if (!message) return;
  sending_ = true;
  stream_.binary(message->binary);
  stream_.async_write(boost::asio::buffer(message->bytes),
                      [self = shared_from_this(), message](const error_code& error, std::size_t) {
                        self->sending_ = false;
                        if (error) return self->audience_.leave(self.get());
                        self->show();
                      });
}

void Viewer::close(websocket::close_code why) {
  closing_ = true;
  stream_.async_close(why, [self = shared_from_this()](const error_code&) {});
}

}  // namespace liloc::view

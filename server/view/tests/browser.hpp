#pragma once
// A viewer, as a browser is one.
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <optional>
#include <string>

namespace liloc::view::test {

class Browser {
 public:
  using tcp = boost::asio::ip::tcp;

  /// `receive_buffer`: of the kernel; 0: as it likes.
  explicit Browser(int port, int receive_buffer = 0) {
    tcp::socket& socket = stream_.next_layer();
    socket.open(tcp::v4());
    if (receive_buffer > 0) socket.set_option(boost::asio::socket_base::receive_buffer_size(receive_buffer));
    boost::system::error_code error;
    socket.connect({boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)}, error);
    if (!error) stream_.handshake("localhost:" + std::to_string(port), "/live", error);
    looks_ = !error;
    stream_.read_message_max(8 * 1024 * 1024);
  }

  [[nodiscard]] bool looks() const { return looks_; }
  /// The next message; empty where the connection has ended.
  [[nodiscard]] std::optional<std::string> read() {
    boost::beast::flat_buffer buffer;
    boost::system::error_code error;
    stream_.read(buffer, error);
    if (error) return std::nullopt;
    return boost::beast::buffers_to_string(buffer.data());
  }
  void say(const std::string& text) {
    boost::system::error_code ignored;
    stream_.write(boost::asio::buffer(text), ignored);
  }
  [[nodiscard]] int close_code() const { return stream_.reason().code; }

 private:
  boost::asio::io_context io_;
  boost::beast::websocket::stream<tcp::socket> stream_{io_};
  bool looks_ = false;
};

/// What a viewer's handshake is answered: `HTTP/1.1 101`, or a refusal; with `headers`, each with its line's
/// end.
inline std::string handshake(int port, const std::string& headers = "") {
  boost::asio::io_context io;
  boost::asio::ip::tcp::socket socket(io);
  socket.connect({boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)});
  const std::string request = "GET /live HTTP/1.1\r\nHost: localhost:" + std::to_string(port) +
                              "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                              headers + "\r\n";
  boost::asio::write(socket, boost::asio::buffer(request));
  std::string answer(12, '\0');
  boost::system::error_code error;
  boost::asio::read(socket, boost::asio::buffer(answer), error);
  return error ? "" : answer;
}

}  // namespace liloc::view::test

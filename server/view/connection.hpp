#pragma once
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>
#include <optional>
#include <string>

#include "server/view/audience.hpp"

namespace liloc::view {

/// Requests of one connection, answered in turn, until one becomes a viewer. All of it runs on the page's
/// thread.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::string_body>;
  using Response = boost::beast::http::response<boost::beast::http::string_body>;

  /// `token`: as PageOptions has it. `seat` is held as long as this, or the viewer that it becomes, lives.
  Connection(boost::asio::ip::tcp::socket socket, const std::string& token, Audience& audience,
             std::shared_ptr<void> seat)
      : stream_(std::move(socket)), token_(token), audience_(audience), seat_(std::move(seat)) {}

  void read();

 private:
  void take(boost::system::error_code error);
  void answer(Response response);
  [[nodiscard]] std::string cookie() const;  ///< its name
  /// Here and below: why it gets nothing, or empty.
  [[nodiscard]] std::optional<Response> refusal(const Request& request) const;
  [[nodiscard]] std::optional<Response> no_live_view(const Request& request) const;
  [[nodiscard]] Response page(const Request& request) const;

  boost::beast::tcp_stream stream_;
  const std::string& token_;
  Audience& audience_;
  std::shared_ptr<void> seat_;
  boost::beast::flat_buffer heard_{16 * 1024};
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
};

}  // namespace liloc::view

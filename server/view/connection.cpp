#include "server/view/connection.hpp"

#include <algorithm>
#include <array>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "common/base/ids.hpp"
#include "server/view/access.hpp"
#include "server/view/assets.hpp"
#include "server/view/viewer.hpp"

namespace liloc::view {
namespace {

namespace http = boost::beast::http;
using boost::system::error_code;

/// By hand.
constexpr std::chrono::seconds kPatience{10};
constexpr std::uint32_t kHeaderLimit = 8 * 1024;
constexpr std::uint64_t kBodyLimit = 1024;
constexpr std::array kProxyFields{"X-Forwarded-For", "Forwarded", "X-Real-IP", "Via"};

std::string_view as_view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

Connection::Response response(http::status status, std::string_view type, std::string body) {
  Connection::Response made{status, 11};
  made.set(http::field::content_type, boost::beast::string_view(type.data(), type.size()));
  made.set(http::field::cache_control, "no-store");
  made.set("X-Content-Type-Options", "nosniff");
  made.set("Referrer-Policy", "no-referrer");
  made.set("Content-Security-Policy",
           "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src data:; "
           "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  made.body() = std::move(body);
  return made;
}

Connection::Response words(http::status status, std::string text) {
  return response(status, "text/plain; charset=utf-8", std::move(text));
}

/// What stood in the query goes into a cookie, so that it does not stay in the address.
Connection::Response with_cookie(const std::string& name, const std::string& token) {
  Connection::Response made = words(http::status::see_other, "");
  made.set(http::field::location, "/");
  made.set(http::field::set_cookie,
           fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/; Max-Age=2592000", name, token));
  return made;
}

Connection::Response after_bad_request(const error_code& error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return words(http::status::request_header_fields_too_large, "the header is too large\n");
  if (error == http::error::body_limit) return words(http::status::payload_too_large, "no body is expected\n");
  return words(http::status::bad_request, "this is no HTTP request\n");
}

bool is_live(const Connection::Request& request) {
  return path_of(as_view(request.target())) == "/live";
}

}  // namespace

void Connection::read() {
  parser_.emplace();
  parser_->header_limit(kHeaderLimit);
  parser_->body_limit(kBodyLimit);
  stream_.expires_after(kPatience);
  http::async_read(stream_, heard_, *parser_,
                   [self = shared_from_this()](const error_code& error, std::size_t) { self->take(error); });
}

void Connection::take(error_code error) {
  const bool gone = error == http::error::end_of_stream || error == http::error::partial_message ||
                    error == boost::beast::error::timeout ||
                    (error && error.category() == boost::system::system_category());
  if (gone) return;
  if (error) {
    Response made = after_bad_request(error);
    made.keep_alive(false);
    return answer(std::move(made));
  }
  const auto request = std::make_shared<const Request>(parser_->release());
  std::optional<Response> made = refusal(*request);
  if (!made && is_live(*request)) {
    made = no_live_view(*request);
    if (!made)
      return std::make_shared<Viewer>(std::move(stream_), audience_, std::move(seat_))->accept(request);
  }
  if (!made) made = page(*request);
  made->keep_alive(request->keep_alive());
  answer(std::move(*made));
}

void Connection::answer(Response made) {
  made.prepare_payload();
  const auto held = std::make_shared<const Response>(std::move(made));
  stream_.expires_after(kPatience);
  http::async_write(stream_, *held, [self = shared_from_this(), held](const error_code& error, std::size_t) {
    if (error) return;
    if (held->keep_alive()) return self->read();
    error_code ignored;
    self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  });
}

/// Cookies do not tell ports apart, and two servers may run on one host.
std::string Connection::cookie() const {
  error_code unknown;
  return fmt::format("liloc_token_{}", stream_.socket().local_endpoint(unknown).port());
}

std::optional<Connection::Response> Connection::refusal(const Request& request) const {
  if (request.method() != http::verb::get) {
    Response made = words(http::status::method_not_allowed, "GET only\n");
    made.set(http::field::allow, "GET");
    return made;
  }
  if (token_.empty()) {
    if (std::ranges::any_of(kProxyFields,
                            [&](const char* field) { return request.find(field) != request.end(); }))
      return words(http::status::forbidden, "behind a proxy the page needs a token: --web-token FILE\n");
    if (names_this_host(as_view(request[http::field::host]))) return std::nullopt;
    return words(
        http::status::forbidden,
        "this page is for this host alone: open it as http://localhost:PORT, or give --web an address\n");
  }
  const auto given = in_query(as_view(request.target()), "token");
  if (given && same_secret(*given, token_))
    return path_of(as_view(request.target())) == "/" ? std::optional(with_cookie(cookie(), token_))
                                                     : std::nullopt;
  const auto kept = in_cookie(as_view(request[http::field::cookie]), cookie());
  if (!given && kept && same_secret(*kept, token_)) return std::nullopt;
  return words(http::status::unauthorized,
               "a token is needed: open /?token=TOKEN once; it stands in the server's log, or in the file of "
               "--web-token\n");
}

std::optional<Connection::Response> Connection::no_live_view(const Request& request) const {
  if (!boost::beast::websocket::is_upgrade(request))
    return words(http::status::upgrade_required, "this is a WebSocket\n");
  const auto origin = as_view(request[http::field::origin]);
  if (!origin.empty() && !same_origin(origin, as_view(request[http::field::host])))
    return words(http::status::forbidden, "not for pages of other sites\n");
  if (audience_.full()) return words(http::status::service_unavailable, "as many viewers as there can be\n");
  return std::nullopt;
}

Connection::Response Connection::page(const Request& request) const {
  const auto target = as_view(request.target());
  if (path_of(target) == "/scan") {
    const auto id = valid_id(in_query(target, "device").value_or(""), "device");
    if (!id) return words(http::status::not_found, id.error().message + "\n");
    const auto scan = audience_.scan_of(*id);
    return response(http::status::ok, "application/octet-stream", scan ? *scan : "");
  }
  const Asset* asset = asset_of(path_of(target));
  if (asset == nullptr) return words(http::status::not_found, "no such page\n");
  Response made = response(http::status::ok, asset->content_type, std::string(asset->gzip));
  made.set(http::field::content_encoding, "gzip");
  return made;
}

}  // namespace liloc::view

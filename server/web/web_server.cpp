#include "server/web/web_server.hpp"

#include <civetweb.h>

#include <array>
#include <exception>
#include <string_view>

#include "common/base/log.hpp"

namespace liloc::web {
namespace {

struct CloseContext {
  void operator()(mg_context* context) const { mg_stop(context); }
};

std::string_view reason_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 503:
      return "Service Unavailable";
    default:
      return "Internal Server Error";
  }
}

void send(mg_connection* connection, const Page& page, bool with_body) {
  const std::string head = fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n{}Connection: "
      "close\r\n\r\n",
      page.status, reason_of(page.status), page.content_type, page.body.size(),
      page.status == 405 ? "Allow: GET, HEAD\r\n" : "");
  mg_write(connection, head.data(), head.size());
  if (with_body) mg_write(connection, page.body.data(), page.body.size());
}

Page page_for(const Pages& pages, const std::string& path, std::string_view method) {
  if (method != "GET" && method != "HEAD") return {405, "GET or HEAD\n"};
  const auto page = pages.find(path);
  if (page == pages.end()) return {404, "no such page\n"};
  try {
    return page->second();
  } catch (const std::exception& trouble) {
    log::error("page {}: {}", path, trouble.what());
    return {500, "internal error\n"};
  }
}

int answer(mg_connection* connection, void* pages) {
  const mg_request_info* request = mg_get_request_info(connection);
  const std::string_view method = request->request_method;
  const std::string path = request->local_uri == nullptr ? "" : request->local_uri;
  const Page page = page_for(*static_cast<const Pages*>(pages), path, method);
  send(connection, page, method != "HEAD");
  return page.status;
}

int keep_silent(const mg_connection* /*connection*/, const char* /*text*/) {
  return 1;  // what strangers send is no news; why it does not start is told otherwise
}

}  // namespace

struct WebServer::Impl {
  Pages pages;
  std::unique_ptr<mg_context, CloseContext> context;  // last: its threads use the pages
};

WebServer::WebServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
WebServer::~WebServer() = default;

Result<std::unique_ptr<WebServer>> WebServer::start(const Address& address, Pages pages) {
  if (const Status good = check(address); !good) return tl::unexpected(good.error());
  const std::string where = text_of(address);
  auto impl = std::make_unique<Impl>();
  impl->pages = std::move(pages);
  std::array<const char*, 11> options{"listening_ports",
                                      where.c_str(),
                                      "num_threads",
                                      "2",
                                      "connection_queue",
                                      "16",
                                      "request_timeout_ms",
                                      "2000",
                                      "enable_keep_alive",
                                      "no",
                                      nullptr};
  mg_callbacks callbacks{};
  callbacks.log_message = keep_silent;
  mg_init_data init{&callbacks, nullptr, options.data()};
  std::array<char, 256> why{};
  mg_error_data error{nullptr, why.data(), why.size()};
  impl->context.reset(mg_start2(&init, &error));
  if (!impl->context)
    return fail("cannot listen on {} ({}); free the port, or give another address", where, why.data());
  mg_set_request_handler(impl->context.get(), "/", answer, &impl->pages);
  return std::unique_ptr<WebServer>(new WebServer(std::move(impl)));
}

int WebServer::port() const {
  mg_server_port port{};
  return mg_get_server_ports(impl_->context.get(), 1, &port) == 1 ? port.port : 0;
}

}  // namespace liloc::web

#pragma once
// A few pages over HTTP, for machines: GET and HEAD only, no files, no state.
//
//   auto server = WebServer::start({"127.0.0.1", 9464}, {{"/metrics", [] { return Page{200, "..."}; }}});
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "server/web/address.hpp"

namespace liloc::web {

struct Page {
  int status = 200;
  std::string body;
  std::string content_type = "text/plain; charset=utf-8";
};
/// By path. Run on the web server's two threads, side by side. One that throws is answered by 500.
using Pages = std::map<std::string, std::function<Page()>>;

class WebServer {
 public:
  /// Errors: the address is taken, or not of this host. At most 16 connections wait; a slow one is dropped
  /// after 2 s.
  [[nodiscard]] static Result<std::unique_ptr<WebServer>> start(const Address& address, Pages pages);
  /// Waits for the pages in work.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  [[nodiscard]] int port() const;

 private:
  struct Impl;
  explicit WebServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc::web

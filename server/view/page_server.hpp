#pragma once
// The site in a browser: one port, HTTP and WebSocket, read-only, on a thread of its own.
//
//   auto server = PageServer::start({.address = {"127.0.0.1", 8080}}, source);
#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "server/view/source.hpp"
#include "server/web/address.hpp"

namespace liloc::view {

/// By hand.
constexpr std::size_t kMostViewers = 64, kMostConnections = 128;

struct PageOptions {
  web::Address address;
  std::string token;  ///< asked of everyone; empty: of nobody, and the page is for browsers on this host alone
};

class PageServer {
 public:
  /// Errors: the address is taken, not of this host, or reachable by others without a token. A viewer over
  /// kMostViewers is refused by 503; one that reads slowly misses pictures and costs at most 4 MB.
  [[nodiscard]] static Result<std::unique_ptr<PageServer>> start(const PageOptions& options, Source source);
  /// Drops all viewers. Nothing of `source` is called afterwards.
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  [[nodiscard]] int port() const;

 private:
  struct Impl;
  explicit PageServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc::view

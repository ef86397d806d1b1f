#include "server/view/page_server.hpp"

#include <pthread.h>

#include <boost/asio/ip/tcp.hpp>
#include <exception>
#include <thread>

#include "common/base/log.hpp"
#include "server/view/connection.hpp"

namespace liloc::view {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::milliseconds kPause{100};  // where no connection can be taken: no file is free; by hand

}  // namespace

struct PageServer::Impl {
  Impl(PageOptions of, Source source)
      : options(std::move(of)), audience(io, std::move(source)), acceptor(io), pause(io) {}
  ~Impl() { io.stop(); }  // then the thread ends, and what waits goes with `io`

  Status open() {
    error_code error;
    const tcp::endpoint here(boost::asio::ip::make_address(options.address.host),
                             static_cast<std::uint16_t>(options.address.port));
    acceptor.open(here.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(here, error);
    if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
    if (!error) return {};
    return fail("cannot listen on {} ({}); free the port, or give another address", text_of(options.address),
                error.message());
  }

  void accept() {
    acceptor.async_accept([this](const error_code& error, tcp::socket socket) {
      if (error) {
        pause.expires_after(kPause);
        return pause.async_wait([this](const error_code& stopped) {
          if (!stopped) accept();
        });
      }
      boost::asio::post(io, [this] { accept(); });  // whatever becomes of this one
      if (static_cast<std::size_t>(seats.use_count()) <= kMostConnections)
        std::make_shared<Connection>(std::move(socket), options.token, audience, seats)->read();
    });
  }

  void run() {
    pthread_setname_np(pthread_self(), "page");  // as `top -H` shows it
    for (;;) try {
        io.run();
        return;
      } catch (const std::exception& trouble) {  // such as no memory: that connection is lost, the page goes on
        log::error("the page: {}", trouble.what());
      }
  }

  const PageOptions options;
  boost::asio::io_context io{1};
  Audience audience;
  tcp::acceptor acceptor;
  boost::asio::steady_timer pause;
  const std::shared_ptr<void> seats = std::make_shared<char>();  ///< shared by this and each connection
  std::jthread thread;                                           // last: it uses all of the above
};

PageServer::PageServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PageServer::~PageServer() = default;

Result<std::unique_ptr<PageServer>> PageServer::start(const PageOptions& options, Source source) {
  if (const Status good = check(options.address); !good) return tl::unexpected(good.error());
  if (options.token.empty() && !is_loopback(options.address))
    return fail("{} can be reached by others; a token is needed", options.address.host);
  auto impl = std::make_unique<Impl>(options, std::move(source));
  if (Status opened = impl->open(); !opened) return tl::unexpected(opened.error());
  impl->accept();
  impl->thread = std::jthread([raw = impl.get()] { raw->run(); });
  return std::unique_ptr<PageServer>(new PageServer(std::move(impl)));
}

int PageServer::port() const {
  error_code error;
  return impl_->acceptor.local_endpoint(error).port();
}

}  // namespace liloc::view

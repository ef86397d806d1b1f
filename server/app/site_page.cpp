#include "server/app/site_page.hpp"

#include <fmt/format.h>

#include "server/view/access.hpp"

namespace liloc {

Status SitePage::open(const web::Address& address, const std::string& token_file, view::Source source) {
  view::PageOptions page{address, token_};
  if (!token_file.empty()) {
    const auto token = view::token_from(token_file);
    if (!token) return fail("--web-token: {}", token.error().message);
    page.token = *token;
  } else if (page.token.empty() && !web::is_loopback(address)) {
    page.token = view::new_token();
  }
  auto server = view::PageServer::start(page, std::move(source));
  if (!server) return fail("--web: {}", server.error().message);
  server_ = std::move(*server);
  token_ = page.token;
  url_ = fmt::format("http://{}/", web::text_of({address.host, port()}));
  if (!token_.empty() && token_file.empty()) url_ += "?token=" + token_;
  return {};
}

}  // namespace liloc

#pragma once
#include <memory>
#include <string>

#include "server/view/page_server.hpp"

namespace liloc {

/// The page of a site and the token that it asks for, which viewers keep when the page is opened again. Not
/// thread-safe.
class SitePage {
 public:
  /// `token_file`: of the token; empty: one is made up where others reach the address. Errors name the server's
  /// option.
  [[nodiscard]] Status open(const web::Address& address, const std::string& token_file, view::Source source);
  /// Nothing of its source is called afterwards.
  void close() { server_.reset(); }
  /// 0 while it is closed.
  [[nodiscard]] int port() const { return server_ ? server_->port() : 0; }
  /// What a browser opens, with the token where one was made up; empty before it was opened.
  [[nodiscard]] const std::string& url() const { return url_; }

 private:
  std::string token_, url_;
  std::unique_ptr<view::PageServer> server_;
};

}  // namespace liloc

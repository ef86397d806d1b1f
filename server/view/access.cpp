#include "server/view/access.hpp"

#include <algorithm>
#include <fstream>
#include <random>

namespace liloc::view {
namespace {

/// Of `name=value` pairs the value of `name`.
std::optional<std::string_view> value_of(std::string_view pairs, char separator, std::string_view name) {
  while (!pairs.empty()) {
    const auto end = std::min(pairs.find(separator), pairs.size());
    std::string_view pair = pairs.substr(0, end);
    pairs.remove_prefix(std::min(end + 1, pairs.size()));
    while (!pair.empty() && pair.front() == ' ') pair.remove_prefix(1);
    if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=')
      return pair.substr(name.size() + 1);
  }
  return std::nullopt;
}

bool of_a_token(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

}  // namespace

std::string_view path_of(std::string_view target) {
  return target.substr(0, target.find('?'));
}

std::optional<std::string_view> in_query(std::string_view target, std::string_view name) {
  const auto mark = target.find('?');
  if (mark == std::string_view::npos) return std::nullopt;
  return value_of(target.substr(mark + 1), '&', name);
}

std::optional<std::string_view> in_cookie(std::string_view cookie, std::string_view name) {
  return value_of(cookie, ';', name);
}

bool same_secret(std::string_view a, std::string_view b) {
  unsigned differ = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < b.size(); ++i)
    differ |= static_cast<unsigned char>((i < a.size() ? a[i] : '\0') ^ b[i]);
  return differ == 0;
}

bool names_this_host(std::string_view host) {
  if (host.starts_with("[::1]")) return host.size() == 5 || host[5] == ':';
  host = host.substr(0, host.find(':'));
  if (host == "localhost") return true;
  return host.starts_with("127.") &&
         std::ranges::all_of(host, [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
}

bool same_origin(std::string_view origin, std::string_view host) {
  const auto scheme = origin.find("://");
  return scheme != std::string_view::npos && !host.empty() && origin.substr(scheme + 3) == host;
}

std::string new_token() {
  std::random_device kernel;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", kernel());
  return token;
}

Result<std::string> token_from(const std::string& file) {
  std::ifstream in(file);
  std::string token(256, '\0');
  in.read(token.data(), static_cast<std::streamsize>(token.size()));
  if (in.gcount() <= 0) return fail("{} cannot be read, or is empty", file);
  token.resize(static_cast<std::size_t>(in.gcount()));
  token.resize(std::min(token.find('\n'), token.size()));
  while (!token.empty() && (token.back() == '\r' || token.back() == ' ')) token.pop_back();
  if (token.size() < 16 || token.size() > 128 || !std::ranges::all_of(token, of_a_token))
    return fail(
        "{}: a token is 16 to 128 of A-Z a-z 0-9 _ - in the first line; make one with `openssl rand -hex 16`",
        file);
  return token;
}

}  // namespace liloc::view

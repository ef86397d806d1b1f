#pragma once
// Who may see the page. Reads what strangers send: a path, a query, a few headers. Nothing here throws.
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace liloc::view {

/// What stands before the `?` of a request's target.
[[nodiscard]] std::string_view path_of(std::string_view target);
/// `name=value` in a target's query, as it stands there; empty where there is none.
[[nodiscard]] std::optional<std::string_view> in_query(std::string_view target, std::string_view name);
/// The same in a Cookie header.
[[nodiscard]] std::optional<std::string_view> in_cookie(std::string_view cookie, std::string_view name);

/// Takes as long wherever the two differ.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b);

/// Whether a Host header names this very host: localhost, 127.x.x.x or [::1], with or without a port. A page of
/// another site that had its own name resolve to 127.0.0.1 would read what is meant for this host alone.
[[nodiscard]] bool names_this_host(std::string_view host);
/// Whether an Origin header is of the page that `host` serves. None at all is no browser.
[[nodiscard]] bool same_origin(std::string_view origin, std::string_view host);

/// 32 hexadecimal digits of the system's randomness.
[[nodiscard]] std::string new_token();
/// From the first line of a file. Errors: it cannot be read, or is not 16 to 128 of [A-Za-z0-9_-].
[[nodiscard]] Result<std::string> token_from(const std::string& file);

}  // namespace liloc::view

// What an operator writes, what a server keeps of its site, and what a browser asks its page for.
#include "common/command/toml.hpp"
#include "common/recording/files.hpp"
#include "proto-tests/fuzz/border.hpp"
#include "server/app/site_state.hpp"
#include "server/view/access.hpp"

namespace liloc::fuzz {
namespace {

constexpr double kVoxel_m = 0.05;
const Site kSite{"map", {{"ceiling0", {8, 4, 8, 8, 3.5, 1.5, 0.001}, 6, Pose::Identity()}}};

Status read_toml(const std::string& bytes) {
  const auto entries = command::parse_toml(bytes, "server.toml");
  if (!entries) return tl::unexpected(entries.error());
  for (const auto& entry : *entries)
    require(!entry.key.empty() && entry.line >= 1, "an entry has no name or line");
  return {};
}

Status read_state(const std::string& bytes) {
  const std::string file = scratch_file("site.state.json", bytes);
  const auto noise = read_noise(file, kSite);
  require(noise.size() == 1 && noise.front().sigma_m(5) >= 0 && noise.front().sigma_m(5) < 10,
          "no sensor has such noise");
  const auto bounds = read_site_state(file, kSite, kVoxel_m);
  return bounds ? Status() : tl::unexpected(bounds.error());
}

std::string state_seed() {
  CellBounds learned;
  for (int i = 0; i < 12; ++i) learned.learn({0.5 * i, 1, 1}, 0.7 + 0.01 * i);
  const std::string file = scratch_file("site.state.json", "");
  require(write_site_state(file, kSite, kVoxel_m, learned, {{0.004, 0.001, 0.1, 0.05, 1000}}).has_value(),
          "a seed cannot be written");
  return read_file(file, 1 << 20).value();
}

constexpr std::string_view kToken = "0123456789abcdef";

/// Lines: a request's target, its Cookie, Host and Origin. Let in by a token, on this host, from its own page.
Status read_web(const std::string& bytes) {
  std::vector<std::string_view> lines;
  for (std::string_view rest = bytes; lines.size() < 4;) {
    const auto end = std::min(rest.find('\n'), rest.size());
    lines.push_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  require(view::path_of(lines[0]).size() <= lines[0].size(), "a path is longer than its target");
  const auto in_query = view::in_query(lines[0], "token"), in_cookie = view::in_cookie(lines[1], "liloc_token");
  for (const auto& [value, of] : {std::pair(in_query, lines[0]), std::pair(in_cookie, lines[1])})
    require(!value || of.find(*value) != std::string_view::npos, "a value stands where it was not");
  const auto given = in_query ? in_query : in_cookie;
  if (!given || !view::same_secret(*given, kToken)) return fail("no token");
  require(bytes.find(kToken) != std::string::npos, "let in without the token");
  if (!view::names_this_host(lines[2])) return fail("another host");
  if (!view::same_origin(lines[3], lines[2])) return fail("another origin");
  return {};
}

}  // namespace

std::vector<Border> setting_borders() {
  return {{.name = "toml",
           .seeds = {"# a server\nsite = \"/etc/liloc/site.json\"\ndomain = 5\nrisk = 1_0e-3\nstandby = true\n"
                     "peer = [\"10.0.0.1\", 'edge.local', \"a\\tb\"]\n",
                     "\xef\xbb\xbfkey = 1\r\n"},
           .read = read_toml},
          {.name = "state", .seeds = {state_seed()}, .read = read_state},
          {.name = "web",
           .seeds = {"/?a=1&token=0123456789abcdef\n\nlocalhost:8080\nhttp://localhost:8080",
                     "/live\nx=1; liloc_token=0123456789abcdef; y=2\n[::1]:80\nhttps://[::1]:80"},
           .read = read_web}};
}

}  // namespace liloc::fuzz

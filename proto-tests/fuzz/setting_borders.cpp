// What an operator writes, and what a server keeps of its site.
#include "common/command/toml.hpp"
#include "common/recording/files.hpp"
#include "proto-tests/fuzz/border.hpp"
#include "server/app/site_state.hpp"

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

}  // namespace

std::vector<Border> setting_borders() {
  return {{.name = "toml",
           .seeds = {"# a server\nsite = \"/etc/liloc/site.json\"\ndomain = 5\nrisk = 1_0e-3\nstandby = true\n"
                     "peer = [\"10.0.0.1\", 'edge.local', \"a\\tb\"]\n",
                     "\xef\xbb\xbfkey = 1\r\n"},
           .read = read_toml},
          {.name = "state", .seeds = {state_seed()}, .read = read_state}};
}

}  // namespace liloc::fuzz

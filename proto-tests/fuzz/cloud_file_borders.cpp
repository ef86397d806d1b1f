// Clouds that somebody hands to `liloc align`.
#include "proto-tests/fuzz/border.hpp"
#include "server/tools/cloud_file.hpp"

namespace liloc::fuzz {
namespace {

const std::string kPcd =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
    "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ";
const std::string kPlyBody =
    " 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

/// `count` zeros and a few bytes that are a small float.
std::string binary(std::size_t count) {
  std::string bytes(count, '\0');
  for (std::size_t i = 3; i < count; i += 4) bytes[i] = 0x3f;
  return bytes;
}

Status read(const std::string& name, const std::string& bytes) {
  const auto cloud = toolbox::read_cloud_file(scratch_file(name, bytes));
  if (!cloud) return tl::unexpected(cloud.error());
  require(!cloud->empty(), "the cloud has no point");
  for (const auto& p : cloud->points) require(p.allFinite(), "a point is not finite");
  return {};
}

}  // namespace

std::vector<Border> cloud_file_borders() {
  return {
      {.name = "pcd",
       .seeds = {kPcd + "ascii\n1 2 3\n4 5 6\n", kPcd + "binary\n" + binary(24)},
       .read = [](const auto& bytes) { return read("a.pcd", bytes); }},
      {.name = "ply",
       .seeds = {"ply\nformat ascii" + kPlyBody + "1 2 3\n4 5 6\n2 0 1\n",
                 "ply\nformat binary_little_endian" + kPlyBody + binary(24) + std::string("\2", 1) + binary(8)},
       .read = [](const auto& bytes) { return read("a.ply", bytes); }}};
}

}  // namespace liloc::fuzz

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "proto-tests/bench/spot_bench_peers.hpp"

namespace liloc::bench {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const Cloud& cloud) {
  std::ofstream out(path, std::ios::binary);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    out.write(reinterpret_cast<const char*>(cloud.points[i].data()), 3 * sizeof(float));
    out.write(reinterpret_cast<const char*>(cloud.normals[i].data()), 3 * sizeof(float));
  }
}

/// A folder that goes away with this object.
struct Folder {
  Folder() {
    std::string name = (fs::temp_directory_path() / "liloc_peers_XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path = name;
  }
  ~Folder() {
    std::error_code ignored;
    if (!path.empty()) fs::remove_all(path, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  fs::path path;
};

Result<std::vector<PeerAnswer>> read_answers(const fs::path& path, std::size_t count) {
  std::ifstream in(path);
  std::vector<PeerAnswer> answers(count);
  for (PeerAnswer& answer : answers) {
    for (int i = 0; i < 16; ++i) in >> answer.T_target_source.matrix()(i / 4, i % 4);
    if (!(in >> answer.latency_ms >> answer.target_latency_ms))
      return fail("{}: has fewer than {} answers; open3d_peer.py was ended early", path.string(), count);
  }
  return answers;
}

}  // namespace

Result<std::vector<PeerAnswer>> ask_open3d(const std::vector<PeerProblem>& problems, int threads) {
  const Folder folder;
  if (folder.path.empty()) return fail("no folder can be made in the system's folder for temporary files");
  for (std::size_t i = 0; i < problems.size(); ++i) {
    write(folder.path / fmt::format("{}.source", i), problems[i].source);
    write(folder.path / fmt::format("{}.target", i), problems[i].target);
  }
  const std::string command = fmt::format("OMP_NUM_THREADS={} /usr/bin/python3 '{}' '{}'", threads,
                                          LILOC_OPEN3D_PEER, folder.path.string());
  const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe): no other thread runs now
  if (status != 0) return fail("Open3D is left out: open3d_peer.py ended with {}", status);
  return read_answers(folder.path / "answers.txt", problems.size());
}

}  // namespace liloc::bench

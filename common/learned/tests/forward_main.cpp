// learned_forward WEIGHTS VOXELS OUT: the descriptors of voxels (three int32 each), in their order, as floats
// after the number of dimensions (int32). For tests against other implementations.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "common/learned/feature_network.hpp"

namespace {

std::vector<Eigen::Vector3i> read_voxels(const char* file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<Eigen::Vector3i> voxels;
  Eigen::Vector3i v;
  while (in.read(reinterpret_cast<char*>(v.data()), 3 * sizeof(int))) voxels.push_back(v);
  return voxels;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace liloc::learned;
  if (argc != 4) return 2;
  const auto network = FeatureNetwork::load(argv[1]);
  const std::vector<Eigen::Vector3i> voxels = read_voxels(argv[2]);
  const auto set = VoxelSet::of(voxels);
  if (!network || !set) {
    std::fprintf(stderr, "learned_forward: %s\n", (network ? set.error() : network.error()).message.c_str());
    return 2;
  }
  const Tensor rows = (**network)((*network)->maps(*set, 1), 1);
  std::ofstream out(argv[3], std::ios::binary);
  const int dimensions = (*network)->dimensions();
  out.write(reinterpret_cast<const char*>(&dimensions), sizeof dimensions);
  for (const Eigen::Vector3i& v : voxels)
    out.write(reinterpret_cast<const char*>(rows.values.row(set->find(v)).data()),
              dimensions * static_cast<std::streamsize>(sizeof(float)));
  return out.flush() ? 0 : 1;
}

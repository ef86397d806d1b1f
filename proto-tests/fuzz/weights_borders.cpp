// The weights of a network, which somebody else trained.
#include "common/learned/feature_network.hpp"
#include "common/learned/tests/random_network.hpp"
#include "common/learned/tests/weights_bytes.hpp"
#include "proto-tests/fuzz/border.hpp"

namespace liloc::fuzz {
namespace {

/// What is taken describes a few voxels.
Status read_network(const std::string& bytes) {
  const auto file = learned::parse_weights(bytes);
  if (!file) return tl::unexpected(file.error());
  const auto network = learned::FeatureNetwork::of(*file);
  if (!network) return tl::unexpected(network.error());
  const auto set = learned::VoxelSet::of({{0, 0, 0}, {1, 0, 0}, {-1, 0, -1}, {7, -3, 2}});
  const learned::NetworkMaps maps = network->maps(*set, 1);
  require((*network)(maps, 1).size() == set->size(), "not every voxel has a descriptor");
  require(network->flops(maps) > 0, "a network does nothing");
  return {};
}

}  // namespace

std::vector<Border> weights_borders() {
  const auto seed = [](std::uint64_t number, const learned::RandomWeights::Shape& shape) {
    return learned::bytes_of(learned::RandomWeights::of(number, shape));
  };
  return {{.name = "weights",
           .seeds = {seed(1, {{1, 1}, {1, 1}, 3, 1}), seed(2, {{1, 2}, {1, 1}, 1, 2})},
           .read = read_network}};
}

}  // namespace liloc::fuzz

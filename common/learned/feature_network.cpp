#include "common/learned/feature_network.hpp"

#include <charconv>

#include "common/learned/layer_weights.hpp"

namespace liloc::learned {
namespace {

constexpr std::size_t kFewestLevels = 2, kMostLevels = 6;  // by hand: the paper's network has four
constexpr int kWidth = 3;  // of all kernels but the first and those of one offset
constexpr double kLeastVoxel_m = 0.005, kMostVoxel_m = 1;  // by hand

/// The voxel size that the file says it was trained at.
Result<double> voxel_size_of(const WeightsFile& file) {
  const auto found = file.about.find("voxel_size_m");
  if (found == file.about.end()) return fail("__metadata__ has no voxel_size_m");
  const std::string& text = found->second;
  double value = 0;
  const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (trouble != std::errc() || end != text.data() + text.size() ||
      !(value >= kLeastVoxel_m && value <= kMostVoxel_m))
    return fail("voxel_size_m of __metadata__ is not {} to {}", kLeastVoxel_m, kMostVoxel_m);
  return value;
}

std::string numbered(const char* name, std::size_t level, const char* end = "") {
  return fmt::format("{}{}{}", name, level + 1, end);
}

Tensor normalized(Tensor t) {
  for (Eigen::Index row = 0; row < t.values.rows(); ++row) {
    const float length = t.values.row(row).norm();
    if (length > 0) t.values.row(row) /= length;
  }
  return t;
}

}  // namespace

std::size_t NetworkMaps::pairs() const {
  std::size_t count = first.pairs.size() + point.pairs.size();
  for (const auto* maps : {&blocks, &down, &up})
    for (const KernelMap& map : *maps) count += map.pairs.size();
  return count;
}

Result<FeatureNetwork::Block> FeatureNetwork::block_of(const LayerWeights& weights, const std::string& name,
                                                       int channels) {
  const auto first = weights.convolution(name + ".conv1", name + ".norm1", channels, kWidth);
  if (!first) return tl::unexpected(first.error());
  const auto second = weights.convolution(name + ".conv2", name + ".norm2", first->outputs, kWidth);
  if (!second) return tl::unexpected(second.error());
  if (second->outputs != channels)
    return fail("{}.conv2.kernel gives {} channels; {} are added to it", name, second->outputs, channels);
  return Block{Convolution(*first), Convolution(*second)};
}

Result<FeatureNetwork> FeatureNetwork::of(const WeightsFile& file) {
  FeatureNetwork network;
  const auto voxel_size_m = voxel_size_of(file);
  if (!voxel_size_m) return tl::unexpected(voxel_size_m.error());
  network.voxel_size_m_ = *voxel_size_m;
  if (const auto found = file.about.find("normalize"); found != file.about.end())
    network.normalize_ = found->second != "false";
  const LayerWeights weights(file);
  std::size_t count = 0;
  while (count <= kMostLevels && weights.has(numbered("conv", count))) ++count;
  if (count < kFewestLevels || count > kMostLevels)
    return fail("has {} levels (conv1.kernel, conv2.kernel, ..), not {} to {}", count, kFewestLevels,
                kMostLevels);
  network.levels_.resize(count);
  int channels = 1;  // occupancy
  for (std::size_t i = 0; i < count; ++i) {
    const auto down =
        weights.convolution(numbered("conv", i), numbered("norm", i), channels, i == 0 ? 0 : kWidth);
    if (!down) return tl::unexpected(down.error());
    channels = down->outputs;
    network.levels_[i].down = Convolution(*down);
    auto block = block_of(weights, numbered("block", i), channels);
    if (!block) return tl::unexpected(block.error());
    network.levels_[i].block = std::move(*block);
  }
  for (std::size_t i = count; i-- > 0;) {
    const auto up = weights.convolution(numbered("conv", i, "_tr"), i == 0 ? "" : numbered("norm", i, "_tr"),
                                        channels, i == 0 ? 1 : kWidth);
    if (!up) return tl::unexpected(up.error());
    network.levels_[i].up = Convolution(*up);
    if (i == 0) {
      channels = up->outputs;
      break;
    }
    auto block = block_of(weights, numbered("block", i, "_tr"), up->outputs);
    if (!block) return tl::unexpected(block.error());
    network.levels_[i].up_block = std::move(*block);
    channels = up->outputs + network.levels_[i - 1].down.outputs();
  }
  const auto final = weights.convolution("final", "", channels, 1);
  if (!final) return tl::unexpected(final.error());
  network.final_ = Convolution(*final);
  return network;
}

Result<std::shared_ptr<const FeatureNetwork>> FeatureNetwork::load(const std::filesystem::path& file) {
  constexpr auto kRemedy = "common/learned/convert_fcgf.py makes such a file of an FCGF checkpoint";
  const auto weights = read_weights(file);
  if (!weights) return fail("{}; {}", weights.error().message, kRemedy);
  auto network = of(*weights);
  if (!network) return fail("{}: {}; {}", file.string(), network.error().message, kRemedy);
  return std::make_shared<const FeatureNetwork>(std::move(*network));
}

NetworkMaps FeatureNetwork::maps(const VoxelSet& set, int threads) const {
  NetworkMaps maps;
  maps.sets.push_back(set);
  maps.first = same_map(set, levels_.front().down.width(), threads);
  maps.point = same_map(set, 1, threads);
  maps.blocks.push_back(same_map(set, kWidth, threads));
  for (std::size_t i = 1; i < levels_.size(); ++i) {
    maps.sets.push_back(maps.sets.back().halved());
    maps.down.push_back(down_map(maps.sets[i - 1], maps.sets[i], kWidth, threads));
    maps.up.push_back(transposed(maps.down.back()));
    maps.blocks.push_back(same_map(maps.sets[i], kWidth, threads));
  }
  return maps;
}

Tensor FeatureNetwork::run(const Block& block, const KernelMap& map, const Tensor& input, int threads) {
  return block.second(map, block.first(map, input, {nullptr, true}, threads), {&input, true}, threads);
}

Tensor FeatureNetwork::operator()(const NetworkMaps& maps, int threads) const {
  Tensor occupancy(maps.sets.front().size(), 1);
  occupancy.values.col(0).setOnes();
  std::vector<Tensor> seen;  // of each level, before it is halved
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const Level& level = levels_[i];
    const Tensor entered = i == 0 ? level.down(maps.first, occupancy, {}, threads)
                                  : level.down(maps.down[i - 1], seen.back(), {}, threads);
    seen.push_back(run(level.block, maps.blocks[i], entered, threads));
  }
  Tensor x = std::move(seen.back());
  for (std::size_t i = levels_.size() - 1; i > 0; --i) {
    const Tensor raised = levels_[i].up(maps.up[i - 1], x, {}, threads);
    x = joined(run(levels_[i].up_block, maps.blocks[i - 1], raised, threads), seen[i - 1]);
  }
  x = levels_.front().up(maps.point, x, {nullptr, true}, threads);
  x = final_(maps.point, x, {}, threads);
  return normalize_ ? normalized(std::move(x)) : x;
}

double FeatureNetwork::flops(const NetworkMaps& maps) const {
  const auto of_block = [](const Block& block, const KernelMap& map) {
    return block.first.flops(map) + block.second.flops(map);
  };
  double sum = levels_.front().up.flops(maps.point) + final_.flops(maps.point);
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    sum += levels_[i].down.flops(i == 0 ? maps.first : maps.down[i - 1]);
    sum += of_block(levels_[i].block, maps.blocks[i]);
    if (i > 0) sum += levels_[i].up.flops(maps.up[i - 1]) + of_block(levels_[i].up_block, maps.blocks[i - 1]);
  }
  return sum;
}

}  // namespace liloc::learned

// How fast a network describes clouds on this processor: milliseconds, operations, their share of the peak,
// memory.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <random>

#include "common/learned/feature_network.hpp"
#include "common/learned/row_products.hpp"
#include "common/learned/tests/random_network.hpp"
#include "server/tools/cloud_file.hpp"

namespace liloc::bench {
namespace {

struct Arguments {
  std::string weights, cloud;
  double voxel_m = 0;
  int dimensions = 32, threads = 1, repeats = 5;
};

double process_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// An empty corner of a room of 3 m, every point of whose surfaces is seen: as many voxels as 3DMatch's
/// fragments.
Cloud corner() {
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<float> any(0, 3);
  Cloud cloud;
  for (int i = 0; i < 200'000; ++i) {
    Eigen::Vector3f p(any(rng), any(rng), any(rng));
    p[i % 3] = 0.01F;
    cloud.points.push_back(p);
  }
  return cloud;
}

Result<learned::FeatureNetwork> network_of(const Arguments& arguments) {
  if (arguments.weights.empty()) {
    auto shape = learned::RandomWeights::paper();
    shape.dimensions = static_cast<std::size_t>(arguments.dimensions);
    return learned::FeatureNetwork::of(learned::RandomWeights::of(1, shape));
  }
  const auto loaded = learned::FeatureNetwork::load(arguments.weights);
  if (!loaded) return tl::unexpected(loaded.error());
  return **loaded;
}

Result<learned::VoxelSet> voxels_of(const Cloud& cloud, double voxel_m) {
  std::vector<Eigen::Vector3i> voxels;
  for (const Eigen::Vector3f& p : cloud.points)
    if (p.cwiseAbs().maxCoeff() < 1000)
      voxels.emplace_back((p.array() / static_cast<float>(voxel_m)).floor().cast<int>());
  return learned::VoxelSet::of(voxels);
}

/// The median of so many runs, CPU time of all threads.
template <class Work>
double median_ms(int repeats, const Work& work) {
  std::vector<double> took_ms;
  for (int i = 0; i < repeats; ++i) {
    const double began_ms = process_cpu_ms();
    work();
    took_ms.push_back(process_cpu_ms() - began_ms);
  }
  std::ranges::sort(took_ms);
  return took_ms[took_ms.size() / 2];
}

Status run(const Arguments& arguments) {
  const auto network = network_of(arguments);
  if (!network) return tl::unexpected(network.error());
  Cloud cloud = corner();
  if (!arguments.cloud.empty()) {
    auto read = toolbox::read_cloud_file(arguments.cloud);
    if (!read) return tl::unexpected(read.error());
    cloud = std::move(*read);
  }
  const double voxel_m = arguments.voxel_m > 0 ? arguments.voxel_m : network->voxel_size_m();
  const auto set = voxels_of(cloud, voxel_m);
  if (!set) return tl::unexpected(set.error());
  learned::NetworkMaps maps;
  const double maps_ms = median_ms(arguments.repeats, [&] { maps = network->maps(*set, arguments.threads); });
  const double layers_ms = median_ms(arguments.repeats, [&] { (void)(*network)(maps, arguments.threads); });
  const double gflop = 1e-9 * network->flops(maps), gflops = 1e3 * gflop / layers_ms,
               peak_gflops = 1e-9 * learned::peak_flops_per_s();
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  fmt::print("{} voxels of {} m, {} pairs in {} maps, {} dimensions\n", set->size(), voxel_m, maps.pairs(),
             2 + maps.blocks.size() + 2 * maps.down.size(), network->dimensions());
  fmt::print("kernel maps {:.1f} ms, layers {:.1f} ms, {:.2f} ms per 1000 voxels (CPU time of {} threads)\n",
             maps_ms, layers_ms,
             1e3 * (maps_ms + layers_ms) / static_cast<double>(std::max<std::size_t>(1, set->size())),
             arguments.threads);
  fmt::print("{:.2f} GFLOP at {:.1f} GFLOP/s: {:.0f} % of the {:.1f} that this core sums at most\n", gflop,
             gflops, 100 * gflops / peak_gflops, peak_gflops);
  fmt::print("most memory {:.0f} MB\n", static_cast<double>(used.ru_maxrss) / 1024);
  return {};
}

}  // namespace
}  // namespace liloc::bench

int main(int argc, char** argv) {
  using namespace liloc;
  bench::Arguments arguments;
  CLI::App app("How fast learned features are made on this processor");
  app.add_option("--weights", arguments.weights, "Of the network; else random ones of the paper's");
  app.add_option("--dimensions", arguments.dimensions, "Of descriptors of the random network")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--cloud", arguments.cloud, "PCD or PLY file; else a corner of a room, 3 m wide");
  app.add_option("--voxel", arguments.voxel_m, "Voxel size in metres; else the network's")
      ->check(CLI::Range(0.005, 1.0));
  app.add_option("--threads", arguments.threads, "Threads")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--repeats", arguments.repeats, "Runs, of which the median is told")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (const Status done = bench::run(arguments); !done) {
    fmt::print(stderr, "liloc_learned_bench: {}\n", done.error().message);
    return 2;
  }
  return 0;
}

// The client's odometry without a server: how far it drifts over recordings, and how its registration does on
// pairs of frames beside PCL's GICP and any peer.
//
//   liloc_odometry_bench REC... [--voxel 0.05] [--no-imu] [--local cloud|inertial|dead-reckoning] [--every N]
//   liloc_odometry_bench REC... --pairs 20 [--dump-pairs DIR] [--peer-results FILE.csv]...
//
// Recordings of simulated sites come from `liloc sim`. A peer reads DIR (pair_bench.hpp says what is in it),
// runs on one thread, and its CSV joins the table. The guess of a pair is the motion of the same number of
// frames before, by LiLoc's odometry, the same for all.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <deque>

#include "client/odometry/image_thinning.hpp"
#include "common/base/log.hpp"
#include "common/geometry/depth.hpp"
#include "proto-tests/bench/drift_bench.hpp"
#include "proto-tests/bench/pair_bench.hpp"

namespace liloc::bench {
namespace {

struct Options {
  DriftOptions drift;
  bool frames = false;
  std::size_t pairs = 0;
  std::string dump;
  std::vector<std::string> peers;
  std::vector<std::string> recordings;
};

constexpr int kGaps[] = {2, 10};  // frames from one of a pair to the other; by hand

/// The clouds that the odometry saw, with its poses and the true ones.
Result<std::vector<OdometryFrame>> frames_of(const DeviceRecording& device, const DriftRun& run) {
  const Camera& camera = device.info.camera;
  const int factor = thinning_for(camera);
  std::vector<OdometryFrame> frames;
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const auto image = read_depth(device.depth[i], camera);
    if (!image) return tl::unexpected(image.error());
    auto cloud = depth_to_cloud(thinned(*image, factor), thinned(camera, factor));
    if (!cloud) return tl::unexpected(cloud.error());
    frames.push_back({std::move(*cloud), run.frames[i].T_odom_sensor, run.truth[i]});
  }
  return frames;
}

/// Drift of every device; their frames are kept where pairs are asked for.
Status run_recording(const std::string& root, const Options& options,
                     std::deque<std::vector<OdometryFrame>>& kept, std::vector<FramePair>& pairs) {
  const auto recording = open_recording(root);
  if (!recording) return tl::unexpected(recording.error());
  for (const DeviceRecording& device : recording->devices) {
    const std::string name = recording->root.filename().string() + "/" + device.info.id;
    const auto run = run_drift(device, options.drift);
    if (!run) return tl::unexpected(run.error());
    print_drift(name, *run, options.frames);
    if (options.pairs == 0) continue;
    auto frames = frames_of(device, *run);
    if (!frames) return tl::unexpected(frames.error());
    kept.push_back(std::move(*frames));
    for (const int gap : kGaps)
      for (FramePair& pair : choose_pairs(recording->root.filename().string() + "-" + device.info.id,
                                          kept.back(), gap, options.pairs))
        pairs.push_back(std::move(pair));
  }
  return {};
}

Status run_pairs(const std::vector<FramePair>& pairs, const Options& options) {
  if (!options.dump.empty())
    if (auto ok = dump_pairs(pairs, options.dump); !ok) return ok;
  std::vector<PairResult> results;
  for (const FramePair& pair : pairs) {
    results.push_back(by_liloc(pair, options.drift.voxel_m));
    results.push_back(by_pcl_gicp(pair, options.drift.voxel_m));
  }
  for (const std::string& file : options.peers) {
    const auto peer = read_peer(pairs, file);
    if (!peer) return tl::unexpected(peer.error());
    results.insert(results.end(), peer->begin(), peer->end());
  }
  print_pairs(results);
  return {};
}

Status run_all(const Options& options) {
  if (const std::string why = energy_obstacle(); !why.empty())
    fmt::print(stderr, "energy is not measured: {}\n", why);
  std::deque<std::vector<OdometryFrame>> kept;
  std::vector<FramePair> pairs;
  for (const std::string& root : options.recordings)
    if (auto ok = run_recording(root, options, kept, pairs); !ok) return ok;
  return pairs.empty() ? Status{} : run_pairs(pairs, options);
}

}  // namespace
}  // namespace liloc::bench

int main(int argc, char** argv) {
  using namespace liloc;
  bench::Options options;
  std::string local = "cloud";
  bool verbose = false, no_imu = false;
  CLI::App app("Drift of the client's odometry, and its registration on pairs of frames");
  app.add_option("REC", options.recordings, "Recordings with ground truth")->required();
  app.add_option("--local", local, "cloud, inertial or dead-reckoning")->capture_default_str();
  app.add_flag("--no-imu", no_imu, "As if the devices had none");
  app.add_option("--every", options.drift.every, "Only every so manieth frame")->check(CLI::PositiveNumber);
  app.add_option("--focal-factor", options.drift.focal_factor, "Wrong intrinsics, to see what they do");
  app.add_option("--voxel", options.drift.voxel_m, "Metres")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 0.5));
  app.add_flag("--frames", options.frames, "A line for each frame");
  app.add_flag("--verbose", verbose, "What the odometry logs");
  app.add_option("--pairs", options.pairs, "So many pairs of frames per device and gap, beside PCL's GICP");
  app.add_option("--dump-pairs", options.dump, "Folder for the pairs' clouds and guesses");
  app.add_option("--peer-results", options.peers, "CSV files that join the table");
  CLI11_PARSE(app, argc, argv);
  const auto method = local_method_from(local);
  if (!method || (options.pairs > 0 && options.drift.every > 1)) {
    fmt::print(stderr, "{}\n",
               method ? "--pairs needs every frame: leave --every out" : method.error().message);
    return 2;
  }
  options.drift.local = *method;
  options.drift.use_imu = !no_imu;
  if (verbose) log::set_sink([](log::Level, std::string_view line) { fmt::print(stderr, "{}\n", line); });
  const auto done = bench::run_all(options);
  if (!done) fmt::print(stderr, "{}\n", done.error().message);
  return done ? 0 : 1;
}

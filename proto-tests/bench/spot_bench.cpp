// How well and how fast single spots are found: cold and with history, on simulated sites whose seeds are
// named.
//
//   liloc_spot_bench --sites 100 [--first-seed 1] [--threads 1] [--csv rows.csv] [--no-gravity]
//
// Devices' odometry is the truth with a drift of 1 % and 0.1 deg a step, so that only the server is measured.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <random>

#include "common/codec/codec.hpp"
#include "common/geometry/depth.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/refine.hpp"
#include "proto-tests/sim/simulation.hpp"
#include "server/localization/localizer.hpp"

namespace liloc {
namespace {

struct Row {
  std::uint64_t seed = 0;
  bool cold = false;
  double overlap = 0, error_deg = 999, error_m = 999, latency_ms = 0;
  double nees =
      -1;  ///< squared error over the reported covariance: 6 on average if that is honest; -1: no pose
  SpotReply reply;
  [[nodiscard]] bool within(double deg, double m) const { return error_deg <= deg && error_m <= m; }
};

struct Options {
  int sites = 20, threads = 1;
  std::uint64_t first_seed = 1;
  bool gravity = true, verbose = false;
  double seconds = 12;
  std::string csv;
};

/// Site `seed` of the benchmark: kinds, sizes, people and LiDARs vary with the seed.
sim::SimOptions site_options(std::uint64_t seed, double seconds) {
  sim::SimOptions o;
  o.seed = 1000 + seed;
  constexpr std::array kinds{sim::SiteKind::office,   sim::SiteKind::office,    sim::SiteKind::office,
                             sim::SiteKind::corridor, sim::SiteKind::office,    sim::SiteKind::area,
                             sim::SiteKind::office,   sim::SiteKind::symmetric, sim::SiteKind::office,
                             sim::SiteKind::office};
  o.kind = kinds[seed % kinds.size()];
  o.people = static_cast<int>((seed * 7) % 13);
  o.lidars = o.kind == sim::SiteKind::area ? 6 : 3 + static_cast<int>(seed % 2);
  o.devices = 1;
  o.device_kind = seed % 4 == 3 ? sim::DeviceKind::robot : sim::DeviceKind::carried;
  o.lidar_rate_hz = 2.5;
  o.device_rate_hz = 1.25;
  o.imu_rate_hz = 0;
  o.seconds = seconds;
  o.still_seconds = 0.5;
  return o;
}

SpotRequest make_request(const DeviceInfo& device, const DepthImage& image, const Pose& T_map_sensor,
                         const Options& options, std::mt19937_64& rng) {
  SpotRequest request;
  request.client_id = device.id;
  request.stamp_ns = image.stamp_ns;
  request.view = {device.camera, 0.25, 6.0};
  const auto cloud = depth_to_cloud(image, device.camera, {0.25, 6.0});
  if (const auto lpc = encode(voxel_downsample(*cloud, 0.05))) request.lpc = *lpc;
  if (options.gravity) {
    std::normal_distribution<double> tilt(0, radians(0.7));
    const Eigen::Vector3d up_map = so3_exp({tilt(rng), tilt(rng), 0}) * Eigen::Vector3d::UnitZ();
    request.up_sensor = T_map_sensor.linear().transpose() * up_map;
  }
  return request;
}

/// The truth seen through an odometry that drifts.
class DriftingOdometry {
 public:
  Pose next(const Pose& T_map_sensor, std::mt19937_64& rng) {
    if (last_) {
      const Pose step = last_->inverse() * T_map_sensor;
      std::normal_distribution<double> unit(0, 1);
      const double shift = 0.01 * step.translation().norm() + 0.002;
      Vector6d noise;
      for (int i = 0; i < 6; ++i) noise[i] = unit(rng) * (i < 3 ? radians(0.1) : shift);
      T_odom_sensor_ = T_odom_sensor_ * step * increment(noise);
    }
    last_ = T_map_sensor;
    return T_odom_sensor_;
  }

 private:
  std::optional<Pose> last_;
  Pose T_odom_sensor_ = Pose::Identity();
};

/// Error of the pose in the sensor's axes against its reported covariance.
double nees_of(const SpotReply& reply, const Pose& truth) {
  Vector6d error;
  error << so3_log(truth.linear().transpose() * reply.T_map_sensor->linear()),
      truth.linear().transpose() * (reply.T_map_sensor->translation() - truth.translation());
  return error.dot(reply.covariance.ldlt().solve(error));
}

double overlap_at(GlobalCloud& room, const DepthImage& image, const DeviceInfo& device,
                  const Pose& T_map_sensor) {
  const auto snapshot = room.nearest(image.stamp_ns);
  const auto cloud = depth_to_cloud(image, device.camera, {0.25, 6.0, 0.0});
  if (!snapshot || !cloud || cloud->empty()) return 0;
  return fit_of((*snapshot)->target(), voxel_downsample(*cloud, 0.05), T_map_sensor, 0.075).fitness;
}

Result<std::vector<Row>> run_site(std::uint64_t seed, const Options& options) {
  auto simulation = sim::Simulation::create(site_options(seed, options.seconds));
  if (!simulation) return tl::unexpected(simulation.error());
  GlobalCloud room(simulation->site(), {});
  LocalizerOptions localizing;
  localizing.threads = options.threads;
  Localizer localizer(room, localizing);
  const DeviceInfo& device = simulation->devices()[0];
  std::mt19937_64 rng(seed);
  DriftingOdometry odometry;
  std::vector<Row> rows;
  std::vector<sim::DeviceFrame> waiting;
  std::uint64_t seq = 0;
  while (auto event = simulation->next()) {
    if (auto* frame = std::get_if<sim::DeviceFrame>(&event->payload)) waiting.push_back(std::move(*frame));
    auto* ceiling = std::get_if<sim::LidarFrame>(&event->payload);
    if (ceiling == nullptr) continue;
    if (const Status taken = room.add_depth(ceiling->lidar, std::move(ceiling->image)); !taken)
      return tl::unexpected(taken.error());
    if (ceiling->lidar + 1 != simulation->site().global_lidars.size()) continue;
    for (const auto& frame : waiting) {
      SpotRequest request = make_request(device, frame.image, frame.T_map_sensor, options, rng);
      request.T_odom_sensor = odometry.next(frame.T_map_sensor, rng);
      const double overlap = overlap_at(room, frame.image, device, frame.T_map_sensor);
      room.prepare();
      for (const bool cold : {true, false}) {
        request.cold = cold;
        request.seq = ++seq;
        Row row{seed, cold, overlap, 999, 999, 0, -1, localizer.locate(request)};
        row.latency_ms = row.reply.latency_ms;
        if (row.reply.reason == Reason::no_gpc || row.reply.reason == Reason::bad_cloud) continue;
        if (row.reply.T_map_sensor) {
          row.error_deg = degrees(angle_between_rad(*row.reply.T_map_sensor, frame.T_map_sensor));
          row.error_m = distance_m(*row.reply.T_map_sensor, frame.T_map_sensor);
          row.nees = nees_of(row.reply, frame.T_map_sensor);
        }
        rows.push_back(row);
      }
    }
    waiting.clear();
  }
  return rows;
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

void print_mode(const std::vector<Row>& all, bool cold) {
  fmt::print("\n{}\n{:>10} {:>6} {:>9} {:>9} {:>9} {:>9}\n", cold ? "cold" : "with history", "overlap", "spots",
             "10d 0.3m", "3d 0.1m", "verified", "wrong ver");
  const auto line = [&](const std::string& name, double low, double high) {
    std::size_t n = 0, loose = 0, strict = 0, verified = 0, wrong = 0;
    for (const Row& r : all) {
      if (r.cold != cold || r.overlap < low || r.overlap >= high) continue;
      ++n;
      loose += r.within(10, 0.3);
      strict += r.within(3, 0.1);
      verified += r.reply.verified();
      wrong += r.reply.verified() && !r.within(10, 0.3);
    }
    const auto share = [&](std::size_t k) {
      return n == 0 ? 0.0 : 100.0 * static_cast<double>(k) / static_cast<double>(n);
    };
    fmt::print("{:>10} {:>6} {:>8.1f}% {:>8.1f}% {:>8.1f}% {:>9}\n", name, n, share(loose), share(strict),
               share(verified), wrong);
  };
  for (int d = 0; d < 10; ++d)
    line(fmt::format("{:.1f}-{:.1f}", d / 10.0, (d + 1) / 10.0), d / 10.0, (d + 1) / 10.0 + (d == 9));
  line("over 0.3", 0.3, 2);
  line("all", -1, 2);
  std::vector<double> latency;
  for (const Row& r : all)
    if (r.cold == cold) latency.push_back(r.latency_ms);
  fmt::print("latency: median {:.1f} ms, p90 {:.1f} ms\n", percentile(latency, 0.5), percentile(latency, 0.9));
}

/// Verified answers only: a wrong one has no covariance to speak of.
void print_consistency(const std::vector<Row>& all) {
  constexpr double kLow = 1.237, kHigh = 14.449;  // 95 % of chi-squared with six degrees of freedom
  std::vector<double> nees;
  for (const Row& r : all)
    if (r.reply.verified() && r.within(10, 0.3)) nees.push_back(r.nees);
  if (nees.empty()) return;
  const auto inside = std::count_if(nees.begin(), nees.end(), [](double v) { return v >= kLow && v <= kHigh; });
  double sum = 0;
  for (const double v : nees) sum += std::min(v, 100.0);
  fmt::print(
      "\ncovariance of verified answers: NEES median {:.1f} (5.3 expected), mean {:.1f} (6), {:.0f} % within "
      "95 % bounds\n",
      percentile(nees, 0.5), sum / static_cast<double>(nees.size()),
      100.0 * static_cast<double>(inside) / static_cast<double>(nees.size()));
}

Status write_csv(const std::string& path, const std::vector<Row>& rows) {
  std::ofstream out(path);
  out << "seed,cold,overlap_truth,error_deg,error_m,status,reason,fitness,overlap,margin,latency_ms,nees,"
         "text\n";
  for (const Row& r : rows)
    out << fmt::format("{},{},{:.3f},{:.2f},{:.3f},{},{},{:.3f},{:.3f},{:.3f},{:.1f},{:.2f},{}\n", r.seed,
                       r.cold ? 1 : 0, r.overlap, r.error_deg, r.error_m, name_of(r.reply.status),
                       name_of(r.reply.reason), r.reply.fitness, r.reply.overlap, r.reply.margin, r.latency_ms,
                       r.nees, r.reply.text);
  if (!out.flush()) return fail("{}: cannot be written; name a file in a folder that exists", path);
  return {};
}

int run(const Options& options) {
  std::vector<Row> rows;
  for (int i = 0; i < options.sites; ++i) {
    const std::uint64_t seed = options.first_seed + static_cast<std::uint64_t>(i);
    const auto site = run_site(seed, options);
    if (!site) {
      fmt::print(stderr, "site {}: {}\n", seed, site.error().message);
      return 1;
    }
    rows.insert(rows.end(), site->begin(), site->end());
    if (options.verbose)
      for (const Row& r : *site)
        fmt::print("site {} {} overlap {:.2f} error {:6.2f} deg {:6.3f} m {} {} margin {:.2f} {}\n", seed,
                   r.cold ? "cold" : "hist", r.overlap, r.error_deg, r.error_m, name_of(r.reply.status),
                   name_of(r.reply.reason), r.reply.margin, r.reply.text);
  }
  fmt::print("{} sites from seed {}, {} thread(s), gravity {}\n", options.sites, options.first_seed,
             options.threads, options.gravity ? "known" : "unknown");
  print_mode(rows, true);
  print_mode(rows, false);
  print_consistency(rows);
  if (options.csv.empty()) return 0;
  if (const Status written = write_csv(options.csv, rows); !written) {
    fmt::print(stderr, "{}\n", written.error().message);
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace liloc

int main(int argc, char** argv) {
  liloc::Options options;
  CLI::App app{"Spots on simulated sites: success by overlap, wrong verified answers, latency"};
  app.add_option("--sites", options.sites, "Number of sites")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--first-seed", options.first_seed, "Seed of the first site")->capture_default_str();
  app.add_option("--threads", options.threads, "Per request")->check(CLI::Range(1, 64))->capture_default_str();
  app.add_option("--seconds", options.seconds, "Simulated per site")
      ->check(CLI::Range(2, 600))
      ->capture_default_str();
  app.add_option("--csv", options.csv, "Write a row per spot");
  app.add_flag("!--no-gravity", options.gravity, "Devices do not know gravity");
  app.add_flag("--verbose", options.verbose, "Print every spot");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return liloc::run(options);
}

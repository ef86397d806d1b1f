#include "proto-tests/bench/drift_bench.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>

namespace liloc::bench {
namespace {

/// CPU time of this process so far; the engine has no other thread.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

constexpr const char* kEnergyCounter = "/sys/class/powercap/intel-rapl:0/energy_uj";

/// Energy counter of the processor; empty without the right or the means to read it.
std::optional<double> package_joules() {
  std::ifstream file(kEnergyCounter);
  double microjoules = 0;
  if (!(file >> microjoules)) return std::nullopt;
  return 1e-6 * microjoules;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

}  // namespace

Pose DriftRun::error(std::size_t i, std::size_t j) const {
  return (truth[i].inverse() * truth[j]).inverse() *
         (frames[i].T_odom_sensor.inverse() * frames[j].T_odom_sensor);
}

DriftSpread spread_of(const DriftRun& run) {
  const auto& f = run.frames;
  std::vector<double> moved, turned;
  for (std::size_t i = 0, j = 0; i < f.size(); ++i) {
    while (j < f.size() && f[j].stamp_ns - f[i].stamp_ns < from_ms(1000)) ++j;
    if (j == f.size()) break;
    const Pose E = run.error(i, j);
    moved.push_back(E.translation().norm());
    turned.push_back(rotation_angle_rad(E));
  }
  const auto count = static_cast<Eigen::Index>(f.size());
  Eigen::Matrix3Xd estimate(3, count), truth(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    estimate.col(i) = f[static_cast<std::size_t>(i)].T_odom_sensor.translation();
    truth.col(i) = run.truth[static_cast<std::size_t>(i)].translation();
  }
  const Eigen::Isometry3d T(Eigen::umeyama(estimate, truth, false));
  const double squares = (T * estimate - truth).squaredNorm();
  return {quantile(moved, 0.5), quantile(moved, 0.9), quantile(turned, 0.5),
          std::sqrt(squares / static_cast<double>(std::max<Eigen::Index>(count, 1)))};
}

Result<DriftRun> run_drift(const DeviceRecording& device, const DriftOptions& options) {
  const auto truth = read_ground_truth(device);
  if (!truth) return tl::unexpected(truth.error());
  if (truth->size() < device.depth.size())
    return fail("{}: {} poses of ground truth for {} frames; drift cannot be told", device.folder.string(),
                truth->size(), device.depth.size());
  EngineOptions eo;
  eo.client_id = device.info.id;
  eo.camera = device.info.camera;
  eo.local = options.local;
  if (!device.imu.empty() && options.use_imu) eo.T_imu_sensor = device.info.T_imu_sensor;
  eo.still_seconds = device.info.still_seconds;
  eo.voxel_size_m = options.voxel_m;
  eo.camera.fx *= options.focal_factor;
  eo.camera.fy *= options.focal_factor;
  Engine engine(eo);
  DriftRun run;
  const auto joules_before = package_joules();
  std::size_t next_imu = 0;
  std::optional<std::size_t> last_request;  ///< its frame
  for (std::size_t i = 0; i < device.depth.size(); i += static_cast<std::size_t>(options.every)) {
    const auto image = read_depth(device.depth[i], device.info.camera);
    if (!image) return tl::unexpected(image.error());
    const double cpu_before = cpu_seconds();
    for (; options.use_imu && next_imu < device.imu.size() &&
           device.imu[next_imu].stamp_ns <= image->stamp_ns + from_ms(5);
         ++next_imu)
      if (const auto ok = engine.add_imu(device.imu[next_imu]); !ok) return tl::unexpected(ok.error());
    auto frame = engine.add_depth(*image);
    run.cpu_s += cpu_seconds() - cpu_before;
    if (!frame) return tl::unexpected(frame.error());
    run.frames.push_back(std::move(*frame));
    run.truth.push_back((*truth)[i].T_map_sensor);
    if (std::string now = engine.problem(); !now.empty()) run.problem = std::move(now);
    if (const auto request = engine.take_request()) {
      if (last_request && run.frames[*last_request].odom_segment == request->odom_segment) {
        const Pose E = run.error(*last_request, run.frames.size() - 1);
        ++run.motions;
        run.motions_within += E.translation().norm() <= 3 * request->odom_sd_m &&
                              rotation_angle_rad(E) <= 3 * request->odom_sd_rad;
      }
      last_request = run.frames.size() - 1;
      ++run.requests;
      run.lpc_bytes += request->lpc.bytes.size();
      run.extra_bytes += request->extra.bytes.size();
      if (request->up_sensor) {
        const Eigen::Vector3d up_true = run.truth.back().linear().transpose() * Eigen::Vector3d::UnitZ();
        run.worst_up_deg = std::max(
            run.worst_up_deg, degrees(std::acos(std::clamp(up_true.dot(*request->up_sensor), -1.0, 1.0))));
      }
    }
  }
  const auto joules_after = package_joules();
  if (joules_before && joules_after && *joules_after > *joules_before)
    run.package_j = *joules_after - *joules_before;
  return run;
}

void print_drift(const std::string& name, const DriftRun& run, bool frames) {
  const auto& f = run.frames;
  double path = 0, good = 0, discontinuity_m = 0;
  std::vector<double> latency, step_mm, residual_mm;
  int icp = 0, standing = 0, ransac = 0, guess = 0, dull = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    latency.push_back(f[i].latency_ms);
    if (f[i].residual_m > 0) residual_mm.push_back(1e3 * f[i].residual_m);
    icp += f[i].source == PoseSource::icp || f[i].source == PoseSource::inertial;
    standing += f[i].source == PoseSource::standing;
    ransac += f[i].source == PoseSource::ransac;
    guess += f[i].source == PoseSource::guess;
    dull += !f[i].informative;
    if (frames) {
      const Pose E = run.error(0, i);
      const double step_m = i > 0 ? run.error(i - 1, i).translation().norm() : 0;
      fmt::print("{:4d} {:8} inf {} conv {} seg {} step {:.1f} mm err {:.1f} mm {:.3f} deg\n", i,
                 name_of(f[i].source), f[i].informative, f[i].converged, f[i].odom_segment, 1e3 * step_m,
                 1e3 * E.translation().norm(), degrees(rotation_angle_rad(E)));
    }
    if (i == 0) continue;
    path += distance_m(run.truth[i], run.truth[i - 1]);
    const Pose E = run.error(i - 1, i);
    step_mm.push_back(1e3 * E.translation().norm());
    if (f[i].converged) discontinuity_m = std::max(discontinuity_m, E.translation().norm());
    good += degrees(rotation_angle_rad(E)) <= 3 && E.translation().norm() <= 0.1;
  }
  const Pose end = run.error(0, f.size() - 1);
  const DriftSpread spread = spread_of(run);
  const double seconds = std::max(to_seconds(f.back().stamp_ns - f.front().stamp_ns), 1e-3);
  fmt::print(
      "{:28} path {:5.2f} m  end {:5.1f} mm {:5.2f} %  {:5.2f} deg  rms {:.1f} mm  second {:.1f}/{:.1f} mm "
      "{:.2f} deg  pairs {:.3f} (median {:.1f} mm, jump "
      "{:.0f} mm)  "
      "latency {:.2f}/{:.2f} ms  icp {} standing {} ransac {} guess {} dull {} segments {}  up {:.2f} deg  lpc "
      "{} B  "
      "around {} B  residual {:.1f} mm  {:.1f} ms of CPU per second  {}/{} motions within 3 sd{}{}\n",
      name, path, 1e3 * end.translation().norm(), 100 * end.translation().norm() / std::max(path, 0.1),
      degrees(rotation_angle_rad(end)), 1e3 * spread.trajectory_m, 1e3 * spread.second_median_m,
      1e3 * spread.second_p90_m, degrees(spread.second_median_rad), good / static_cast<double>(f.size() - 1),
      quantile(step_mm, 0.5), 1e3 * discontinuity_m, quantile(latency, 0.5), quantile(latency, 0.9), icp,
      standing, ransac, guess, dull, f.back().odom_segment + 1, run.worst_up_deg,
      run.lpc_bytes / static_cast<std::size_t>(std::max(run.requests, 1)),
      run.extra_bytes / static_cast<std::size_t>(std::max(run.requests, 1)), quantile(residual_mm, 0.5),
      1e3 * run.cpu_s / seconds, run.motions_within, run.motions,
      run.package_j ? fmt::format("  {:.2f} J per second, reading of files included", *run.package_j / seconds)
                    : "",
      run.problem.empty() ? "" : "  complaint: " + run.problem);
}

std::string energy_obstacle() {
  if (package_joules()) return "";
  return fmt::format("{} cannot be read (no RAPL, or for root alone)", kEnergyCounter);
}

}  // namespace liloc::bench

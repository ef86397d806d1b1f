#pragma once
#include <optional>
#include <vector>

#include "common/base/result.hpp"
#include "common/geometry/pose.hpp"
#include "common/registration/points/patches.hpp"
#include "common/registration/scan/local_map.hpp"

namespace liloc {

/// Where the sensor is believed to be before the match, and how sure that is. Its uncertainty enters the
/// solution as a prior: where the scene says nothing, the guess decides.
struct MotionGuess {
  Pose T_map_sensor = Pose::Identity();
  Matrix6d covariance = Matrix6d::Identity();  ///< [rotation; translation], map axes about the sensor

  MotionGuess() = default;
  MotionGuess(const Pose& T, const Matrix6d& covariance_map) : T_map_sensor(T), covariance(covariance_map) {}
  /// One standard deviation for each axis.
  MotionGuess(const Pose& T, double sd_rad, double sd_m);
  /// Of the axis that is known least.
  [[nodiscard]] double sd_rad() const;
  [[nodiscard]] double sd_m() const;
  /// Squared Mahalanobis distance of a pose from the guess.
  [[nodiscard]] double squared_mahalanobis(const Pose& T_map_sensor_other) const;
};

/// Defaults are by hand where nothing else is said.
struct ScanMatchOptions {
  int max_iterations = 12;
  std::optional<Pose> start;       ///< where the steps begin; empty: at the guess, which stays the prior
  std::size_t max_surfels = 1500;  ///< of the frame; more are thinned evenly
  double min_flatness = 0.4;       ///< surfels below have no trustworthy normal
  double stop_rad = 2e-5, stop_m = 5e-5;
  double sensor_sd_m = 0.006;    ///< of a surfel's distance to a plane: noise, calibration and model
  double noise_per_m2 = 0.0008;  ///< and what grows with the square of the range
  double kernel_deviations = 3;  ///< of what noise and the guess explain, where a surfel begins to count less
  double kernel_min_m = 0.02;    ///< never narrower: the map's own surfels err by as much at edges
  double kernel_max_m = 0.10;    ///< nor wider
  PatchOptions patch;            ///< what stands or moves together counts together
  double wide_prior_m = 0.08;    ///< a guess that may shift points by more looks two cells far for planes,
  double kernel_wide_m = 0.25;   ///< with a kernel as wide as this
  double observed_noise =
      3;  ///< a direction with less information than so many times what noisy normals feign,
  double observed_share = 1e-4;  ///< or with less of the whole than so, is left to the guess
};

/// Why a match went no further.
enum class ScanStop {
  converged,        ///< the last step was below the stop limits
  too_few_pairs,    ///< hardly a surfel of the frame has a plane near
  iteration_limit,  ///< `max_iterations` are over
};

struct ScanMatch {
  Pose T_map_sensor = Pose::Identity();
  /// Of the scene and the prior, [rotation; translation], map axes about the sensor's position.
  Matrix6d information = Matrix6d::Zero();
  int unobserved = 0;  ///< directions left to the guess (0..6)
  /// Projector onto what the scene shows, map axes about the sensor: along a unit motion u, u^T observed u is
  /// the share that was measured, 0 (the guess decides) .. 1. One radian counts as two metres.
  Matrix6d observed = Matrix6d::Zero();
  double overlap = 0;  ///< share of the used surfels with a plane within three sensor deviations, 0..1
  double paired = 0;   ///< share of the used surfels with any plane near, 0..1
  double rmse_m = 0;   ///< distance to the planes over the overlap
  int iterations = 0;
  ScanStop stop = ScanStop::iteration_limit;

  [[nodiscard]] bool converged() const { return stop == ScanStop::converged; }
};

/// Point-to-plane registration of a frame's surfels (sensor frame) to the map, with a Geman-McClure kernel
/// for each pair and for each patch, as wide as noise and the guess explain, the guess as a prior and
/// unobserved directions left to it (after "solution remapping", Zhang, Kaess, Singh 2016). Pure. `now_ns` is
/// the frame's stamp: surfels of the map younger than its trust limit weigh less. Errors: an empty map or
/// frame. A poor fit is a result, not an error.
[[nodiscard]] Result<ScanMatch> match_scan(const LocalMap& map, const std::vector<Surfel>& frame,
                                           const MotionGuess& guess, StampNs now_ns,
                                           const ScanMatchOptions& options = {});

}  // namespace liloc

#pragma once
// Which values of each type a saved answer holds, in their order. One list serves both ways.
#include <optional>
#include <vector>

#include "common/base/ids.hpp"
#include "server/answers/archive.hpp"
#include "server/localization/answered.hpp"

namespace liloc::answers {

/// T, or const T where it is written.
template <class V, class T>
concept Of = std::same_as<std::remove_const_t<V>, T>;

// So that a damaged file ends early: of clouds and poses as idl/liloc.idl has them, of the rest far more than a
// server keeps; by hand.
constexpr std::size_t kMostText = 4096, kMostCloudBytes = 262'144, kMostLocalPoses = 256, kMostTracks = 64,
                      kMostSpots = 64, kMostCells = 1'000'000;

template <class A, Number... T>
void numbers(A& a, T&... values) {
  (a.number(values), ...);
}

template <class A, class E>
void choice(A& a, E& value, std::uint8_t most) {
  auto id = static_cast<std::uint8_t>(value);
  a.number(id);
  a.require(id <= most, "an unknown choice");
  if constexpr (A::kReads) value = static_cast<E>(id);
}

template <class A, class Text>
requires Of<Text, std::string>
void text(A& a, Text& value, std::size_t most = kMostText) {
  const std::size_t size = a.count(value.size(), most);
  if constexpr (A::kReads) value.resize(a.holds(size) ? size : 0);
  a.block(value.data(), value.size());
}

/// Each element by `each`; a vector or a deque.
template <class A, class List, class Each>
void list(A& a, List& values, std::size_t most, Each each) {
  const std::size_t size = a.count(values.size(), most);
  if constexpr (A::kReads) values.assign(a.holds(size) ? size : 0, {});  // an element is a byte or more
  for (auto& value : values) each(value);
}

template <class A, class Maybe, class Each>
void maybe(A& a, Maybe& value, Each each) {
  bool there = value.has_value();
  a.number(there);
  if constexpr (A::kReads)
    if (there) value.emplace();
  if (value) each(*value);
}

template <class A, class Matrix>
void matrix(A& a, Matrix& m) {
  for (Eigen::Index i = 0; i < m.size(); ++i) a.number(m.data()[i]);
}

template <class A, Of<Pose> V>
void fields(A& a, V& T) {
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) a.number(T.matrix()(row, column));
  const Eigen::Matrix3d R = T.linear();
  a.require((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-2 && R.determinant() > 0 &&
                T.translation().norm() < 1e5,
            "a pose that is none");
}

template <class A, Of<Camera> V>
void fields(A& a, V& c) {
  numbers(a, c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.depth_scale_m);
  a.require(c.validated("camera").has_value(), "a camera that is none");
}

template <class A, Of<EncodedCloud> V>
void fields(A& a, V& cloud) {
  choice(a, cloud.codec, 3);
  const std::size_t size = a.count(cloud.bytes.size(), kMostCloudBytes);
  if constexpr (A::kReads) cloud.bytes.resize(a.holds(size) ? size : 0);
  a.block(cloud.bytes.data(), cloud.bytes.size());
}

template <class A, Of<SpotRequest> V>
void fields(A& a, V& r) {
  text(a, r.client_id);
  a.require(valid_id(r.client_id, "client_id").has_value(), "a name that is none");
  numbers(a, r.seq, r.stamp_ns, r.odom_segment, r.odom_sd_rad, r.odom_sd_m, r.voxel_size_m, r.up_sd_rad, r.cold,
          r.ceiling_stamp_ns, r.sent_ns);
  fields(a, r.T_odom_sensor);
  list(a, r.local_poses, kMostLocalPoses, [&](auto& local) {
    numbers(a, local.stamp_ns, local.informative);
    fields(a, local.T_odom_sensor);
  });
  fields(a, r.lpc);
  fields(a, r.extra);
  fields(a, r.view.camera);
  numbers(a, r.view.min_range_m, r.view.max_range_m);
  maybe(a, r.up_sensor, [&](auto& up) {
    matrix(a, up);
    a.require(std::abs(up.norm() - 1) < 1e-2, "a direction that is none");
  });
}

template <class A, Of<SpotReply> V>
void fields(A& a, V& r) {
  text(a, r.client_id);
  numbers(a, r.seq, r.stamp_ns, r.gpc_stamp_ns);
  choice(a, r.status, static_cast<std::uint8_t>(SpotStatus::refused));
  choice(a, r.reason, static_cast<std::uint8_t>(Reason::no_answer));
  text(a, r.text);
  maybe(a, r.T_map_sensor, [&](auto& T) { fields(a, T); });
  matrix(a, r.covariance);
  numbers(a, r.fitness, r.inlier_rmse_m, r.overlap, r.margin, r.confidence);
  choice(a, r.advice, static_cast<std::uint8_t>(Advice::clear_view));
  maybe(a, r.T_map_odom, [&](auto& T) { fields(a, T); });
  a.number(r.odom_segment);
}

template <class A, Of<LocalizerOptions> V>
void fields(A& a, V& o) {
  choice(a, o.method, static_cast<std::uint8_t>(Method::static_noopt));
  maybe(a, o.verify, [&](auto& v) { choice(a, v, static_cast<std::uint8_t>(Verify::none)); });
  maybe(a, o.icp, [&](auto& v) { choice(a, v, static_cast<std::uint8_t>(Icp::plane)); });
  numbers(a, o.voxel_size_m, o.sampling, o.seed, o.threads, o.risk);
  text(a, o.server_id);
  a.require(o.voxel_size_m >= 0.01 && o.voxel_size_m <= 0.5, "a voxel size beyond 0.01 to 0.5 m");
  a.require(o.sampling >= 0.01 && o.sampling <= 1, "a sampling beyond 0.01 to 1");
  a.require(o.threads >= 1 && o.threads <= 64, "a number of threads beyond 1 to 64");
  a.require(o.validated().has_value(), "options that do not go together");
}

template <class A, Of<LookTerms> V>
void fields(A& a, V& l) {
  numbers(a, l.support, l.contradiction, l.excess, l.misfit);
}

template <class A, Of<Hypothesis> V>
void fields(A& a, V& h) {
  fields(a, h.alignment.T_target_source);
  numbers(a, h.alignment.fitness, h.alignment.inlier_rmse_m, h.alignment.pairs, h.alignment.pair_share,
          h.alignment.converged);
  numbers(a, h.judgement.agree, h.judgement.conflict, h.judgement.map_agree, h.judgement.map_conflict,
          h.judgement.map_seen, h.judgement.score);
}

template <class A, Of<SurfaceBits> V>
void fields(A& a, V& bits) {
  double sum = bits.sum();
  SurfaceBits::Worth worth = bits.worth();
  std::vector<std::pair<std::uint64_t, float>> cells(worth.begin(), worth.end());
  a.number(sum);
  list(a, cells, kMostCells, [&](auto& cell) { numbers(a, cell.first, cell.second); });
  if constexpr (A::kReads) bits = SurfaceBits({cells.begin(), cells.end()}, sum);
}

template <class A, Of<Track> V>
void fields(A& a, V& t) {
  fields(a, t.T_map_odom);
  list(a, t.looks, kMostSpots, [&](auto& look) { fields(a, look); });
  fields(a, t.surfaces);
  fields(a, t.latest);
  a.number(t.fits);
}

template <class A, Of<Followed> V>
void fields(A& a, V& f) {
  fields(a, f.estimate.T_map_sensor);
  matrix(a, f.estimate.covariance);
  fields(a, f.T_odom_sensor);
  a.number(f.log_odds);
  fields(a, f.usual);
}

}  // namespace liloc::answers

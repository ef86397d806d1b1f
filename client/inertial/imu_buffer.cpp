#include "client/inertial/imu_buffer.hpp"

#include <algorithm>

#include "client/inertial/sample_stamps.hpp"

namespace liloc {
namespace {

constexpr double kLargestGapS = to_seconds(kLargestGapNs);  // or from a span's end to the next sample
// Samples of context for the filters on either side of a span; six standard deviations of the Gaussian filter.
constexpr int kMargin = 12;

}  // namespace

void ImuBuffer::add(Entry entry, double keep_seconds) {
  entries_.push_back(std::move(entry));
  const StampNs newest_ns = entries_.back().raw.stamp_ns;
  while (to_seconds(newest_ns - entries_.front().raw.stamp_ns) > keep_seconds) entries_.pop_front();
}

void ImuBuffer::take_off(StampNs ahead_ns) {
  for (Entry& entry : entries_) entry.raw.stamp_ns -= ahead_ns;
}

void ImuBuffer::scale_forces(double factor) {
  for (Entry& entry : entries_) entry.raw.specific_force_m_s2 *= factor;
}

void ImuBuffer::set_up(const Eigen::Vector3d& up_imu, const Eigen::Vector3d& gyro_bias_rad_s) {
  Eigen::Vector3d up = up_imu;
  for (std::size_t i = entries_.size(); i-- > 0;) {
    entries_[i].up = up;
    if (i == 0) break;
    const double dt = to_seconds(entries_[i].raw.stamp_ns - entries_[i - 1].raw.stamp_ns);
    up = so3_exp(dt * (entries_[i].raw.angular_velocity_rad_s - gyro_bias_rad_s)) * up;
  }
}

std::size_t ImuBuffer::first_after(StampNs stamp_ns) const {
  const auto it = std::upper_bound(entries_.begin(), entries_.end(), stamp_ns,
                                   [](StampNs t, const Entry& e) { return t < e.raw.stamp_ns; });
  return static_cast<std::size_t>(it - entries_.begin());
}

const ImuBuffer::Entry& ImuBuffer::at(StampNs stamp_ns) const {
  const std::size_t after = first_after(stamp_ns);
  return entries_[after == 0 ? 0 : after - 1];
}

bool ImuBuffer::surrounds(StampNs stamp_ns) const {
  return !entries_.empty() && entries_.front().raw.stamp_ns <= stamp_ns &&
         entries_.back().raw.stamp_ns >= stamp_ns;
}

bool ImuBuffer::covers(StampNs from_ns, StampNs to_ns) const {
  if (entries_.size() < 2 || from_ns >= to_ns) return false;
  const std::size_t begin = first_after(from_ns), end = first_after(to_ns);
  if (begin == 0 || end == 0) return false;
  if (to_seconds(to_ns - entries_[end - 1].raw.stamp_ns) > kLargestGapS || entries_[end - 1].stale)
    return false;
  for (std::size_t i = begin; i < end; ++i)
    if (to_seconds(entries_[i].raw.stamp_ns - entries_[i - 1].raw.stamp_ns) > kLargestGapS || entries_[i].stale)
      return false;
  return true;
}

std::vector<ImuSample> ImuBuffer::samples(StampNs from_ns, StampNs to_ns) const {
  const std::size_t begin = first_after(from_ns), end = first_after(to_ns);
  const auto at = [&](std::size_t after, StampNs stamp_ns) {
    if (after == entries_.size())
      return ImuSample{stamp_ns, entries_.back().raw.angular_velocity_rad_s,
                       entries_.back().raw.specific_force_m_s2};
    const ImuSample &a = entries_[after - 1].raw, &b = entries_[after].raw;
    const double share = to_seconds(stamp_ns - a.stamp_ns) / to_seconds(b.stamp_ns - a.stamp_ns);
    return ImuSample{stamp_ns, (1 - share) * a.angular_velocity_rad_s + share * b.angular_velocity_rad_s,
                     (1 - share) * a.specific_force_m_s2 + share * b.specific_force_m_s2};
  };
  std::vector<ImuSample> samples{at(begin, from_ns)};
  for (std::size_t i = begin; i < end; ++i) samples.push_back(entries_[i].raw);
  if (samples.back().stamp_ns < to_ns) samples.push_back(at(end, to_ns));
  return samples;
}

std::vector<InertialSample> ImuBuffer::span(StampNs from_ns, StampNs to_ns, const Offsets& offsets,
                                            double gaussian_sd, int average_window) const {
  const std::size_t begin = first_after(from_ns) - 1, end = first_after(to_ns);
  const std::size_t low = begin - std::min<std::size_t>(begin, kMargin);
  const std::size_t high = std::min(entries_.size(), end + kMargin);
  std::vector<Eigen::Vector3d> rates, forces;
  for (std::size_t i = low; i < high; ++i) {
    rates.push_back(entries_[i].raw.angular_velocity_rad_s - offsets.gyro_bias_rad_s);
    forces.emplace_back(entries_[i].raw.specific_force_m_s2 - offsets.gravity_m_s2 * entries_[i].up);
  }
  if (average_window > 0) forces = moving_average(gaussian_smoothed(forces, gaussian_sd), average_window);
  std::vector<InertialSample> samples;
  for (std::size_t i = begin; i < end; ++i)
    samples.push_back({std::max(entries_[i].raw.stamp_ns, from_ns), rates[i - low], forces[i - low]});
  if (samples.back().stamp_ns < to_ns) {
    samples.push_back(samples.back());
    samples.back().stamp_ns = to_ns;
  }
  return samples;
}

}  // namespace liloc

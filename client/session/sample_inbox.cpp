#include "client/session/sample_inbox.hpp"

#include <algorithm>

namespace liloc {
namespace {

constexpr std::size_t kMost = 4000;  // 20 s at 200 Hz, while no frame comes; by hand

template <class Sample>
void push(std::deque<Sample>& samples, const Sample& sample) {
  if (samples.size() >= kMost) samples.pop_front();
  samples.push_back(sample);
}

}  // namespace

void SampleInbox::add(const ImuSample& sample) {
  const std::scoped_lock lock(mutex_);
  push(samples_.imu, sample);
}

void SampleInbox::add(const OdometrySample& sample) {
  {
    const std::scoped_lock lock(mutex_);
    push(samples_.odometry, sample);
    newest_odometry_ns_ = sample.stamp_ns;  // not the largest: one stamp far ahead would end all waiting
  }
  odometry_came_.notify_all();
}

SampleInbox::Samples SampleInbox::take() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(samples_, {});
}

void SampleInbox::await_odometry(StampNs stamp_ns, std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  if (newest_odometry_ns_ == 0) return;
  odometry_came_.wait_for(lock, at_most, [&] { return closed_ || newest_odometry_ns_ >= stamp_ns; });
}

void SampleInbox::close() {
  {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
  }
  odometry_came_.notify_all();
}

}  // namespace liloc

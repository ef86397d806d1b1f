#include "proto-tests/replay/timeline.hpp"

#include <algorithm>
#include <tuple>

namespace liloc::replay {
namespace {

template <class Items>
void add_events(std::vector<Event>& events, Event::Kind kind, std::size_t source, const Items& items,
                StampNs ahead_ns = 0) {
  for (std::size_t i = 0; i < items.size(); ++i)
    events.push_back({items[i].stamp_ns, kind, source, i, items[i].stamp_ns - ahead_ns});
}

}  // namespace

std::vector<Event> timeline(const Recording& recording, StampNs device_ahead_ns) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < recording.lidars.size(); ++i)
    add_events(events, Event::Kind::ceiling, i, recording.lidars[i].depth);
  for (std::size_t i = 0; i < recording.devices.size(); ++i) {
    add_events(events, Event::Kind::imu, i, recording.devices[i].imu, device_ahead_ns);
    add_events(events, Event::Kind::device, i, recording.devices[i].depth, device_ahead_ns);
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return std::tie(a.due_ns, a.kind, a.source, a.index) < std::tie(b.due_ns, b.kind, b.source, b.index);
  });
  return events;
}

double recorded_seconds(const std::vector<Event>& events) {
  return events.empty() ? 0 : to_seconds(events.back().due_ns - events.front().due_ns);
}

FrameReader::FrameReader(const Recording& recording, const std::vector<Event>& events, std::size_t ahead)
    : recording_(recording),
      events_(events),
      ahead_(std::max<std::size_t>(ahead, 1)),
      worker_([this](const std::stop_token& stop) { run(stop); }) {}

void FrameReader::run(const std::stop_token& stop) {
  for (const Event& event : events_) {
    if (event.kind == Event::Kind::imu) continue;
    const bool ceiling = event.kind == Event::Kind::ceiling;
    const DepthFile& file = ceiling ? recording_.lidars[event.source].depth[event.index]
                                    : recording_.devices[event.source].depth[event.index];
    auto image = read_depth(file, ceiling ? recording_.lidars[event.source].info.camera
                                          : recording_.devices[event.source].info.camera);
    std::unique_lock lock(mutex_);
    changed_.wait(lock, stop, [this] { return decoded_.size() < ahead_; });
    if (stop.stop_requested()) return;
    decoded_.push_back(std::move(image));
    changed_.notify_all();
  }
}

Result<DepthImage> FrameReader::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !decoded_.empty(); });
  Result<DepthImage> image = std::move(decoded_.front());
  decoded_.pop_front();
  changed_.notify_all();
  return image;
}

}  // namespace liloc::replay

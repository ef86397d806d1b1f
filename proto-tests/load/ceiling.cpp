#include "proto-tests/load/ceiling.hpp"

#include <thread>

#include "proto-tests/replay/processes.hpp"
#include "proto-tests/replay/streams.hpp"

namespace liloc::load {
namespace {

constexpr double kLate_s = 0.2;  // under two periods of a LiDAR

}  // namespace

Result<std::uint64_t> stream_ceiling(const Script& script, const RunClock& clock, double end_s,
                                     const wire::DomainOptions& seat) {
  auto participant = wire::Participant::create(seat);
  if (!participant) return tl::unexpected(participant.error());
  auto streams = replay::Streams::create(*participant, script.site, {});
  if (!streams) return tl::unexpected(streams.error());
  const std::size_t count = script.ceiling.size();
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; !replay::stop_requested(); ++i) {
    const std::size_t lap = i / count, at = i % count;
    const bool back = lap % 2 == 1;
    const CeilingFrame& frame = script.ceiling[back ? count - 1 - at : at];
    const double due_s = clock.ceiling_from_s + static_cast<double>(lap) * script.seconds +
                         (back ? script.seconds - frame.at_s : frame.at_s);
    if (due_s > end_s) break;
    if (due_s < clock.now_s() - kLate_s) continue;  // of the time until this process stood
    std::this_thread::sleep_until(clock.at(due_s));
    DepthImage image = frame.image;
    image.stamp_ns = clock.start_ns + from_seconds(due_s);
    if (const Status sent = streams->ceiling(frame.lidar, image); !sent) return tl::unexpected(sent.error());
    bytes += image.units.size() * sizeof image.units[0];
  }
  return bytes;
}

}  // namespace liloc::load

// What it costs to keep the room's indices as the room changes: from those before against anew, in one run.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>

#include "proto-tests/bench/spot_bench_sites.hpp"
#include "server/global_cloud/global_cloud.hpp"

namespace liloc::bench {
namespace {

double thread_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double ms_of(const Work& work) {
  const double before = thread_cpu_ms();
  work();
  return thread_cpu_ms() - before;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Every room that the newest frames of a site make, each built both ways.
struct Costs {
  std::vector<double> clouds_ms, anew_ms, from_before_ms, ratio, stay;
  std::size_t points = 0;

  void add(const StitchedRoom& room, const std::shared_ptr<const StitchedRoom>& before) {
    clouds_ms.push_back(ms_of([&] {
      for (const auto& part : room.parts()) (void)part->cloud_map();
    }));
    const StitchedRoom anew(room.parts(), {}), next(room.parts(), {}, before);
    anew_ms.push_back(ms_of([&] { anew.prepare(false); }));
    from_before_ms.push_back(ms_of([&] { next.prepare(false); }));
    ratio.push_back(anew_ms.back() / from_before_ms.back());
    const Cloud& cloud = anew.surfaces()->cloud;
    points = cloud.size();
    const std::size_t fresh = change_between(before->surfaces()->cloud, cloud).fresh.size();
    stay.push_back(1.0 - static_cast<double>(fresh) / static_cast<double>(std::max<std::size_t>(1, points)));
  }
};

Costs run(const Stage& stage, double skip_s) {
  GlobalCloud cloud(stage.site, {});
  std::shared_ptr<const StitchedRoom> last;
  std::optional<StampNs> start_ns;
  Costs costs;
  while (auto event = stage.next()) {
    auto* frame = std::get_if<sim::LidarFrame>(&event->payload);
    if (frame == nullptr) continue;
    const StampNs stamp_ns = frame->image.stamp_ns;
    if (!start_ns) start_ns = stamp_ns;
    if (!cloud.add_depth(frame->lidar, std::move(frame->image))) continue;
    const auto snapshot = cloud.nearest(stamp_ns - from_ms(80.0));  // of which most LiDARs have a frame
    if (!snapshot || (*snapshot)->room() == last) continue;
    const bool all = (*snapshot)->frames().size() == stage.site.global_lidars.size();
    if (!all) continue;
    if (last && stamp_ns > *start_ns + from_seconds(skip_s)) costs.add(*(*snapshot)->room(), last);
    last = (*snapshot)->room();
    last->prepare(false);
  }
  return costs;
}

}  // namespace
}  // namespace liloc::bench

int main(int argc, char** argv) {
  using namespace liloc;
  CLI::App app{"Cost of the room's indices where it changes, against building them anew"};
  std::vector<std::string> recordings;
  std::vector<std::uint64_t> seeds;
  bench::SiteStyle style;
  double seconds = 14, skip_s = 5;
  app.add_option("recordings", recordings, "folders of recordings");
  app.add_option("--seeds", seeds, "simulated sites as in liloc_spot_bench");
  app.add_option("--world", style.world, "of the simulated sites: 1 or 2");
  app.add_option("--seconds", seconds, "of each simulated site");
  app.add_option("--skip-seconds", skip_s, "left out at the start, while everything is new");
  CLI11_PARSE(app, argc, argv);
  fmt::print("{:<58} {:>6} {:>8} {:>6} {:>9} {:>9} {:>9} {:>6}\n", "site", "rooms", "points", "stay",
             "clouds ms", "anew ms", "from last", "ratio");
  const auto print = [&](const Result<bench::Stage>& stage) {
    if (!stage) return fmt::print("{}\n", stage.error().message);
    const bench::Costs c = bench::run(*stage, skip_s);
    fmt::print("{:<58} {:>6} {:>8} {:>6.3f} {:>9.1f} {:>9.1f} {:>9.1f} {:>6.2f}\n", stage->name, c.ratio.size(),
               c.points, bench::median(c.stay), bench::median(c.clouds_ms), bench::median(c.anew_ms),
               bench::median(c.from_before_ms), bench::median(c.ratio));
  };
  for (const std::string& folder : recordings) print(bench::recorded_stage(folder));
  for (const std::uint64_t seed : seeds) print(bench::simulated_stage(seed, seconds, style));
  return 0;
}

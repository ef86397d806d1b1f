// A whole site in one terminal: simulated LiDARs and devices, the real server, a real client per device.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <thread>

#include "common/command/checks.hpp"
#include "proto-tests/replay/fleet.hpp"
#include "proto-tests/toolbox/commands.hpp"
#include "proto-tests/toolbox/device_table.hpp"
#include "proto-tests/toolbox/live_site.hpp"

namespace liloc::toolbox {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct DemoArguments {
  bool keep = false;
  double seconds = 30;
  std::uint64_t seed = 7;
  int people = 3, devices = 2;
};

/// A folder of this run, gone with it.
class RunFolder {
 public:
  RunFolder() {
    std::string name = (fs::temp_directory_path() / "liloc-demo-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  ~RunFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

sim::SimOptions site_options(const DemoArguments& arguments) {
  sim::SimOptions options;
  options.seed = arguments.seed;
  options.people = arguments.people;
  options.lidars = 3;
  options.lidar_rate_hz = 5;
  options.devices = arguments.devices;
  options.device_rate_hz = 10;
  options.seconds = arguments.keep ? 3600 : arguments.seconds;
  return options;
}

replay::FleetCommand fleet_command(const LiveSite& site, const fs::path& folder, int domain) {
  replay::FleetCommand fleet;
  fleet.programs = replay::program_folder();
  fleet.domain = domain;
  fleet.site_file = folder / "site.json";
  fleet.server_log = folder / "server.log";
  for (const DeviceInfo& device : site.devices())
    fleet.clients.push_back({device.id, folder / (device.id + ".json"), folder / device.id, {}});
  return fleet;
}

/// Follows the clients' traces and holds them against the truth.
class Watch {
 public:
  Watch(const LiveSite& site, const fs::path& folder) : site_(site) {
    for (const DeviceInfo& device : site.devices()) {
      tails_.emplace_back(folder / device.id);
      rows_.push_back({});
      rows_.back().id = device.id;
      last_pose_.emplace_back();
    }
  }

  void look() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      DeviceRow& row = rows_[i];
      row.news = tails_[i].poll();
      for (const StampedPose& pose : row.news.poses) add_pose(i, pose);
      const bool fresh = row.T_map_sensor && Clock::now() - last_pose_[i] < std::chrono::seconds(1);
      row.state = !row.T_map_sensor ? "searching" : fresh ? "tracking" : "lost";
    }
  }

  [[nodiscard]] const std::vector<DeviceRow>& rows() const { return rows_; }
  [[nodiscard]] bool all_located() const {
    return std::all_of(rows_.begin(), rows_.end(),
                       [](const DeviceRow& row) { return row.first_pose_s.has_value(); });
  }

 private:
  void add_pose(std::size_t device, const StampedPose& pose) {
    DeviceRow& row = rows_[device];
    row.T_map_sensor = pose.T_map_sensor;
    last_pose_[device] = Clock::now();
    if (!row.first_pose_s) row.first_pose_s = to_seconds(pose.stamp_ns - site_.first_frame_ns(device));
    const auto truth = site_.truth(device, pose.stamp_ns);
    if (!truth) return;
    row.error_cm = 100 * distance_m(*truth, pose.T_map_sensor);
    row.error_deg = degrees(angle_between_rad(*truth, pose.T_map_sensor));
    row.errors_cm.push_back(*row.error_cm);
    row.errors_deg.push_back(*row.error_deg);
  }

  const LiveSite& site_;
  std::vector<TraceTail> tails_;
  std::vector<DeviceRow> rows_;
  std::vector<Clock::time_point> last_pose_;  ///< when each device's newest pose was read
};

/// Redraws until the time is over. Errors: a program ended, or the site stopped sending.
Status watch_live(LiveSite& site, replay::Fleet& fleet, Watch& watch, const DemoArguments& arguments) {
  const bool terminal = isatty(STDOUT_FILENO) == 1;
  const auto pause = std::chrono::milliseconds(terminal ? 250 : 5000);
  Screen screen(terminal);
  const auto start = Clock::now();
  auto next_look = start + pause;
  site.start();
  while (!site.over() && !replay::stop_requested()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (auto status = fleet.check(); !status) return status;
    if (Clock::now() < next_look) continue;
    next_look += pause;
    watch.look();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    std::vector<std::string> lines{
        fmt::format("{:.0f} s{}; {} ceiling LiDARs, {} people; Ctrl-C ends it", seconds,
                    arguments.keep ? "" : fmt::format(" of {:.0f} s", arguments.seconds),
                    site.site().global_lidars.size(), arguments.people)};
    for (std::string& line : table_lines(watch.rows())) lines.push_back(std::move(line));
    screen.show(lines);
  }
  watch.look();
  return site.trouble();
}

Status run_site(const DemoArguments& arguments, const fs::path& folder, bool& all_located) {
  const auto domain = replay::free_domain();
  if (!domain) return tl::unexpected(domain.error());
  auto site = LiveSite::create(site_options(arguments), *domain, "");
  if (!site) return tl::unexpected(site.error());
  if (auto status = (*site)->describe(folder); !status) return status;
  auto fleet = replay::Fleet::start(fleet_command(**site, folder, *domain));
  if (!fleet) return tl::unexpected(fleet.error());
  fmt::print("one liloc-server, {} liloc-clients, a simulated office, on DDS domain {} of the loopback\n",
             arguments.devices, *domain);
  Status status = fleet->wait_until([&] { return (*site)->all_heard(); }, std::chrono::seconds(20),
                                    "server and clients listening to the streams");
  if (!status) return status;
  Watch watch(**site, folder);
  status = watch_live(**site, *fleet, watch, arguments);
  Status stopped = fleet->stop();
  if (!status) return status;
  if (!stopped) return stopped;
  for (const std::string& line : summary_lines(watch.rows())) fmt::print("{}\n", line);
  all_located = watch.all_located();
  return {};
}

int run(const DemoArguments& arguments) {
  replay::catch_stop_signals();
  const RunFolder folder;
  if (folder.path().empty())
    return complain({"demo: no temporary folder can be made; set TMPDIR to a writable one"}, kFailed);
  bool all_located = false;
  if (auto status = run_site(arguments, folder.path(), all_located); !status)
    return complain(status.error(), kFailed);
  if (!all_located) return complain({"demo: not every device was located"}, kFailed);
  return kDone;
}

}  // namespace

void add_demo(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<DemoArguments>();
  CLI::App* command =
      app.add_subcommand("demo", "A simulated site, the server and its clients, live in a table");
  command->add_flag("--keep", arguments->keep, "Go on until Ctrl-C");
  command->add_option("--seconds", arguments->seconds, "Length of the demo")
      ->check(command::in_range(5.0, 3600.0))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Of the simulated site")
      ->check(command::any_seed())
      ->capture_default_str();
  command->add_option("--people", arguments->people, "Walking about")
      ->check(command::in_range(0, 30))
      ->capture_default_str();
  command->add_option("--devices", arguments->devices, "To be located")
      ->check(command::in_range(1, 16))
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox

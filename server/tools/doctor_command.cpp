#include <fmt/format.h>

#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "common/command/checks.hpp"
#include "common/recording/recording.hpp"
#include "server/tools/command.hpp"
#include "server/tools/diagnosis.hpp"

namespace liloc::toolbox {
namespace {

using namespace std::chrono_literals;

// A status comes every second: so long after the first all have spoken; by hand.
constexpr auto kSecondServer = 1500ms;

struct DoctorArguments {
  wire::DomainOptions seat;
  std::string site_file, device_file;
  double seconds = 5;
};

std::optional<long> setting(const std::string& file) {
  std::ifstream in(file);
  long value = 0;
  return in >> value ? std::optional(value) : std::nullopt;
}

constexpr std::size_t kMostUnreadable = 8;  // texts that are kept, of statuses that cannot be read; by hand

Result<Heard> listen(const DoctorArguments& arguments) {
  const auto participant = wire::Participant::create(arguments.seat);
  if (!participant) return tl::unexpected(participant.error());
  auto dispatcher = wire::Dispatcher::create(*participant);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  std::mutex mutex;
  std::map<std::string, wire::ServerStatus> heard;
  std::set<std::string> unreadable;
  const Status subscribed = wire::subscribe_status(**dispatcher, [&](Result<wire::ServerStatus> status) {
    const std::scoped_lock lock(mutex);
    if (status)
      heard[status->server_id] = std::move(*status);
    else if (unreadable.size() < kMostUnreadable)
      unreadable.insert(status.error().message);
  });
  if (!subscribed) return tl::unexpected(subscribed.error());
  (*dispatcher)->start();
  ProgressBar progress("doctor listens");
  double first_ms = -1;
  for (const Stopwatch watch; watch.elapsed_ms() < 1e3 * arguments.seconds; std::this_thread::sleep_for(20ms)) {
    progress.show(watch.elapsed_ms() / (1e3 * arguments.seconds));
    const std::scoped_lock lock(mutex);
    if (first_ms < 0 && !heard.empty()) first_ms = watch.elapsed_ms();
    if (first_ms >= 0 && watch.elapsed_ms() - first_ms > kSecondServer.count()) break;
  }
  (*dispatcher)->stop();
  Heard found{{}, {unreadable.begin(), unreadable.end()}};
  for (auto& [id, status] : heard) found.servers.push_back(std::move(status));
  return found;
}

/// Whether a file can be read, and what it holds.
template <class T, class Describe>
std::optional<T> read(const std::string& file, Result<T> (*reader)(const std::filesystem::path&),
                      std::vector<Finding>& findings, Describe describe) {
  if (file.empty()) return std::nullopt;
  const auto content = reader(file);
  if (!content) {
    findings.push_back(unreadable_file(content.error()));
    return std::nullopt;
  }
  findings.push_back({Verdict::good, fmt::format("{}: {}", file, describe(*content))});
  return *content;
}

/// No folder is as good as one that is in order.
bool usable(const std::string& credentials_folder, std::vector<Finding>& findings) {
  if (credentials_folder.empty()) return true;
  const auto credentials = read_credentials(credentials_folder);
  for (auto& finding : check_credentials(credentials, std::chrono::system_clock::now()))
    findings.push_back(std::move(finding));
  return credentials.has_value();
}

void hear_servers(const DoctorArguments& arguments, const std::optional<Site>& site,
                  std::vector<Finding>& findings) {
  const auto heard = listen(arguments);
  if (!heard) return findings.push_back(unusable_network(heard.error()));
  for (auto& finding : check_servers(*heard, arguments.seat, site)) findings.push_back(std::move(finding));
}

int run(const DoctorArguments& arguments) {
  std::vector<Finding> findings{
      check_setting("net.core.rmem_max", setting("/proc/sys/net/core/rmem_max"), 4'194'304),
      check_setting("net.core.wmem_max", setting("/proc/sys/net/core/wmem_max"), 1'048'576)};
  const auto site = read<Site>(arguments.site_file, read_site, findings, [](const Site& s) {
    return fmt::format("{} ceiling LiDARs", s.global_lidars.size());
  });
  read<DeviceInfo>(arguments.device_file, read_device, findings, [](const DeviceInfo& d) {
    return fmt::format("{}, {}x{}, {}", d.id, d.camera.width, d.camera.height,
                       d.T_imu_sensor ? "with IMU" : "without IMU");
  });
  if (usable(arguments.seat.credentials, findings)) hear_servers(arguments, site, findings);
  for (const Finding& finding : findings) fmt::print("{}\n", line_of(finding));
  return std::ranges::any_of(findings, [](const Finding& f) { return f.verdict == Verdict::bad; }) ? kFailed
                                                                                                   : kDone;
}

}  // namespace

void add_doctor(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<DoctorArguments>();
  CLI::App* command = app.add_subcommand(
      "doctor", "Look for what keeps devices from being located: kernel, files, servers, ceiling LiDARs");
  command->add_option("--domain", arguments->seat.domain, "DDS domain")
      ->check(command::in_range(0, 230))
      ->capture_default_str();
  command->add_option("--interface", arguments->seat.interface, "Network interface: name, address or auto")
      ->capture_default_str();
  command->add_option("--peer", arguments->seat.peers, "Host of a server; default: this one");
  command->add_option("--credentials", arguments->seat.credentials,
                      "Folder of deploy/credentials, to check and to listen with");
  command->add_option("--site", arguments->site_file, "site.json that the server should serve");
  command->add_option("--device", arguments->device_file, "device.json to check");
  command->add_option("--seconds", arguments->seconds, "Longest time to listen for a server")
      ->check(command::in_range(0.1, 600.0))
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox

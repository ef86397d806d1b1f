#pragma once
// A simulated site that streams over DDS in real time, and remembers the truth for whoever compares.
#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "proto-tests/replay/streams.hpp"
#include "proto-tests/sim/simulation.hpp"

namespace liloc::toolbox {

class LiveSite {
 public:
  /// Joins the DDS domain as its source of streams; with the credentials of a server, which may be everybody,
  /// or with none. Errors: the options, the credentials, or DDS.
  [[nodiscard]] static Result<std::unique_ptr<LiveSite>> create(const sim::SimOptions& options, int domain,
                                                                const std::string& credentials);
  ~LiveSite() = default;
  LiveSite(const LiveSite&) = delete;
  LiveSite& operator=(const LiveSite&) = delete;

  /// Writes FOLDER/site.json and FOLDER/<device>.json, as server and clients read them.
  [[nodiscard]] Status describe(const std::filesystem::path& folder) const;

  /// Streams from now on, on a thread of its own, until the simulation is over or the object goes.
  void start();
  /// The simulation's time is over, or sending failed: see `trouble`.
  [[nodiscard]] bool over() const { return over_; }
  [[nodiscard]] Status trouble() const;

  [[nodiscard]] const std::vector<DeviceInfo>& devices() const { return devices_; }
  [[nodiscard]] const Site& site() const { return site_; }
  [[nodiscard]] bool all_heard() const { return streams_.all_heard(); }
  /// Where a device was at one of its frames of the last minute. Any thread.
  [[nodiscard]] std::optional<Pose> truth(std::size_t device, StampNs stamp_ns) const;
  /// Stamp of a device's first frame; 0 before there is one. Any thread.
  [[nodiscard]] StampNs first_frame_ns(std::size_t device) const;
  /// Images that were left out because rendering fell behind real time. Any thread.
  [[nodiscard]] std::size_t dropped() const { return dropped_; }

 private:
  LiveSite(wire::Participant participant, sim::Simulation simulation, replay::Streams streams);
  void run(const std::stop_token& stop);
  [[nodiscard]] Status send(const sim::SimEvent& event);
  void remember(const sim::DeviceFrame& frame);

  wire::Participant participant_;
  sim::Simulation simulation_;
  replay::Streams streams_;
  const Site site_;  ///< copies: the simulation belongs to the thread
  const std::vector<DeviceInfo> devices_;

  mutable std::mutex mutex_;
  std::vector<std::map<StampNs, Pose>> truths_;  ///< per device, of the last minute
  std::vector<StampNs> first_frames_ns_;         ///< per device
  Status trouble_;
  std::atomic<bool> over_{false};
  std::atomic<std::size_t> dropped_{0};
  std::jthread worker_;  // last member: stops before the rest goes away
};

}  // namespace liloc::toolbox

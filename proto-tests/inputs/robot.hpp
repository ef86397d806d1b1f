#pragma once
// A device as its daemon runs it, but for the process: topics in, requests out.
#include "client/app/sensor_feed.hpp"
#include "common/wire/dds/dispatcher.hpp"

namespace liloc::inputs {

class Robot {
 public:
  /// `arguments` as of liloc-client. Errors: of those, DDS.
  [[nodiscard]] static Result<std::unique_ptr<Robot>> start(const std::vector<std::string>& arguments);
  ~Robot();
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;

  [[nodiscard]] client::PoseUpdate newest() const { return client_->newest(); }
  [[nodiscard]] client::Stats stats() const { return client_->stats(); }
  [[nodiscard]] bool tracking() const { return newest().state == client::State::tracking; }

 private:
  explicit Robot(DaemonOptions options) : options_(std::move(options)) {}
  [[nodiscard]] Status open();

  DaemonOptions options_;
  std::optional<wire::Participant> seat_;
  std::unique_ptr<client::Client> client_;
  std::unique_ptr<SensorFeed> feed_;
  std::unique_ptr<wire::Dispatcher> sensors_;  ///< last: its thread calls the above
};

}  // namespace liloc::inputs

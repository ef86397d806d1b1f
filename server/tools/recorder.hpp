#pragma once
// Live streams, written to a recording's folder as they come.
#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "common/base/bounded_queue.hpp"
#include "common/recording/imu_table.hpp"
#include "common/recording/recording.hpp"
#include "common/wire/dds/dispatcher.hpp"

namespace liloc::toolbox {

/// What came of one sensor.
struct Recorded {
  std::size_t frames = 0, samples = 0;
  std::size_t left_out = 0;  ///< came faster than they could be written
  std::size_t refused = 0;   ///< of another size than its intrinsics, malformed
  std::string last_refusal;
};

/// Frames wait in a bounded queue for threads that encode and write them; samples are written by the
/// dispatcher's thread, which must have stopped before this goes. Each frame appears whole, each sample at
/// once, and a device with its first frame, so that what a killed recorder leaves can be read.
class Recorder {
 public:
  /// Before anything is made. Errors: `out` is neither a new nor an empty folder; two sensors have one id.
  [[nodiscard]] static Status check(const Site& site, const std::vector<DeviceInfo>& devices,
                                    const std::filesystem::path& out);
  /// Writes the descriptions and subscribes. Errors: as of `check`; it cannot be written; the credentials do
  /// not allow it.
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> create(wire::Dispatcher& dispatcher, const Site& site,
                                                                const std::vector<DeviceInfo>& devices,
                                                                const std::filesystem::path& out);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The first file that could not be written; any thread.
  [[nodiscard]] Status trouble() const;
  /// By sensor; any thread.
  [[nodiscard]] std::map<std::string, Recorded> recorded() const;
  /// Writes what waits, and takes devices out of which no frame came. After the dispatcher has stopped.
  [[nodiscard]] Status finish();

 private:
  struct Sensor {
    std::filesystem::path folder;
    std::filesystem::path named;  ///< of a device: what its folder is called once there is a frame
    Camera camera;
    Recorded recorded;
    ImuTable imu;
  };
  struct Frame {
    Sensor* sensor = nullptr;
    DepthImage image;
  };
  explicit Recorder(std::filesystem::path out) : out_(std::move(out)) {}
  Status open(wire::Dispatcher& dispatcher, const Site& site, const std::vector<DeviceInfo>& devices);
  Status add_lidar(wire::Dispatcher& dispatcher, const GlobalLidar& lidar);
  Status add_device(wire::Dispatcher& dispatcher, const DeviceInfo& device);
  Result<Sensor*> add_sensor(const std::string& id, const std::filesystem::path& folder, const Camera& camera);
  /// Where its frame goes; a device's folder gets its name with the first.
  Result<std::filesystem::path> folder_of(Sensor& sensor);
  void take(Sensor& sensor, Result<DepthImage> image);
  void refuse(Sensor& sensor, const std::string& why);
  void write_frames(const std::stop_token& stop);

  const std::filesystem::path out_;
  std::map<std::string, Sensor> sensors_;  ///< by id; fixed once created
  mutable std::mutex mutex_;               ///< of what was recorded, and of trouble
  Status trouble_;
  BoundedQueue<Frame> waiting_{64};    ///< 10 MB of images of 320 x 240, 118 MB of 1280 x 720
  std::vector<std::jthread> writers_;  // last: they use all of the above
};

}  // namespace liloc::toolbox

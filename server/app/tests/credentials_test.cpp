// liloc-server as a process with credentials: who is served, and what a revocation does while it runs.
#include <gmock/gmock.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <new>
#include <optional>
#include <sstream>
#include <thread>

#include "common/credentials/tests/keystore.hpp"
#include "common/testing/within.hpp"
#include "common/wire/sensors/sensor_publishers.hpp"
#include "common/wire/spots/client_link.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using test::within;
using testing::HasSubstr;
constexpr int kDomain = 202;

/// A process that is ended with its owner.
class Child {
 public:
  /// `work` does not return.
  explicit Child(const std::function<void()>& work) : pid_(fork()) {
    if (pid_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves nobody behind
    work();
    _exit(9);
  }
  ~Child() { end(SIGKILL); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Its exit code, once it has ended; by the signal if that is not 0.
  int end(int signal) {
    if (pid_ <= 0) return -1;
    int status = 0;
    kill(pid_, signal);
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -2;
  }

 private:
  pid_t pid_;
};

/// The program with a site of one LiDAR; its log lies beside the keystore.
class ServerProgram {
 public:
  ServerProgram(const Keystore& store, const std::string& credentials)
      : log_(store.folder() / "server.log"), site_(store.folder() / "site.json") {
    std::ofstream(site_)
        << R"({"world_frame": "map", "global_lidars": [{"id": "ceiling0", "width": 32, "height": 24,
      "fx": 30, "fy": 30, "cx": 16, "cy": 12, "depth_scale": 0.001, "rate_hz": 10,
      "T_map_sensor": {"translation": [0, 0, 3], "rotation_xyzw": [0, 0, 0, 1]}}]})";
    child_.emplace([&] {
      if (std::freopen(log_.c_str(), "w", stderr) == nullptr) _exit(126);
      execl(LILOC_SERVER, LILOC_SERVER, "--site", site_.c_str(), "--domain", std::to_string(kDomain).c_str(),
            "--state", "none", "--credentials", credentials.c_str(), nullptr);
    });
  }
  int end(int signal) { return child_->end(signal); }
  [[nodiscard]] std::string log() const {
    std::ostringstream text;
    text << std::ifstream(log_).rdbuf();
    return text.str();
  }
  [[nodiscard]] bool says(const std::string& part) const { return log().find(part) != std::string::npos; }

 private:
  std::filesystem::path log_, site_;
  std::optional<Child> child_;
};

/// A number that a process from now on and this one see.
std::atomic<int>& shared_number() {
  void* memory =
      mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  return *new (memory) std::atomic<int>(0);
}

/// A device in a process of its own: Cyclone holds the first participant's permissions against all of a
/// process.
class Robot {
 public:
  Robot(const std::string& id, const std::string& credentials)
      : served_(shared_number()), child_([&] { drive(id, credentials); }) {}
  [[nodiscard]] bool served() const { return served_ > 0; }

 private:
  void drive(const std::string& id, const std::string& credentials) {
    const auto seat = wire::Participant::create({.domain = kDomain, .credentials = credentials});
    if (!seat) _exit(3);
    const auto dispatcher = wire::Dispatcher::create(*seat).value();
    const auto link = wire::ClientLink::create(*dispatcher, id, {});
    if (!link) _exit(4);
    dispatcher->start();
    for (;; std::this_thread::sleep_for(10ms)) served_ = (*link)->server_matched() ? 1 : 0;
  }

  std::atomic<int>& served_;
  Child child_;
};

/// A ceiling LiDAR's driver that names its stream `id`; ends with 5 if it is not let.
void drive_lidar(const std::string& id, const std::string& credentials) {
  constexpr Camera kCamera{32, 24, 30, 30, 16, 12, 0.001};
  const auto seat = wire::Participant::create({.domain = kDomain, .credentials = credentials});
  if (!seat) _exit(3);
  const auto depth = wire::DepthPublisher::create(*seat, id, kCamera);
  if (!depth) _exit(5);
  for (DepthImage image{0, 32, 24, std::vector<std::uint16_t>(32 * 24, 2500)};;
       std::this_thread::sleep_for(100ms)) {
    image.stamp_ns = std::chrono::system_clock::now().time_since_epoch() / 1ns;
    static_cast<void>(depth->publish(image));
  }
}

TEST(ServerCredentials, ALidarFeedsItsOwnStreamAlone) {
  const Keystore store;
  ASSERT_TRUE(store.run("init") && store.run("server edge") && store.run("lidar ceiling0") &&
              store.run("lidar ceiling1"));
  const ServerProgram server(store, store.party("edge").string());
  Child wrong([&] { drive_lidar("ceiling0", store.party("ceiling1").string()); });
  EXPECT_EQ(wrong.end(0), 5);
  EXPECT_FALSE(server.says("ceiling0: ok"));
  const Child right([&] { drive_lidar("ceiling0", store.party("ceiling0").string()); });
  EXPECT_TRUE(within(10s, [&] { return server.says("ceiling0: ok"); })) << server.log();
}

TEST(ServerCredentials, ARevocationCutsADeviceOffWithinTenSecondsAndTheOtherIsServedOn) {
  const Keystore store;
  ASSERT_TRUE(store.run("init") && store.run("server edge") && store.run("device robotA") &&
              store.run("device robotB"));
  ServerProgram server(store, store.party("edge").string());
  const Robot a("robotA", store.party("robotA").string()), b("robotB", store.party("robotB").string());
  ASSERT_TRUE(within(10s, [&] { return a.served() && b.served(); })) << server.log();

  ASSERT_TRUE(store.run("revoke robotB"));
  const auto revoked = std::chrono::steady_clock::now();
  ASSERT_TRUE(within(10s, [&] { return !b.served(); })) << server.log();
  ASSERT_TRUE(within(10s, [&] { return a.served(); })) << server.log();
  RecordProperty("rejoined_after_ms", static_cast<int>((std::chrono::steady_clock::now() - revoked) / 1ms));
  EXPECT_LT(std::chrono::steady_clock::now() - revoked, 10s);
  EXPECT_FALSE(within(3s, [&] { return b.served(); })) << "it tries again, and stays outside";
  EXPECT_TRUE(a.served());
  EXPECT_THAT(server.log(), HasSubstr("has changed: everybody joins anew"));
  const std::string log = server.log();
  int knocks = 0;
  for (auto at = log.find("certificate revoked"); at != std::string::npos;
       at = log.find("certificate revoked", at + 1))
    ++knocks;
  EXPECT_GE(knocks, 1) << log;
  EXPECT_LE(knocks, 3) << "each second it knocks four times\n" << log;
  EXPECT_EQ(server.end(SIGTERM), 0) << server.log();
}

TEST(ServerCredentials, ADamagedFolderDoesNotEndAServerThatRuns) {
  const Keystore store;
  ASSERT_TRUE(store.run("init") && store.run("server edge") && store.run("device robotA"));
  ServerProgram server(store, store.party("edge").string());
  const Robot a("robotA", store.party("robotA").string());
  ASSERT_TRUE(within(10s, [&] { return a.served(); })) << server.log();
  std::ofstream(store.party("edge") / "crl.pem", std::ios::trunc) << "nothing";
  EXPECT_TRUE(within(10s, [&] { return server.says("before these stay in use"); }));
  EXPECT_TRUE(a.served());
}

TEST(ServerCredentials, WhatIsWrongEndsTheProgramWithOneLine) {
  const Keystore store;
  ASSERT_TRUE(store.run("init") && store.run("server edge"));
  std::filesystem::remove(store.party("edge") / "key.pem");
  ServerProgram server(store, store.party("edge").string());
  EXPECT_EQ(server.end(0), 1);
  EXPECT_THAT(server.log(),
              HasSubstr("key.pem is missing; copy the whole folder that deploy/credentials made"));
}

}  // namespace
}  // namespace liloc

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
#include <sstream>
#include <thread>

#include "common/credentials/tests/keystore.hpp"
#include "common/wire/client_link.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
constexpr int kDomain = 202;

bool within(std::chrono::milliseconds limit, const std::function<bool()>& holds) {
  for (const auto end = std::chrono::steady_clock::now() + limit; std::chrono::steady_clock::now() < end;
       std::this_thread::sleep_for(10ms))
    if (holds()) return true;
  return false;
}

/// The program with a site of one LiDAR; its log lies beside the keystore.
class ServerProgram {
 public:
  ServerProgram(const Keystore& store, const std::string& credentials) : log_(store.folder() / "server.log") {
    const std::string site = (store.folder() / "site.json").string();
    std::ofstream(site)
        << R"({"world_frame": "map", "global_lidars": [{"id": "ceiling0", "width": 32, "height": 24,
      "fx": 30, "fy": 30, "cx": 16, "cy": 12, "depth_scale": 0.001, "rate_hz": 10,
      "T_map_sensor": {"translation": [0, 0, 3], "rotation_xyzw": [0, 0, 0, 1]}}]})";
    const std::string domain = std::to_string(kDomain);
    pid_ = fork();
    if (pid_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (std::freopen(log_.c_str(), "w", stderr) == nullptr) _exit(126);
    execl(LILOC_SERVER, LILOC_SERVER, "--site", site.c_str(), "--domain", domain.c_str(), "--state", "none",
          "--credentials", credentials.c_str(), nullptr);
    _exit(127);
  }
  ~ServerProgram() { end(SIGKILL); }
  ServerProgram(const ServerProgram&) = delete;
  ServerProgram& operator=(const ServerProgram&) = delete;

  int end(int signal) {
    if (pid_ <= 0) return -1;
    int status = 0;
    kill(pid_, signal);
    waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -2;
  }
  /// Its exit code, where it ends by itself.
  int ended() { return end(0); }
  [[nodiscard]] std::string log() const {
    std::ostringstream text;
    text << std::ifstream(log_).rdbuf();
    return text.str();
  }

 private:
  std::filesystem::path log_;
  pid_t pid_ = 0;
};

/// A device in a process of its own: Cyclone holds the first participant's permissions against all of a
/// process.
class Robot {
 public:
  Robot(const std::string& id, const std::string& credentials)
      : served_(static_cast<std::atomic<bool>*>(mmap(nullptr, sizeof(std::atomic<bool>), PROT_READ | PROT_WRITE,
                                                     MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
    pid_ = fork();
    if (pid_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves nobody behind
    drive(id, credentials);
  }
  ~Robot() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    munmap(served_, sizeof *served_);
  }
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  [[nodiscard]] bool served() const { return *served_; }

 private:
  [[noreturn]] void drive(const std::string& id, const std::string& credentials) {
    const auto seat = wire::Participant::create({.domain = kDomain, .credentials = credentials});
    if (!seat) _exit(3);
    const auto dispatcher = wire::Dispatcher::create(*seat).value();
    const auto link = wire::ClientLink::create(*dispatcher, id, {});
    if (!link) _exit(4);
    dispatcher->start();
    for (;; std::this_thread::sleep_for(10ms)) *served_ = (*link)->server_matched();
  }

  std::atomic<bool>* served_;
  pid_t pid_ = 0;
};

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
  ASSERT_TRUE(
      within(revoked + 10s - std::chrono::steady_clock::now() > 0s ? 10s : 0s, [&] { return a.served(); }));
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
  EXPECT_TRUE(within(10s, [&] { return server.log().find("before these stay in use") != std::string::npos; }));
  EXPECT_TRUE(a.served());
}

TEST(ServerCredentials, WhatIsWrongEndsTheProgramWithOneLine) {
  const Keystore store;
  ASSERT_TRUE(store.run("init") && store.run("server edge"));
  std::filesystem::remove(store.party("edge") / "key.pem");
  ServerProgram server(store, store.party("edge").string());
  EXPECT_EQ(server.ended(), 1);
  EXPECT_THAT(server.log(),
              HasSubstr("key.pem is missing; copy the whole folder that deploy/credentials made"));
}

}  // namespace
}  // namespace liloc

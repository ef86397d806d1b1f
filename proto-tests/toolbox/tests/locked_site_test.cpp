// A locked site of the real programs, told of their credentials on the command line and in option files.
#include <gmock/gmock.h>

#include <fstream>
#include <functional>
#include <thread>

#include "common/credentials/tests/keystore.hpp"
#include "common/testing/program.hpp"
#include "proto-tests/replay/processes.hpp"

namespace liloc::toolbox {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;
const std::string kDomain = "203";

class LockedSite : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(store_.run("init") && store_.run("server edge") && store_.run("device robotA"));
    const std::string camera =
        R"("width": 32, "height": 24, "fx": 30, "fy": 30, "cx": 16, "cy": 12, "depth_scale": 0.001)";
    std::ofstream(file("site.json")) << R"({"world_frame": "map", "global_lidars": [{"id": "ceiling0", )"
                                     << camera << R"(, "rate_hz": 10, "T_map_sensor": {"translation": [0, 0, 3],
      "rotation_xyzw": [0, 0, 0, 1]}}]})";
    std::ofstream(file("robotA.json")) << R"({"id": "robotA", )" << camera << R"(, "rate_hz": 10})";
    std::ofstream(file("server.toml"))
        << "site = \"" << file("site.json") << "\"\nstate = \"none\"\ndomain = " << kDomain
        << "\nserver-id = \"edge\"\ncredentials = \"" << party("edge") << "\"\n";
  }
  [[nodiscard]] std::string file(const std::string& name) const { return (store_.folder() / name).string(); }
  [[nodiscard]] std::string party(const std::string& name) const { return store_.party(name).string(); }
  [[nodiscard]] replay::Child start(std::vector<std::string> command, const std::string& log) const {
    return replay::Child::start(command, file(log)).value();
  }
  [[nodiscard]] replay::Child start_server() const {
    return start({LILOC_SERVER, "--config", file("server.toml")}, "server.log");
  }
  [[nodiscard]] static std::string doctor(const std::string& arguments) {
    return run_program(LILOC_PROGRAM, "doctor --domain " + kDomain + " " + arguments).out;
  }

  Keystore store_;
};

TEST_F(LockedSite, DoctorHearsTheServerWithCredentialsAndNothingWithout) {
  const auto server = start_server();
  EXPECT_THAT(doctor("--seconds 20 --credentials " + party("robotA")),
              AllOf(HasSubstr("ok    credentials of device robotA, valid for"), HasSubstr("edge: up for")));
  EXPECT_THAT(doctor("--seconds 2"), HasSubstr("FAIL  no server is heard"));
}

TEST_F(LockedSite, ARecorderHearsWithCredentialsAndNothingWithout) {
  const auto site = start(
      {LILOC_PROGRAM, "sim", "--live", "--domain", kDomain, "--lidars", "1", "--image-width", "80",
       "--image-height", "60", "--seconds", "20", "--describe", file("sim"), "--credentials", party("edge")},
      "sim.log");
  for (int i = 0; i < 1000 && !fs::exists(file("sim/device0.json")); ++i) std::this_thread::sleep_for(10ms);
  const auto record = [&](const std::string& out, const std::string& more) {
    return run_program(LILOC_PROGRAM, "record " + file(out) + " --domain " + kDomain + " --site " +
                                          file("sim/site.json") + " --device " + file("sim/device0.json") +
                                          more);
  };
  const Outcome closed = record("closed", " --seconds 1");
  EXPECT_EQ(closed.exit_code, 1) << closed.out;
  EXPECT_THAT(closed.out, HasSubstr("no ceiling LiDAR was heard"));
  const Outcome heard = record("heard", " --seconds 6 --credentials " + party("edge"));
  EXPECT_EQ(heard.exit_code, 0) << heard.out;
  EXPECT_THAT(heard.out, AllOf(Not(HasSubstr("ceiling0: 0 frames")), Not(HasSubstr("device0: 0 frames"))));
  const Outcome wrong = record("wrong", " --credentials " + file("absent"));
  EXPECT_EQ(wrong.exit_code, 1) << wrong.out;
  EXPECT_THAT(wrong.out, HasSubstr("absent"));
}

TEST_F(LockedSite, ADevicesDaemonIsServed) {
  const auto server = start_server();
  std::ofstream(file("client.toml")) << "id = \"robotA\"\ndevice = \"" << file("robotA.json")
                                     << "\"\ndomain = " << kDomain << "\ncredentials = \"" << party("robotA")
                                     << "\"\n";
  const auto robot = start({LILOC_CLIENT, "--config", file("client.toml")}, "client.log");
  std::string said;
  for (int i = 0; i < 20 && said.find(" 1 clients") == std::string::npos; ++i)
    said = doctor("--seconds 20 --credentials " + party("edge"));
  EXPECT_THAT(said, HasSubstr(" 1 clients"));
}

TEST_F(LockedSite, AnothersCredentialsAreToldByTheDaemon) {
  const Outcome wrong = run_program(LILOC_CLIENT, "--id robotB --device " + file("robotA.json") + " --domain " +
                                                      kDomain + " --credentials " + party("robotA"));
  EXPECT_EQ(wrong.exit_code, 1) << wrong.out;
  EXPECT_THAT(wrong.out, HasSubstr("the credentials do not allow it: are they this id's"));
}

TEST_F(LockedSite, DoctorFailsForCredentialsThatAreNotInOrder) {
  fs::permissions(store_.party("robotA") / "key.pem", fs::perms::others_read, fs::perm_options::add);
  EXPECT_THAT(doctor("--seconds 0.2 --credentials " + party("robotA")),
              HasSubstr("robotA/key.pem can be read by others than its owner; chmod 600"));
  fs::copy_file(store_.party("robotA") / "identity_ca.cert.pem",
                store_.party("robotA") / "permissions_ca.cert.pem", fs::copy_options::overwrite_existing);
  EXPECT_THAT(doctor("--seconds 0.2 --credentials " + party("robotA")),
              AllOf(HasSubstr("FAIL  credentials cannot be used: "),
                    HasSubstr("one CA for identities and permissions"), Not(HasSubstr("no server is heard"))));
}

}  // namespace
}  // namespace liloc::toolbox

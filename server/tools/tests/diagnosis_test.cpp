#include "server/tools/diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "server/tools/complaints.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;

wire::ServerStatus healthy(const std::string& id = "edge1") {
  wire::ServerStatus status;
  status.server_id = id;
  status.clients = 2;
  status.answered = 10;
  status.verified = 9;
  status.refused = 1;
  for (const char* lidar : {"ceiling0", "ceiling1"})
    status.lidars.push_back({lidar, wire::LidarState::ok, 6, 60, 0, ""});
  return status;
}

std::vector<Finding> check(const std::vector<wire::ServerStatus>& servers, const std::optional<Site>& site) {
  return check_servers({servers, {}}, {.domain = 7}, site);
}

/// The findings that are not good, one line each.
std::string complaints(const std::vector<Finding>& findings) {
  std::string lines;
  for (const Finding& finding : findings)
    if (finding.verdict != Verdict::good) lines += line_of(finding) + "\n";
  return lines;
}

Site site_with(const std::vector<std::string>& ids) {
  Site site;
  for (const auto& id : ids) site.global_lidars.emplace_back().id = id;
  return site;
}

TEST(Diagnosis, HealthyServersGiveNoComplaint) {
  const auto findings = check({healthy(), healthy("edge2")}, site_with({"ceiling0", "ceiling1"}));
  EXPECT_EQ(complaints(findings), "");
  EXPECT_EQ(findings.size(), 6U);  // two servers of two LiDARs
  EXPECT_EQ(line_of(findings[1]), "ok    edge1: ceiling0 ok at 6.0 Hz");
}

TEST(Diagnosis, NoServerIsBad) {
  EXPECT_THAT(complaints(check({}, {})),
              HasSubstr("FAIL  no server is heard in domain 7, interface lo; does one run"));
}

TEST(Diagnosis, CredentialsThatEndOrThatOthersReadAreBad) {
  using namespace std::chrono_literals;
  const auto now = std::chrono::system_clock::now();
  const auto said = [&](int days, bool exposed) {
    Credentials c{"/keys", "robot1", "device", std::chrono::ceil<std::chrono::seconds>(now + 24h * days),
                  exposed};
    return line_of(check_credentials(c, now).front());
  };
  EXPECT_EQ(said(30, false), "ok    credentials of device robot1, valid for 30 days");
  EXPECT_THAT(said(29, false),
              HasSubstr("FAIL  the credentials of robot1 expire in 29 days; deploy/credentials renew"));
  EXPECT_THAT(said(99, true), HasSubstr("FAIL  /keys/key.pem can be read by others than its owner; chmod 600"));
  EXPECT_THAT(complaints(check_credentials(fail("one CA for both"), now)),
              HasSubstr("FAIL  credentials cannot be used: one CA for both"));
}

TEST(Diagnosis, EveryTroubleOfALidarHasItsRemedy) {
  for (const auto& [state, text] :
       {std::pair{wire::LidarState::waiting, "FAIL  edge1: ceiling0 has sent nothing yet; does its driver run"},
        {wire::LidarState::silent, "send rt/ceiling0/depth/image_rect_raw"},
        {wire::LidarState::slow, "warn  edge1: ceiling0 is slow, 6.0 Hz; under half of its rate_hz"},
        {wire::LidarState::malformed, "sends malformed frames; they are refused: step is 3"},
        {wire::LidarState::blind,
         "FAIL  edge1: ceiling0 is blind, 0.2 % of its pixels measure anything; is its lens"},
        {wire::LidarState::implausible,
         "FAIL  edge1: ceiling0 measures implausible ranges, 0.6 m in the median, it used to be 2.4 m; is its "
         "depth_scale"},
        {wire::LidarState::clock_off,
         "FAIL  edge1: ceiling0 has another clock, 37.00 s behind the site's; its frames are left out"},
        {static_cast<wire::LidarState>(8),
         "warn  edge1: ceiling0 is in state 8, which this program does not know; the server is newer: "
         "update"}}) {
    wire::ServerStatus status = healthy();
    status.lidars[0].state = state;
    status.lidars[0].last_error = "step is 3";
    status.lidars[0].returns = 0.002;
    status.lidars[0].range_m = 0.6;
    status.lidars[0].usual_range_m = 2.4;
    status.lidars[0].clock_offset_s = -37;
    EXPECT_THAT(complaints(check({status}, {})), HasSubstr(text));
  }
}

TEST(Diagnosis, AClockThatIsCorrectedIsToldWithItsOffset) {
  wire::ServerStatus status = healthy();
  status.lidars[1].clock_offset_s = 37;
  status.lidars[1].clock_corrected = true;
  EXPECT_THAT(complaints(check({status}, {})),
              HasSubstr("warn  edge1: ceiling1 has a clock 37.00 s ahead of the site's, which is corrected; "));
}

TEST(Diagnosis, AServerThatCannotBeReadIsNamedOnOneLine) {
  const auto findings = check_servers({{}, {"server speaks version 1\n\x1b[2Jok"}}, {}, {});
  EXPECT_EQ(
      complaints(findings),
      "FAIL  a server's status cannot be read: server speaks version 1 ?[2Jok; is it of this version? update "
      "the older one\n");
}

TEST(Diagnosis, ThePageListsEveryComplaint) {
  std::ifstream in(LILOC_TROUBLESHOOTING);
  const std::string page((std::istreambuf_iterator<char>(in)), {});
  ASSERT_FALSE(page.empty()) << LILOC_TROUBLESHOOTING;
  const std::regex field("\\{([a-z]+)(:[^}]*)?\\}");
  for (const Complaint& complaint : kComplaints) {
    const std::string heading =
        "### `" + std::regex_replace(std::string(complaint.what), field, "<$1>") + "`\n";
    EXPECT_NE(page.find(heading), std::string::npos) << "deploy/TROUBLESHOOTING.md lacks " << heading;
  }
}

TEST(Diagnosis, AServerOfAnotherSiteIsNamed) {
  EXPECT_THAT(complaints(check({healthy()}, site_with({"ceiling0", "hall"}))),
              HasSubstr("FAIL  edge1: does not serve hall; it was started with another site.json"));
}

TEST(Diagnosis, ManyRefusalsAreDoubtful) {
  wire::ServerStatus status = healthy();
  status.refused = 6;
  EXPECT_THAT(complaints(check({status}, {})),
              HasSubstr("warn  edge1: 6 of 10 requests are refused; the clients'"));
}

TEST(Diagnosis, SettingsThatAreTooSmallSayHowLargeTheyShouldBe) {
  EXPECT_EQ(check_setting("net.core.rmem_max", 4'194'304, 4'194'304).verdict, Verdict::good);
  const auto small = check_setting("net.core.rmem_max", 212'992, 4'194'304);
  EXPECT_EQ(small.verdict, Verdict::doubtful);
  EXPECT_THAT(line_of(small), HasSubstr("sysctl -w net.core.rmem_max=4194304"));
  EXPECT_EQ(check_setting("net.core.rmem_max", std::nullopt, 1).verdict, Verdict::doubtful);
}

}  // namespace
}  // namespace liloc::toolbox

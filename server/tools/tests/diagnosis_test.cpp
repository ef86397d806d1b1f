#include "server/tools/diagnosis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  const auto findings = check_servers({healthy(), healthy("edge2")}, site_with({"ceiling0", "ceiling1"}));
  EXPECT_EQ(complaints(findings), "");
  EXPECT_EQ(findings.size(), 6U);  // two servers of two LiDARs
  EXPECT_EQ(line_of(findings[1]), "ok    edge1: ceiling0 ok at 6.0 Hz");
}

TEST(Diagnosis, NoServerIsBad) {
  EXPECT_THAT(complaints(check_servers({}, {})), HasSubstr("FAIL  no server is heard; does one run"));
}

TEST(Diagnosis, EveryTroubleOfALidarHasItsRemedy) {
  for (const auto& [state, text] :
       {std::pair{wire::LidarState::waiting, "FAIL  edge1: ceiling0 waiting at 6.0 Hz; does its driver run"},
        {wire::LidarState::silent, "send rt/ceiling0/depth/image_rect_raw"},
        {wire::LidarState::slow, "warn  edge1: ceiling0 slow at 6.0 Hz; under half of its rate_hz"},
        {wire::LidarState::malformed, "frames are refused: step is 3"}}) {
    wire::ServerStatus status = healthy();
    status.lidars[0].state = state;
    status.lidars[0].last_error = "step is 3";
    EXPECT_THAT(complaints(check_servers({status}, {})), HasSubstr(text));
  }
}

TEST(Diagnosis, AServerOfAnotherSiteIsNamed) {
  EXPECT_THAT(complaints(check_servers({healthy()}, site_with({"ceiling0", "hall"}))),
              HasSubstr("FAIL  edge1: does not serve hall; it was started with another site.json"));
}

TEST(Diagnosis, ManyRefusalsAreDoubtful) {
  wire::ServerStatus status = healthy();
  status.refused = 6;
  EXPECT_THAT(complaints(check_servers({status}, {})), HasSubstr("most requests are refused"));
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

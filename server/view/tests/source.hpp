#pragma once
// A site of one LiDAR before a wall, and what the page asks it for.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "server/global_cloud/global_cloud.hpp"
#include "server/view/source.hpp"

namespace liloc::view::test {

inline const Camera kCamera{64, 48, 50, 50, 32, 24, 0.001};

class Place {
 public:
  Source source() {
    return {.site = site_,
            .facts =
                [this] {
                  ++asked;
                  web::ServerFacts facts;
                  facts.server_id = "edge1";
                  facts.uptime_s = asked;  // the picture's number
                  facts.lidars.resize(1);
                  return facts;
                },
            .moment = [this] { return cloud_.newest(); },
            .journal = journal,
            .log = log};
  }
  /// A wall that far away.
  void frame(std::uint16_t units = 2000) {
    stamp_ns_ += from_ms(100);
    DepthImage image{stamp_ns_, kCamera.width, kCamera.height, {}};
    image.units.assign(64 * 48, units);
    ASSERT_TRUE(cloud_.add_depth(0, std::move(image)));
  }

  std::atomic<int> asked = 0;  ///< pictures
  const std::shared_ptr<Journal> journal = std::make_shared<Journal>();
  const std::shared_ptr<LogTail> log = std::make_shared<LogTail>();

 private:
  const Site site_{"map", {{"c0", kCamera, 10, Pose::Identity()}}};
  GlobalCloud cloud_{site_, {}};
  StampNs stamp_ns_ = 1'000'000'000;
};

}  // namespace liloc::view::test

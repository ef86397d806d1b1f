#include "server/app/upkeep.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>

#include "common/base/log.hpp"
#include "common/testing/within.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using test::within;

struct Counted {
  [[nodiscard]] Upkeep::Duties duties() {
    return {.clients = [this] { return clients.load(); },
            .prepare = [this] { ++prepared; },
            .save_sessions = [this] { ++sessions; },
            .save_learned = [this] { ++learned; }};
  }
  std::atomic<std::size_t> clients = 0;
  std::atomic<int> prepared = 0, sessions = 0, learned = 0;
};

TEST(Upkeep, PreparesForThoseWhoMightAskAndSavesSessionsEachSecond) {
  Counted counted;
  {
    const Upkeep upkeep(counted.duties());
    EXPECT_TRUE(within(20s, [&] { return counted.sessions >= 1; }));
    EXPECT_EQ(counted.prepared, 0) << "nobody asks";
    counted.clients = 1;
    EXPECT_TRUE(within(20s, [&] { return counted.prepared >= 3; }));
  }
  const int prepared = counted.prepared;
  std::this_thread::sleep_for(120ms);
  EXPECT_EQ(counted.prepared, prepared) << "it has ended";
  EXPECT_EQ(counted.learned, 0) << "a minute is not over";
}

TEST(Upkeep, ARoomThatCannotBePreparedIsToldAndTheRestGoesOn) {
  std::atomic<int> told = 0;
  log::set_sink([&](log::Level, std::string_view line) {
    told += line.find("out of points") != std::string_view::npos ? 1 : 0;
  });
  Counted counted;
  counted.clients = 1;
  Upkeep::Duties duties = counted.duties();
  duties.prepare = [] { throw std::runtime_error("out of points"); };
  {
    const Upkeep upkeep(std::move(duties));
    EXPECT_TRUE(within(20s, [&] { return counted.sessions >= 1; }));
  }
  EXPECT_GE(told, 2);
  log::set_sink({});
}

}  // namespace
}  // namespace liloc

#pragma once
// What became of each request and each device of a run. Plain bytes: they go from process to process.
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

namespace liloc::load {

enum class Outcome : std::uint8_t { unsent, unanswered, verified, provisional, refused, superseded };

struct RequestRow {
  double planned_s = 0;   ///< since the run's start
  double lag_ms = 0;      ///< by which the generator was late with it
  double latency_ms = 0;  ///< from planned_s to the reply, where one came
  Outcome outcome = Outcome::unsent;
  bool wrong = false;    ///< verified, and off by more than allowed
  bool of_lost = false;  ///< its device had lost its way and was not found again yet
};

struct DeviceRow {
  double present_s = 0;     ///< of the measured time
  double available_s = 0;   ///< of that with a verified pose younger than two intervals
  double recovered_s = -1;  ///< after it lost its odometry; -1: did not lose it; infinite: was not found again
  std::uint64_t sent_bytes = 0, received_bytes = 0;
};

struct Outcomes {
  std::vector<RequestRow> requests;
  std::vector<DeviceRow> devices;
};
static_assert(std::is_trivially_copyable_v<RequestRow> && std::is_trivially_copyable_v<DeviceRow>);

}  // namespace liloc::load

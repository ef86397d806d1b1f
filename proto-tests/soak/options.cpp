#include "proto-tests/soak/options.hpp"

#include <algorithm>

namespace liloc::soak {
namespace {

Status within(double value, double low, double high, const char* name) {
  if (value >= low && value <= high) return {};  // NaN is not
  return fail("soak: --{} is {}, must be {}..{}", name, value, low, high);
}

Status zero_or_within(double value, double low, double high, const char* name) {
  if (value == 0 || (value >= low && value <= high)) return {};
  return fail("soak: --{} is {}, must be 0 or {}..{}", name, value, low, high);
}

}  // namespace

double SoakOptions::warmup_s() const {
  return std::clamp(0.25 * seconds, 15.0, 120.0);
}

Status SoakOptions::validated() const {
  for (const Status& ok : {within(seconds, 30, 7 * 86'400, "seconds"), within(residents, 0, 16, "residents"),
                           within(visitors, 1, 64, "visitors"), within(stay_s, 5, 3600, "stay"),
                           zero_or_within(flap_s, 5, 3600, "flap"),
                           zero_or_within(restart_s, 15, 3600, "restart"), within(lidars, 1, 8, "lidars"),
                           within(people, 0, 30, "people"), within(tape_s, 6, 120, "tape-seconds")})
    if (!ok) return ok;
  return {};
}

}  // namespace liloc::soak

#include "proto-tests/soak/growth.hpp"

#include <algorithm>
#include <cstddef>

#include "common/base/quantile.hpp"

namespace liloc::soak {
namespace {

constexpr std::size_t kMostPoints = 300;  // of a slope: 45 000 pairs, a moment
constexpr double kFloor = 0.1;            // quantile: the least of all may be one odd sample; by hand

double slope_per_s(const std::vector<Sample>& samples) {
  const std::size_t step = std::max<std::size_t>(1, samples.size() / kMostPoints);
  std::vector<double> slopes;
  for (std::size_t i = 0; i < samples.size(); i += step)
    for (std::size_t j = i + step; j < samples.size(); j += step)
      if (samples[j].at_s > samples[i].at_s)
        slopes.push_back((samples[j].value - samples[i].value) / (samples[j].at_s - samples[i].at_s));
  return slopes.empty() ? 0 : median(std::move(slopes));
}

std::vector<double> between(const std::vector<Sample>& samples, double from_s, double to_s) {
  std::vector<double> values;
  for (const Sample& sample : samples)
    if (sample.at_s >= from_s && sample.at_s <= to_s) values.push_back(sample.value);
  return values;  // not empty: the first or the last sample is among them
}

}  // namespace

Trend trend_of(const std::vector<Sample>& samples, double from_s) {
  std::vector<Sample> judged;
  std::ranges::copy_if(samples, std::back_inserter(judged),
                       [from_s](const Sample& sample) { return sample.at_s >= from_s; });
  if (judged.size() < 3) return {};
  const double begin_s = judged.front().at_s, end_s = judged.back().at_s, third_s = (end_s - begin_s) / 3;
  Trend trend;
  trend.third_s = third_s;
  trend.first = quantile(between(judged, begin_s, begin_s + third_s), kFloor);
  trend.last = quantile(between(judged, end_s - third_s, end_s), kFloor);
  trend.slope_per_h = 3600 * slope_per_s(judged);
  return trend;
}

}  // namespace liloc::soak

#include "server/web/facts.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace liloc::web {
namespace {

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

/// Entries of a folder of /proc.
double entries(const char* folder) {
  std::error_code error;
  const auto all = std::filesystem::directory_iterator(folder, error);
  return error ? 0 : static_cast<double>(std::distance(begin(all), end(all)));
}

}  // namespace

ProcessFacts process_facts() {
  ProcessFacts facts;
  double total_pages = 0, resident_pages = 0;
  std::ifstream("/proc/self/statm") >> total_pages >> resident_pages;
  facts.resident_bytes = resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE));
  rusage used{};
  if (getrusage(RUSAGE_SELF, &used) == 0) facts.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  facts.threads = entries("/proc/self/task");
  facts.open_files = entries("/proc/self/fd");
  return facts;
}

std::optional<double> gpc_age_s(const ServerFacts& facts) {
  std::optional<double> youngest;
  for (const LidarFacts& lidar : facts.lidars)
    if (lidar.age_s) youngest = std::min(*lidar.age_s, youngest.value_or(*lidar.age_s));
  return youngest;
}

}  // namespace liloc::web

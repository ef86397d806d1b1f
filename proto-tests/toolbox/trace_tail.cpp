#include "proto-tests/toolbox/trace_tail.hpp"

#include <cmath>
#include <sstream>

#include "proto-tests/replay/csv.hpp"

namespace liloc::toolbox {
void LineTail::poll(const std::function<void(const std::string& line)>& on_line) {
  std::ifstream in(file_, std::ios::binary);
  if (!in) return;
  in.seekg(position_);
  for (std::string line; std::getline(in, line);) {
    if (in.eof()) return;  // not yet complete: read again next time
    position_ += static_cast<std::streamoff>(line.size()) + 1;
    on_line(line);
  }
}

const DeviceNews& TraceTail::poll() {
  news_.poses.clear();
  online_.poll([this](const std::string& line) { add_pose(line); });
  spots_.poll([this](const std::string& line) { add_spot(line); });
  return news_;
}

void TraceTail::add_pose(const std::string& line) {
  std::istringstream in(line);
  std::string stamp;
  Eigen::Vector3d t;
  Eigen::Vector4d q;
  if (line.starts_with('#') || !(in >> stamp >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w()))
    return;
  const auto dot = stamp.find('.');
  if (dot == std::string::npos || stamp.size() - dot != 10) return;  // nanoseconds do not fit a double
  const auto pose = valid_pose(t, q, "online.tum");
  if (pose) news_.poses.push_back({std::stoll(stamp.substr(0, dot) + stamp.substr(dot + 1)), *pose});
}

void TraceTail::add_spot(const std::string& line) {
  const std::vector<std::string> cells = replay::split_cells(line);
  if (columns_.empty()) {
    columns_ = cells;
    return;
  }
  const auto cell = [&](std::string_view name) -> std::string {
    for (std::size_t i = 0; i < columns_.size() && i < cells.size(); ++i)
      if (columns_[i] == name) return cells[i];
    return {};
  };
  ++news_.asked;
  news_.last_status = cell("status");
  news_.last_reason = cell("reason");
  news_.verified += news_.last_status == "verified";
  news_.refused += news_.last_status == "refused";
  const std::string latency = cell("latency_ms");
  if (!latency.empty()) news_.latencies_ms.push_back(std::strtod(latency.c_str(), nullptr));
}

}  // namespace liloc::toolbox

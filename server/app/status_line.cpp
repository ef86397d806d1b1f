#include "server/app/status_line.hpp"

#include <fmt/format.h>

namespace liloc {

std::string status_line(const wire::ServerStatus& status, const std::vector<DepthNoise>& noise) {
  std::string lidars;
  for (std::size_t i = 0; i < status.lidars.size(); ++i) {
    const auto& lidar = status.lidars[i];
    lidars += fmt::format("{}{} {} {:.1f} Hz", lidars.empty() ? "" : ", ", lidar.id, wire::name_of(lidar.state),
                          lidar.measured_hz);
    if (i < noise.size() && noise[i].samples > 0)
      lidars += fmt::format(" (noise {:.0f} mm at 3 m, {:.0f} % missing)", 1e3 * noise[i].sigma_m(3),
                            100 * noise[i].missing);
  }
  return fmt::format("{} clients, {} queued, {} answered ({} verified, {} refused); {}", status.clients,
                     status.queued, status.answered, status.verified, status.refused, lidars);
}

}  // namespace liloc

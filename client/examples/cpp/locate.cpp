// A device in C++: depth frames in, poses out.   locate ID DOMAIN WIDTH HEIGHT FOCAL_PX < FRAMES
// Standard input stands for your camera's driver: of each frame a stamp (int64, ns), then its depths (uint16,
// mm).
#include <cstdio>
#include <cstdlib>
#include <liloc/client.hpp>
#include <vector>

namespace {

const char* const kStates[] = {"searching", "tracking", "coasting", "lost"};

void print(const liloc::client::PoseUpdate& now) {  // on the registration's thread
  std::printf("%lld %s", static_cast<long long>(now.stamp_ns), kStates[static_cast<int>(now.state)]);
  if (now.T_map_sensor) {
    const auto& [x, y, z] = now.T_map_sensor->translation_m;
    std::printf(" %.3f %.3f %.3f", x, y, z);
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  liloc::client::Options options;
  options.id = argv[1];
  options.domain = std::atoi(argv[2]);
  const int width = std::atoi(argv[3]), height = std::atoi(argv[4]);
  const double focal_px = std::atof(argv[5]);
  options.camera = {width, height, focal_px, focal_px, (width - 1) / 2.0, (height - 1) / 2.0, 0.001};

  auto made = liloc::client::Client::create(options, print);
  if (!made) {
    std::fprintf(stderr, "%s\n", made.error().c_str());
    return 1;
  }
  liloc::client::Client& client = *made.value();
  std::int64_t stamp_ns = 0;
  std::vector<std::uint16_t> depth_mm(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  while (std::fread(&stamp_ns, sizeof stamp_ns, 1, stdin) == 1 &&
         std::fread(depth_mm.data(), sizeof depth_mm[0], depth_mm.size(), stdin) == depth_mm.size()) {
    if (const auto pushed = client.push_depth(depth_mm.data(), width, height, stamp_ns); !pushed)
      std::fprintf(stderr, "%s\n", pushed.error().c_str());
  }
  if (const auto stopped = client.stop(); !stopped) std::fprintf(stderr, "%s\n", stopped.error().c_str());
  if (const std::string problem = client.stats().problem; !problem.empty())
    std::fprintf(stderr, "%s\n", problem.c_str());
}

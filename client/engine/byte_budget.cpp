#include "client/engine/byte_budget.hpp"

#include <algorithm>

namespace liloc {

Result<EncodedCloud> encode_within(std::size_t most_bytes, std::size_t most_points, const CodecOptions& options,
                                   const std::function<Cloud(std::size_t most_points)>& thinned) {
  constexpr double kSpare = 0.97;  // fewer points cost more bytes each: they lie farther apart; by hand
  for (std::size_t points = most_points;;) {
    const Cloud cloud = thinned(points);
    auto encoded = encode(cloud, options);
    if (!encoded || encoded->bytes.size() <= most_bytes) return encoded;
    const double share = kSpare * static_cast<double>(most_bytes) / static_cast<double>(encoded->bytes.size());
    points = static_cast<std::size_t>(share * static_cast<double>(cloud.size()));
  }
}

}  // namespace liloc

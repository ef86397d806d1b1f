#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "common/geometry/cloud.hpp"

namespace liloc {

/// Described points of a cloud: column i of `descriptors` belongs to point `index[i]`.
struct Features {
  std::vector<std::uint32_t> index;
  Eigen::MatrixXf descriptors;
  [[nodiscard]] std::size_t size() const { return index.size(); }
};

/// A way to describe the points `index` of `thinned`, in place of FPFH; points that it cannot describe are left
/// out. `dense`: the cloud that was thinned. Any thread may call it.
using Describer =
    std::function<Features(const Cloud& dense, const Cloud& thinned, const std::vector<std::uint32_t>& index)>;

}  // namespace liloc

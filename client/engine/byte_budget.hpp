#pragma once
#include <functional>

#include "common/codec/codec.hpp"

namespace liloc {

/// The code of a cloud, by `options`, in at most `most_bytes`. `thinned` gives the cloud at no more than so
/// many points; it is asked first for `most_points`, then for as many as should fit, until they do (two or
/// three times). Pure, if `thinned` is. Errors: those of `encode`, of which an empty cloud is one.
[[nodiscard]] Result<EncodedCloud> encode_within(std::size_t most_bytes, std::size_t most_points,
                                                 const CodecOptions& options,
                                                 const std::function<Cloud(std::size_t most_points)>& thinned);

}  // namespace liloc

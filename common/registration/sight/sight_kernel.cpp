#include "common/registration/sight/sight_kernel.hpp"

#include "common/registration/points/simd.hpp"

namespace liloc {

namespace {

constexpr float kApart_m = 0.05F;  // along the normal; 95 % of false ones are nearer, DECISIONS.md

/// `normals`: of as many points; not read unless kNormals.
template <bool kNormals>
[[gnu::always_inline]] inline void look(const Pinhole& camera, const DepthBand* bands, const PointRun& points,
                                        const PointRun& normals, float tolerance_m, std::int32_t* words) {
  const Pinhole c = camera;  // a copy, which stores to `words` cannot change: else nothing is vectorized
  const float *x = points.x, *y = points.y, *z = points.z, *nx = normals.x, *ny = normals.y, *nz = normals.z;
  const std::size_t count = points.count;
  const auto row = static_cast<std::uint32_t>(c.width), none = static_cast<std::uint32_t>(c.none);
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) {
    const float px = c.R[0] * x[i] + c.R[3] * y[i] + c.R[6] * z[i] + c.t[0],
                py = c.R[1] * x[i] + c.R[4] * y[i] + c.R[7] * z[i] + c.t[1],
                pz = c.R[2] * x[i] + c.R[5] * y[i] + c.R[8] * z[i] + c.t[2];
    const float inverse = 1.0F / (pz > c.nearest ? pz : c.nearest);
    const float u = px * inverse * c.fx + c.cx, v = py * inverse * c.fy + c.cy;
    const bool inside = (pz >= c.nearest) & (u >= 0) & (v >= 0) & (u < c.width) & (v < c.height);
    const std::uint32_t inner = static_cast<std::uint32_t>(static_cast<std::int32_t>(v)) * row +
                                static_cast<std::uint32_t>(static_cast<std::int32_t>(u));
    const auto pixel = static_cast<std::int32_t>(inside ? inner : none);
    const float near = bands[pixel].near, far = bands[pixel].far, edge = bands[pixel].edge;
    const float slack = tolerance_m + 0.01F * pz;
    bool through = pz < edge - 2 * slack;
    if constexpr (kNormals) {
      const float mx = c.R[0] * nx[i] + c.R[3] * ny[i] + c.R[6] * nz[i],
                  my = c.R[1] * nx[i] + c.R[4] * ny[i] + c.R[7] * nz[i],
                  mz = c.R[2] * nx[i] + c.R[5] * ny[i] + c.R[8] * nz[i];
      const float along = mx * px + my * py + mz * pz;
      const float gap = (edge - pz) * (along < 0 ? -along : along);  // times pz, along the normal
      through = through & ((gap > kApart_m * pz) | (mx * mx + my * my + mz * mz < 0.5F));
    }
    const bool on =
        ((pz >= near - 2 * slack) & (pz <= near + slack)) | ((pz >= far - slack) & (pz <= far + slack));
    const std::int32_t said = through ? kLookedThrough : on ? kMeasured : kNoWord;
    const std::int32_t word = far > 0 ? said : kNoWord;
    words[i] = words[i] > word ? words[i] : word;
  }
}

}  // namespace

LILOC_WIDE void look_at(const Pinhole& camera, const DepthBand* bands, const PointRun& points,
                        float tolerance_m, std::int32_t* words) {
  look<false>(camera, bands, points, points, tolerance_m, words);
}

LILOC_WIDE void look_at(const Pinhole& camera, const DepthBand* bands, const PointRun& points,
                        const PointRun& normals, float tolerance_m, std::int32_t* words) {
  look<true>(camera, bands, points, normals, tolerance_m, words);
}

LILOC_WIDE void reach_into(const HalfSpace* spaces, std::size_t space_count, const PointRun& centres,
                           const float* radii, std::int32_t* reached) {
  const float *x = centres.x, *y = centres.y, *z = centres.z;
  const std::size_t count = centres.count;
  for (std::size_t k = 0; k < space_count; ++k) {
    const HalfSpace s = spaces[k];
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i) {
      const bool inside = s.x * x[i] + s.y * y[i] + s.z * z[i] + s.off > -radii[i];
      reached[i] = inside ? reached[i] : 0;
    }
  }
}

}  // namespace liloc

#pragma once
// NumPy arrays on one side, the public API's plain structs on the other.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/include/liloc/client.hpp"

namespace liloc::client::python {

namespace py = pybind11;

/// 4x4 float64 matrix, p_to = T * p_from. The other way raises ValueError unless it is a rotation and a
/// translation; `what` names it.
[[nodiscard]] py::array_t<double> to_matrix(const Pose& pose);
[[nodiscard]] Pose from_matrix(const py::object& matrix, const char* what);

using DepthArray = py::array_t<std::uint16_t, py::array::c_style>;
/// uint16 of HxW, copied only when it is not contiguous. Raises TypeError for another type: metres as float
/// would become garbage silently.
[[nodiscard]] DepthArray depth_of(const py::object& depth);

/// N x 3 of any real type, as float32 in rows. Raises ValueError for another shape.
using PointArray = py::array_t<float, py::array::c_style | py::array::forcecast>;
[[nodiscard]] PointArray points_of(const py::object& points);

/// 6x6, or nothing for None.
[[nodiscard]] std::optional<std::array<double, 36>> covariance_of(const py::object& covariance);

struct Imu {
  std::int64_t stamp_ns = 0;
  std::array<double, 3> angular_velocity_rad_s{}, specific_force_m_s2{};
};
/// One stamp and six values, or N integer stamps and Nx6.
[[nodiscard]] std::vector<Imu> imu_of(const py::object& stamps_ns, const py::object& samples);

}  // namespace liloc::client::python

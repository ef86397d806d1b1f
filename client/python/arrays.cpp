#include "client/python/arrays.hpp"

#include <algorithm>
#include <cmath>

namespace liloc::client::python {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Matrix3 = double[3][3];

// Of R R^T from the identity: what doubles written as text keep; by hand.
constexpr double kRotationTolerance = 1e-6;

std::string shape_of(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>();
}

double determinant(const Matrix3& R) {
  return R[0][0] * (R[1][1] * R[2][2] - R[1][2] * R[2][1]) - R[0][1] * (R[1][0] * R[2][2] - R[1][2] * R[2][0]) +
         R[0][2] * (R[1][0] * R[2][1] - R[1][1] * R[2][0]);
}

bool is_rotation(const Matrix3& R) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double dot = R[i][0] * R[j][0] + R[i][1] * R[j][1] + R[i][2] * R[j][2];
      if (!(std::abs(dot - (i == j ? 1 : 0)) < kRotationTolerance)) return false;  // NaN is none either
    }
  return determinant(R) > 0;
}

/// Starts from the largest diagonal entry, which keeps every division well away from zero.
std::array<double, 4> quaternion_xyzw(const Matrix3& R) {
  std::array<double, 4> q{};
  const double trace = R[0][0] + R[1][1] + R[2][2];
  if (trace > 0) {
    const double s = 2 * std::sqrt(1 + trace);
    return {(R[2][1] - R[1][2]) / s, (R[0][2] - R[2][0]) / s, (R[1][0] - R[0][1]) / s, s / 4};
  }
  int i = R[1][1] > R[0][0] ? 1 : 0;
  if (R[2][2] > R[i][i]) i = 2;
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const double s = 2 * std::sqrt(1 + R[i][i] - R[j][j] - R[k][k]);
  const auto at = [&q](int index) -> double& { return q[static_cast<std::size_t>(index)]; };
  at(i) = s / 4;
  at(j) = (R[j][i] + R[i][j]) / s;
  at(k) = (R[k][i] + R[i][k]) / s;
  at(3) = (R[k][j] - R[j][k]) / s;
  return q;
}

py::array_t<std::int64_t, py::array::c_style> stamps_of(const py::object& stamps_ns) {
  const auto array = py::array::ensure(stamps_ns);
  const char kind = array ? array.dtype().kind() : 'O';
  if (kind != 'i' && kind != 'u')
    throw py::type_error("stamps_ns must be integers of nanoseconds: a float64 is off by up to 128 ns");
  return py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(array);
}

}  // namespace

py::array_t<double> to_matrix(const Pose& pose) {
  const auto [x, y, z, w] = pose.rotation_xyzw;
  const auto& t = pose.translation_m;
  const double T[4][4] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), t[0]},
                          {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), t[1]},
                          {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), t[2]},
                          {0, 0, 0, 1}};
  return py::array_t<double>({4, 4}, &T[0][0]);
}

Pose from_matrix(const py::object& matrix, const char* what) {
  const auto array = Array::ensure(matrix);
  if (!array) {
    PyErr_Clear();
    throw py::type_error(std::string(what) + " must be a 4x4 matrix of numbers");
  }
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
    throw py::value_error(std::string(what) + " has shape " + shape_of(array) + "; must be 4x4");
  const auto T = array.unchecked<2>();
  Pose pose;
  Matrix3 R;
  for (int i = 0; i < 3; ++i) {
    pose.translation_m[static_cast<std::size_t>(i)] = T(i, 3);
    for (int j = 0; j < 3; ++j) R[i][j] = T(i, j);
  }
  const bool last_row = T(3, 0) == 0 && T(3, 1) == 0 && T(3, 2) == 0 && T(3, 3) == 1;
  if (!last_row || !is_rotation(R))
    throw py::value_error(std::string(what) + " must be a rotation and a translation, last row 0 0 0 1");
  pose.rotation_xyzw = quaternion_xyzw(R);
  return pose;
}

DepthArray depth_of(const py::object& depth) {
  if (!py::isinstance<py::array>(depth)) throw py::type_error("depth must be a NumPy array of uint16");
  const auto array = py::reinterpret_borrow<py::array>(depth);
  if (!py::isinstance<py::array_t<std::uint16_t>>(array))
    throw py::type_error("depth has dtype " + py::str(array.dtype()).cast<std::string>() +
                         "; must be uint16: metres / camera.depth_scale_m, rounded");
  if (array.ndim() != 2)
    throw py::value_error("depth has shape " + shape_of(array) + "; must be height x width");
  return DepthArray::ensure(array);
}

PointArray points_of(const py::object& points) {
  auto array = PointArray::ensure(points);
  if (!array) {
    PyErr_Clear();
    throw py::type_error("points must be an N x 3 array of metres");
  }
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw py::value_error("points has shape " + shape_of(array) + "; must be N x 3");
  return array;
}

std::optional<std::array<double, 36>> covariance_of(const py::object& covariance) {
  if (covariance.is_none()) return {};
  const auto array = Array::ensure(covariance);
  if (!array) {
    PyErr_Clear();
    throw py::type_error("covariance must be a 6x6 matrix of numbers");
  }
  if (array.ndim() != 2 || array.shape(0) != 6 || array.shape(1) != 6)
    throw py::value_error("covariance has shape " + shape_of(array) + "; must be 6x6");
  std::array<double, 36> values{};
  std::copy_n(array.data(), values.size(), values.begin());
  return values;
}

std::vector<Imu> imu_of(const py::object& stamps_ns, const py::object& samples) {
  const auto stamps = stamps_of(stamps_ns);
  const auto values = Array::ensure(samples);
  if (!values) {
    PyErr_Clear();
    throw py::type_error("samples must be numbers: wx wy wz (rad/s) ax ay az (m/s^2)");
  }
  const py::ssize_t count = stamps.size();
  const bool one = stamps.ndim() == 0 && values.ndim() == 1 && values.shape(0) == 6;
  const bool many =
      stamps.ndim() == 1 && values.ndim() == 2 && values.shape(0) == count && values.shape(1) == 6;
  if (!one && !many)
    throw py::value_error("stamps_ns has shape " + shape_of(stamps) + " and samples " + shape_of(values) +
                          "; must be one stamp and 6 values, or N stamps and N x 6");
  std::vector<Imu> imu(static_cast<std::size_t>(count));
  const double* v = values.data();
  for (std::size_t i = 0; i < imu.size(); ++i, v += 6)
    imu[i] = {stamps.data()[i], {v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
  return imu;
}

}  // namespace liloc::client::python

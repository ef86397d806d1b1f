#include "server/tools/cloud_file.hpp"

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include "common/base/quantile.hpp"
#include "server/tools/pcd_header.hpp"
#include "server/tools/ply_file.hpp"
#include "server/tools/scalar.hpp"

namespace liloc::toolbox {
namespace {

/// The type that PCL's message names; PCD has it in TYPE and SIZE, which have been checked.
std::optional<Scalar> scalar_of(std::uint8_t datatype) {
  switch (datatype) {
    case pcl::PCLPointField::INT8:
      return Scalar::i8;
    case pcl::PCLPointField::UINT8:
      return Scalar::u8;
    case pcl::PCLPointField::INT16:
      return Scalar::i16;
    case pcl::PCLPointField::UINT16:
      return Scalar::u16;
    case pcl::PCLPointField::INT32:
      return Scalar::i32;
    case pcl::PCLPointField::UINT32:
      return Scalar::u32;
    case pcl::PCLPointField::FLOAT32:
      return Scalar::f32;
    case pcl::PCLPointField::FLOAT64:
      return Scalar::f64;
    default:
      return std::nullopt;
  }
}

// Beyond what the cloud itself spans. A sensor sees half as far. By hand.
constexpr double kFarOff_m = 20;
constexpr double kCoarsest_m = 0.005;     // between coordinates: a tenth of a voxel; by hand
constexpr double kFromOrigin_m = 16'000;  // as a site's LiDARs (common/recording/site_extent.cpp)

/// x, y and z of every point as they are stored: PCL's own conversion takes an axis of another type for zero.
Result<Points> points_of(const pcl::PCLPointCloud2& stored, const std::string& name) {
  std::array<std::pair<Scalar, std::size_t>, 3> axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string wanted(1, "xyz"[axis]);
    const auto field = std::ranges::find(stored.fields, wanted, &pcl::PCLPointField::name);
    const auto type = field == stored.fields.end() ? std::nullopt : scalar_of(field->datatype);
    if (!type || field->offset + bytes_of(*type) > stored.point_step)
      return fail("{}: its field {} has a type that is not read; write it as F 4 or F 8", name, wanted);
    axes.at(axis) = {*type, field->offset};
  }
  const std::size_t count = std::size_t{stored.width} * stored.height;
  if (stored.data.size() < count * stored.point_step) return fail("{}: is cut short; write it anew", name);
  Points points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const char* point = reinterpret_cast<const char*>(stored.data.data()) + i * stored.point_step;
    Eigen::Vector3d p;
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[static_cast<int>(axis)] = read_scalar(axes.at(axis).first, point + axes.at(axis).second, false);
    if (p.cast<float>().allFinite()) points.push_back(p);
  }
  return points;
}

Result<Points> read_pcd(const std::filesystem::path& file) {
  const std::string name = file.string();
  if (auto status = check_pcd_header(file); !status) return tl::unexpected(status.error());
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // our own line says it
  pcl::PCLPointCloud2 stored;
  try {
    if (pcl::io::loadPCDFile(name, stored) < 0) return fail("{}: is no sound pcd file; write it anew", name);
  } catch (const std::exception& trouble) {
    return fail("{}: is no sound pcd file ({}); write it anew", name, trouble.what());
  }
  return points_of(stored, name);
}

Result<Points> read_points(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::string kind = file.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::tolower(c); });
  if (kind != ".ply" && kind != ".pcd")
    return fail("{}: is neither .ply nor .pcd; convert it to one of them", name);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    return fail("{}: is no readable file; check the path", name);
  auto points = kind == ".ply" ? read_ply(file) : read_pcd(file);
  if (!points) return points;
  if (points->empty()) return fail("{}: has no finite point; is it the right file?", name);
  return points;
}

Cloud cloud_about(const Points& points, const Eigen::Vector3d& origin) {
  Cloud cloud;
  cloud.points.reserve(points.size());
  for (const Eigen::Vector3d& p : points) cloud.points.emplace_back((p - origin).cast<float>());
  return cloud;
}

/// Whether the coordinates are told no better than by floats.
bool are_floats(const Points& points) {
  return std::ranges::all_of(points,
                             [](const Eigen::Vector3d& p) { return p == p.cast<float>().cast<double>(); });
}

/// In whole metres; (0, 0, 0) where that lies among the points or near them, a few strays aside.
Eigen::Vector3d origin_of(const Points& points) {
  Eigen::Vector3d middle, off;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(points.size());
    for (const Eigen::Vector3d& p : points) values.push_back(p[axis]);
    const double low = quantile(values, 0.02), high = quantile(values, 0.98);
    middle[axis] = std::round((low + high) / 2);
    off[axis] = std::max({low, -high, 0.0});
  }
  return off.norm() > kFarOff_m ? middle : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

}  // namespace

Result<Cloud> read_cloud_file(const std::filesystem::path& file) {
  return read_points(file).map(
      [](const Points& points) { return cloud_about(points, Eigen::Vector3d::Zero()); });
}

Result<PlacedCloud> read_placed_cloud(const std::filesystem::path& file) {
  const auto points = read_points(file);
  if (!points) return tl::unexpected(points.error());
  const Eigen::Vector3d origin = origin_of(*points);
  const double apart_m =
      origin.cwiseAbs().maxCoeff() * static_cast<double>(std::numeric_limits<float>::epsilon());
  if (apart_m > kCoarsest_m && are_floats(*points))
    return fail(
        "{}: lies {:.0f} m from its origin in floats, which are {:.2g} m apart there; write x, y and z as "
        "doubles",
        file.string(), origin.norm(), apart_m);
  return PlacedCloud{cloud_about(*points, origin), origin};
}

Result<Cloud> read_map_scan(const std::filesystem::path& file) {
  const auto points = read_points(file);
  if (!points) return tl::unexpected(points.error());
  const Eigen::Vector3d origin = origin_of(*points);
  if (origin.cwiseAbs().maxCoeff() > kFromOrigin_m)
    return fail(
        "{}: lies {:.0f} m from the map's origin, must be within {:.0f} m: give metres, or subtract "
        "[{:.0f} {:.0f} {:.0f}] from its points while they are doubles, and from the site's places",
        file.string(), origin.norm(), kFromOrigin_m, origin.x(), origin.y(), origin.z());
  return cloud_about(*points, Eigen::Vector3d::Zero());
}

}  // namespace liloc::toolbox

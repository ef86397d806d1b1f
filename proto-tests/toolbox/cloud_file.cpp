#include "proto-tests/toolbox/cloud_file.hpp"

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <fstream>
#include <set>
#include <sstream>

#include "common/geometry/pcl.hpp"
#include "proto-tests/toolbox/pcd_header.hpp"

namespace liloc::toolbox {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

/// PCL makes room for as many points as a header claims before it looks for them, and takes an axis that is not
/// there for zero.
Status check_ply_header(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const auto size = std::filesystem::file_size(file);
  std::string line, element;
  std::set<std::string> of_vertex;
  for (int i = 0; i < 200 && std::getline(in, line); ++i) {
    std::istringstream words(line);
    std::string keyword, name;
    double count = 0;
    words >> keyword;
    if (keyword == "end_header") break;
    if (keyword == "property" && element == "vertex")
      while (words >> name) of_vertex.insert(name);
    if (keyword != "element" || !(words >> element >> count)) continue;
    if (count < 0 || count > 50e6 || count > static_cast<double>(size))
      return fail("{}: claims {} {} in {} bytes; write it anew", file.string(), count, element, size);
  }
  for (const char* axis : {"x", "y", "z"})
    if (!of_vertex.contains(axis))
      return fail("{}: its vertices have no {}; write it anew", file.string(), axis);
  return {};
}

int load(const std::filesystem::path& file, std::string_view kind, PclCloud& points) {
  return kind == ".ply" ? pcl::io::loadPLYFile(file.string(), points)
                        : pcl::io::loadPCDFile(file.string(), points);
}

}  // namespace

Result<Cloud> read_cloud_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::string kind = file.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::tolower(c); });
  if (kind != ".ply" && kind != ".pcd")
    return fail("{}: is neither .ply nor .pcd; convert it to one of them", name);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    return fail("{}: is no readable file; check the path", name);
  if (auto status = kind == ".ply" ? check_ply_header(file) : check_pcd_header(file); !status)
    return tl::unexpected(status.error());

  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // our own line says it
  PclCloud points;
  try {
    if (load(file, kind, points) < 0)
      return fail("{}: is no sound {} file; write it anew", name, kind.substr(1));
  } catch (const std::exception& trouble) {
    return fail("{}: is no sound {} file ({}); write it anew", name, kind.substr(1), trouble.what());
  }
  Cloud cloud = from_pcl(points);
  if (cloud.empty()) return fail("{}: has no finite point; is it the right file?", name);
  return cloud;
}

}  // namespace liloc::toolbox

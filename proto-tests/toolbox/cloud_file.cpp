#include "proto-tests/toolbox/cloud_file.hpp"

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <fstream>
#include <sstream>

#include "common/geometry/pcl.hpp"

namespace liloc::toolbox {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

/// PCL makes room for as many points as a header claims before it looks for them.
Status check_claim(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const auto size = std::filesystem::file_size(file);
  std::string line;
  for (int i = 0; i < 200 && std::getline(in, line); ++i) {
    std::istringstream words(line);
    std::string first, second;
    double count = 0;
    words >> first;
    if (first == "element") words >> second;
    if (first == "element" || first == "POINTS" || first == "WIDTH" || first == "HEIGHT")
      if (words >> count; count < 0 || count > 50e6 || count > static_cast<double>(size))
        return fail("{}: claims {} {} in {} bytes; write it anew", file.string(), count,
                    second.empty() ? first : second, size);
    if (first == "end_header" || first == "DATA") break;
  }
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
  if (auto status = check_claim(file); !status) return tl::unexpected(status.error());

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

#include "server/app/site_state.hpp"

#include <cmath>
#include <filesystem>

#include "common/base/log.hpp"
#include "common/recording/files.hpp"
#include "common/recording/json_fields.hpp"

namespace liloc {
namespace {

namespace fs = std::filesystem;
constexpr const char* kFormat = "liloc site state";
constexpr int kVersion = 2;           // of the file's layout
constexpr double kAny = 1e9;          // any number; what it means is checked later
constexpr double kSamePlace_m = 0.5;  // calibrations differ by less; by hand
// Files that lie aside; then no name is free for another; by hand.
constexpr int kMostPutAside = 100;

/// A field that the rest of the file is worth nothing without.
Status expect(const JsonFields& fields, const char* name, double value) {
  const auto found = fields.number(name, -kAny, kAny);
  if (!found) return tl::unexpected(found.error());
  if (std::abs(*found - value) > 1e-9)
    return fail("{} is {}, this server works with {}; delete the file to learn anew", fields.path(name), *found,
                value);
  return {};
}

Result<Eigen::Vector3d> read_place(const JsonFields& fields) {
  Eigen::Vector3d place;
  Eigen::Index i = 0;
  for (const char* name : {"x", "y", "z"}) {
    const auto value = fields.number(name, -kAny, kAny);
    if (!value) return tl::unexpected(value.error());
    place[i++] = *value;
  }
  return place;
}

/// What a right registration looks like depends on where the ceiling's LiDARs hang.
Status expect_lidars(const JsonFields& fields, const Site& site) {
  const std::string where = fields.path("lidars");
  if (!fields.has("lidars") || !fields.raw("lidars").is_object())
    return fail("{} is missing or no object; delete the file to learn anew", where);
  const auto& lidars = fields.raw("lidars");
  if (lidars.size() != site.global_lidars.size())
    return fail("{} are {}, this site has {}; the file is another site's: name another", where, lidars.size(),
                site.global_lidars.size());
  for (const GlobalLidar& lidar : site.global_lidars) {
    if (!lidars.contains(lidar.id) || !lidars.at(lidar.id).is_object())
      return fail("{} lack {}; the file is another site's: name another", where, lidar.id);
    const auto place = read_place(JsonFields(lidars.at(lidar.id), where + "." + lidar.id));
    if (!place) return tl::unexpected(place.error());
    const double moved_m = (*place - lidar.T_map_sensor.translation()).norm();
    if (moved_m > kSamePlace_m)
      return fail("{}.{} hung {:.1f} m elsewhere; delete the file to learn anew", where, lidar.id, moved_m);
  }
  return {};
}

Status read_cell(const JsonFields& fields, CellBounds* bounds) {
  std::array<double, 5> values{};
  std::size_t i = 0;
  for (const char* name : {"x", "y", "count", "fitness_mean", "fitness_sd"}) {
    const auto value = fields.number(name, -1e6, 1e6);
    if (!value) return tl::unexpected(value.error());
    values.at(i++) = *value;
  }
  const auto [x, y, count, mean, sd] = values;
  if (!bounds->restore({static_cast<int>(x), static_cast<int>(y)},
                       {static_cast<int>(count), mean, sd * std::abs(sd)}))
    return fail("{}: cannot have been learned, or stands there twice; delete the file to learn anew",
                fields.path("count"));
  return {};
}

Result<CellBounds> parse(const std::string& file, const Site& site, double voxel_size_m) {
  const auto object = read_json_object(file);
  if (!object) return tl::unexpected(object.error());
  const JsonFields fields(*object, file);
  const auto format = fields.text("format");
  if (!format || *format != kFormat) return fail("{}: is no {}; name another file", file, kFormat);
  for (const Status& status :
       {expect(fields, "version", kVersion), expect(fields, "cell_m", CellBounds::kCell_m),
        expect(fields, "voxel_size_m", voxel_size_m), expect_lidars(fields, site)})
    if (!status) return tl::unexpected(status.error());
  if (!fields.has("cells") || !fields.raw("cells").is_array())
    return fail("{} is missing or no list; delete the file to learn anew", fields.path("cells"));
  CellBounds bounds;
  std::size_t i = 0;
  for (const auto& cell : fields.raw("cells")) {
    const std::string where = fmt::format("{}: cells[{}]", file, i++);
    if (!cell.is_object()) return fail("{} is no object; delete the file to learn anew", where);
    if (const Status read = read_cell(JsonFields(cell, where), &bounds); !read)
      return tl::unexpected(read.error());
  }
  return bounds;
}

nlohmann::ordered_json noise_json(const DepthNoise& noise) {
  return {{"base_m", noise.base_m},
          {"per_square_m", noise.per_square_m},
          {"missing", noise.missing},
          {"flying", noise.flying},
          {"samples", noise.samples}};
}

/// Ranges: a worse sensor is none.
Result<DepthNoise> parse_noise(const JsonFields& fields) {
  DepthNoise noise;
  double samples = 0;
  const auto take = [&fields](const char* name, double most, double& into) -> Status {
    const auto value = fields.number(name, 0, most);
    if (!value) return tl::unexpected(value.error());
    into = *value;
    return {};
  };
  for (const Status& status :
       {take("base_m", 0.2, noise.base_m), take("per_square_m", 0.05, noise.per_square_m),
        take("missing", 1, noise.missing), take("flying", 1, noise.flying), take("samples", 1e15, samples)})
    if (!status) return tl::unexpected(status.error());
  noise.samples = static_cast<std::uint64_t>(samples);
  return noise;
}

/// A name beside the file that nothing has yet; empty when all are taken.
std::string free_name(const std::string& file) {
  std::error_code error;
  for (int i = 1; i <= kMostPutAside; ++i) {
    const std::string name = i == 1 ? file + ".unreadable" : fmt::format("{}.unreadable-{}", file, i);
    if (!fs::exists(fs::symlink_status(name, error))) return name;
  }
  return {};
}

}  // namespace

std::string state_file_of(const std::string& site_file, bool standby) {
  return fs::path(site_file).replace_extension(standby ? ".standby.state.json" : ".state.json").string();
}

Result<CellBounds> read_site_state(const std::string& file, const Site& site, double voxel_size_m) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error))) return CellBounds{};
  return parse(file, site, voxel_size_m);
}

std::vector<DepthNoise> read_noise(const std::string& file, const Site& site) {
  std::vector<DepthNoise> all(site.global_lidars.size());
  const auto object = read_json_object(file);
  if (!object || !object->contains("lidars") || !object->at("lidars").is_object()) return all;
  const auto& lidars = object->at("lidars");
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string& id = site.global_lidars[i].id;
    if (!lidars.contains(id) || !lidars.at(id).is_object() || !lidars.at(id).contains("noise")) continue;
    const auto& known = lidars.at(id).at("noise");
    const std::string where = fmt::format("{}: lidars.{}.noise", file, id);
    if (!known.is_object()) continue;
    const auto noise = parse_noise(JsonFields(known, where));
    if (noise)
      all[i] = *noise;
    else
      log::warning("{}; it is learned anew", noise.error().message);
  }
  return all;
}

SiteState open_site_state(const std::string& file, const Site& site, double voxel_size_m) {
  auto bounds = read_site_state(file, site, voxel_size_m);
  if (bounds) return {std::move(*bounds), read_noise(file, site), file};
  std::error_code error;
  const std::string aside = free_name(file);
  if (!aside.empty() && fs::is_regular_file(file, error)) {
    fs::rename(file, aside, error);
    if (!error) {
      log::warning("{}; it is now {}, and learning begins anew", bounds.error().message, aside);
      return {{}, {}, file};
    }
  }
  log::warning("{}; it stays as it is, and what is learned is kept in memory alone", bounds.error().message);
  return {};
}

Status write_site_state(const std::string& file, const Site& site, double voxel_size_m,
                        const CellBounds& bounds, const std::vector<DepthNoise>& noise) {
  nlohmann::ordered_json lidars = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < site.global_lidars.size(); ++i) {
    const GlobalLidar& lidar = site.global_lidars[i];
    const Eigen::Vector3d place = lidar.T_map_sensor.translation();
    lidars[lidar.id] = {{"x", place.x()}, {"y", place.y()}, {"z", place.z()}};
    if (i < noise.size() && noise[i].samples > 0) lidars[lidar.id]["noise"] = noise_json(noise[i]);
  }
  nlohmann::ordered_json object{{"format", kFormat},
                                {"version", kVersion},
                                {"cell_m", CellBounds::kCell_m},
                                {"voxel_size_m", voxel_size_m},
                                {"lidars", std::move(lidars)},
                                {"cells", nlohmann::ordered_json::array()}};
  for (const auto& [at, cell] : bounds.cells())
    object["cells"].push_back({{"x", at.x},
                               {"y", at.y},
                               {"count", cell.count},
                               {"fitness_mean", cell.mean},
                               {"fitness_sd", std::sqrt(cell.variance)}});
  return write_file(file, object.dump(1) + "\n");
}

}  // namespace liloc

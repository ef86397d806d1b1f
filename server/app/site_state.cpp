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
constexpr int kVersion = 1;
constexpr double kAny = 1e9;

/// A field that the rest of the file is worth nothing without.
Status expect(const JsonFields& fields, const char* name, double value) {
  const auto found = fields.number(name, -kAny, kAny);
  if (!found) return tl::unexpected(found.error());
  if (std::abs(*found - value) > 1e-9)
    return fail("{} is {}, this server works with {}; delete the file to learn anew", fields.path(name), *found,
                value);
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

Result<CellBounds> parse(const std::string& file, double voxel_size_m) {
  const auto object = read_json_object(file);
  if (!object) return tl::unexpected(object.error());
  const JsonFields fields(*object, file);
  const auto format = fields.text("format");
  if (!format || *format != kFormat) return fail("{}: is no {}; name another file", file, kFormat);
  for (const Status& status :
       {expect(fields, "version", kVersion), expect(fields, "cell_m", CellBounds::kCell_m),
        expect(fields, "voxel_size_m", voxel_size_m)})
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

}  // namespace

std::string state_file_of(const std::string& site_file) {
  return fs::path(site_file).replace_extension(".state.json").string();
}

Result<CellBounds> read_site_state(const std::string& file, double voxel_size_m) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error))) return CellBounds{};
  return parse(file, voxel_size_m);
}

CellBounds open_site_state(const std::string& file, double voxel_size_m) {
  auto bounds = read_site_state(file, voxel_size_m);
  if (bounds) return std::move(*bounds);
  log::warning("{}; starting with nothing learned", bounds.error().message);
  std::error_code error;
  if (fs::is_regular_file(file, error)) fs::rename(file, file + ".unreadable", error);
  return {};
}

Status write_site_state(const std::string& file, double voxel_size_m, const CellBounds& bounds) {
  nlohmann::ordered_json object{{"format", kFormat},
                                {"version", kVersion},
                                {"cell_m", CellBounds::kCell_m},
                                {"voxel_size_m", voxel_size_m},
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

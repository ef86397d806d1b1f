#include "common/registration/search/gravity_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <thread>
#include <tuple>
#include <unordered_set>

#include "common/geometry/voxel.hpp"
#include "common/registration/field/climber.hpp"
#include "common/registration/field/row_sums.hpp"

namespace liloc {
namespace {

constexpr std::size_t kFirstPoints = 160;  // that score every place; by hand
constexpr std::size_t kHeap = 1200;        // places that survive, per thread; 4000 found no more, DECISIONS.md
// First step in m and rad, and how often it is halved, repeated, and with how many points; by hand.
constexpr Climber::Steps kFirstClimb{0.1, radians(2.5), 0, 2, 80};
constexpr Climber::Steps kSecondClimb{0.1, radians(2.5), 2, 6, 240};

struct Cell {
  std::int16_t score;
  std::int16_t x, y, z, yaw;
  std::int16_t region;  ///< whose cells x, y and z count
};

bool better(const Cell& a, const Cell& b) {
  return std::tie(b.score, a.yaw, a.region, a.z, a.y, a.x) < std::tie(a.score, b.yaw, b.region, b.z, b.y, b.x);
}

/// Keeps the best `capacity` cells seen.
class Best {
 public:
  explicit Best(std::size_t capacity) : capacity_(capacity) { heap_.reserve(capacity + 1); }
  [[nodiscard]] int threshold() const { return heap_.size() < capacity_ ? 0 : heap_.front().score; }
  void offer(const Cell& cell) {
    if (cell.score <= threshold()) return;
    heap_.push_back(cell);
    std::push_heap(heap_.begin(), heap_.end(), better);
    if (heap_.size() <= capacity_) return;
    std::pop_heap(heap_.begin(), heap_.end(), better);
    heap_.pop_back();
  }
  [[nodiscard]] const std::vector<Cell>& cells() const { return heap_; }

 private:
  std::size_t capacity_;
  std::vector<Cell> heap_;
};

/// The sums of one height, and which exceed what was known then of the best.
struct Slab {
  std::vector<std::int16_t> sums;
  std::vector<std::uint32_t> above;
};

/// Which yaw of the device is tried in which region of the room.
struct Turn {
  int yaw;
  std::size_t region;
};

/// Offers every place of `here` that no neighbour in x, y and z beats. Slabs below and above may be null.
void offer_maxima(const Slab* below, const Slab& here, const Slab* above, const RowSums& shape, int z,
                  const Turn& turn, Best* best) {
  const int width = shape.width(), height = shape.height();
  const auto beaten = [&](const Slab* slab, int x, int y, std::int16_t s) {
    if (slab == nullptr) return false;
    for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
        if (slab->sums[static_cast<std::size_t>(v * width + u)] > s) return true;
    return false;
  };
  for (const std::uint32_t i : here.above) {
    const std::int16_t s = here.sums[i];
    const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
    if (s <= best->threshold()) continue;
    if (beaten(&here, x, y, s) || beaten(below, x, y, s) || beaten(above, x, y, s)) continue;
    best->offer({s, static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), static_cast<std::int16_t>(z),
                 static_cast<std::int16_t>(turn.yaw), static_cast<std::int16_t>(turn.region)});
  }
}

/// Of the cells, best first, those with no better one within a block of about 0.4 m and 10 degrees.
std::vector<Cell> spread(std::vector<Cell> cells, std::size_t most) {
  std::sort(cells.begin(), cells.end(), better);
  std::map<int, std::unordered_set<std::uint64_t>> taken;  // by region
  std::vector<Cell> kept;
  for (const Cell& c : cells) {
    if (kept.size() >= most) break;
    const auto key = cell_key({c.x / 2, c.y / 2, c.z / 2 + 256 * (c.yaw / 2)});
    if (taken[c.region].insert(key).second) kept.push_back(c);
  }
  return kept;
}

Eigen::Matrix3d yaw_rotation(double yaw_rad, const Eigen::Vector3d& up_map) {
  return Eigen::AngleAxisd(yaw_rad, up_map).toRotationMatrix();
}

/// The device's spread points in the map's axes at yaw 0, in an order of which any leading part is spread too.
Cloud level_points(const Query& query, const Eigen::Matrix3f& R_level_sensor) {
  std::vector<std::size_t> order(query.sparse.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 rng(1);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng() % i]);
  Cloud level;
  for (const std::size_t i : order) {
    level.points.emplace_back(R_level_sensor * query.sparse.points[i]);
    level.normals.emplace_back(R_level_sensor * query.sparse.normals[i]);
  }
  return level;
}

std::vector<CellOffset> offsets_of(const Cloud& level, const Eigen::Matrix3f& R, double cell_m) {
  const auto inverse = static_cast<float>(1.0 / cell_m);
  std::vector<CellOffset> offsets;
  for (std::size_t i = 0; i < std::min(kFirstPoints, level.size()); ++i) {
    const Eigen::Vector3i cell = ((R * level.points[i]).array() * inverse).round().cast<int>();
    offsets.push_back({cell.x(), cell.y(), cell.z(), ScoreField::plane_of(R * level.normals[i])});
  }
  return offsets;
}

/// Scores every position of one yaw.
void search_yaw(int depth, const Turn& turn, RowSums* sums, Best* best) {
  std::array<Slab, 3> slabs;  // heights z - 2, z - 1, z
  for (int z = 0; z <= depth; ++z) {
    if (z < depth) slabs[2].sums = sums->at_height(z, best->threshold(), &slabs[2].above);
    if (z > 0)
      offer_maxima(z > 1 ? &slabs[0] : nullptr, slabs[1], z < depth ? &slabs[2] : nullptr, *sums, z - 1, turn,
                   best);
    std::rotate(slabs.begin(), slabs.begin() + 1, slabs.end());
  }
}

/// Scores every place at every yaw; the best, spread out.
std::vector<Cell> search_coarse(const std::vector<ScoreField>& fields, const Cloud& level,
                                const GravitySearchOptions& options) {
  const auto deadline = std::chrono::steady_clock::now() + options.time_limit;
  const int yaws = std::max(1, static_cast<int>(std::lround(360.0 / options.yaw_step_deg)));
  const int threads = std::clamp(options.threads, 1, 64);
  std::vector<Best> best(static_cast<std::size_t>(threads), Best(kHeap));
  std::vector<BlockMaxima> maxima;
  for (const ScoreField& field : fields) maxima.emplace_back(field, RowSums::kBlock);
  const auto work = [&](int worker) {  // fixed shares, so that the answer does not depend on scheduling
    std::vector<RowSums> sums;
    for (std::size_t k = 0; k < fields.size(); ++k) sums.emplace_back(fields[k], maxima[k]);
    for (int yaw = worker; yaw < yaws && std::chrono::steady_clock::now() < deadline; yaw += threads) {
      const Eigen::Matrix3f R = yaw_rotation(yaw * 2 * M_PI / yaws, options.up_map).cast<float>();
      for (std::size_t k = 0; k < fields.size(); ++k) {
        sums[k].take(offsets_of(level, R, fields[k].cell_m()));
        search_yaw(fields[k].size().z(), {yaw, k}, &sums[k], &best[static_cast<std::size_t>(worker)]);
      }
    }
  };
  {
    std::vector<std::jthread> pool;
    for (int worker = 1; worker < threads; ++worker) pool.emplace_back(work, worker);
    work(0);
  }
  std::vector<Cell> cells;
  for (const Best& b : best) cells.insert(cells.end(), b.cells().begin(), b.cells().end());
  return spread(std::move(cells), options.climb_first);
}

/// Climbs all a little, then the best to the top.
std::vector<LevelPose> climb(const Target& target, const Cloud& level, const std::vector<Cell>& cells,
                             const GravitySearchOptions& options) {
  const int yaws = std::max(1, static_cast<int>(std::lround(360.0 / options.yaw_step_deg)));
  struct Start {
    LevelPose top;
    Climber* climber;
  };
  std::map<int, Climber> climbers;  // by region
  std::vector<Start> starts;
  for (const Cell& cell : cells) {
    const auto region = static_cast<std::size_t>(cell.region);
    const ScoreField& coarse = target.field_coarse().regions()[region];
    Climber& climber = climbers
                           .try_emplace(cell.region, target->field_fine().regions()[region],
                                        target.dynamic_mask(), options.up_map, level)
                           .first->second;
    const Eigen::Vector3d position =
        coarse.origin().cast<double>() +
        (Eigen::Vector3d(cell.x, cell.y, cell.z).array() + 0.5).matrix() * coarse.cell_m();
    starts.push_back(
        {climber.climb({position.x(), position.y(), position.z(), cell.yaw * 2 * M_PI / yaws}, kFirstClimb),
         &climber});
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.top.score > b.top.score; });
  if (starts.size() > options.climb_second) starts.resize(options.climb_second);
  std::vector<LevelPose> poses;
  for (const Start& start : starts) poses.push_back(start.climber->climb(start.top.pose, kSecondClimb));
  return poses;
}

}  // namespace

std::vector<Candidate> gravity_search(const Target& target, const Query& query,
                                      const Eigen::Vector3d& up_sensor, const GravitySearchOptions& options) {
  const ScoreFields& fields = target.field_coarse();
  if (fields.empty() || query.sparse.empty()) return {};
  const Eigen::Matrix3d R_level_sensor =
      Eigen::Quaterniond::FromTwoVectors(up_sensor, options.up_map).toRotationMatrix();
  const Cloud level = level_points(query, R_level_sensor.cast<float>());
  const std::vector<Cell> cells = search_coarse(fields.regions(), level, options);
  std::vector<Candidate> candidates;
  for (const LevelPose& top : climb(target, level, cells, options)) {
    Candidate candidate;
    candidate.T_map_sensor.linear() = yaw_rotation(top.pose[3], options.up_map) * R_level_sensor;
    candidate.T_map_sensor.translation() = top.pose.head<3>();
    candidate.score = top.score / (ScoreField::kSurface * static_cast<double>(level.size()));
    candidates.push_back(candidate);
  }
  return distinct(std::move(candidates), options.propose);
}

}  // namespace liloc

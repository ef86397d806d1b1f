#include "common/registration/gravity_search.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "common/registration/simd.hpp"

namespace liloc {
namespace {

/// sums[r][i] += rows[r][i]: one device point over every position of a slab. `width` is a multiple of 16.
LILOC_WIDE void add_rows(std::int16_t* sums, const std::int8_t* rows, int count, int width,
                         std::ptrdiff_t stride) {
  for (int r = 0; r < count; ++r, sums += width, rows += stride)
    for (int i = 0; i < width; ++i) sums[i] = static_cast<std::int16_t>(sums[i] + rows[i]);
}

/// The coarse field with a margin of zeros wide enough that no row runs out of it.
class PaddedField {
 public:
  PaddedField(const ScoreField& field, int margin)
      : margin_(margin),
        width_((field.size().x() + 15) / 16 * 16),
        height_(field.size().y()),
        depth_(field.size().z()),
        stride_(width_ + 2 * margin),
        cells_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>((height_ + 2 * margin) * depth_)) {
    for (int z = 0; z < depth_; ++z)
      for (int y = 0; y < height_; ++y)
        std::copy_n(field.row(y, z), field.size().x(), cells_.begin() + offset(0, y, z));
  }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] int depth() const { return depth_; }
  [[nodiscard]] int margin() const { return margin_; }
  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }
  [[nodiscard]] const std::int8_t* at(int x, int y, int z) const { return cells_.data() + offset(x, y, z); }

 private:
  [[nodiscard]] std::ptrdiff_t offset(int x, int y, int z) const {
    return (static_cast<std::ptrdiff_t>(z) * (height_ + 2 * margin_) + y + margin_) * stride_ + x + margin_;
  }
  int margin_, width_, height_, depth_;
  std::ptrdiff_t stride_;
  std::vector<std::int8_t> cells_;
};

constexpr std::size_t kFirstPass = 5;  // so many times `keep` cells survive a third of the points

struct Cell {
  std::int16_t score;
  std::int16_t x, y, z, yaw;
};

bool better(const Cell& a, const Cell& b) {
  return a.score > b.score;
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

/// Offers every local maximum (of its eight neighbours) of a slab of sums.
void offer_maxima(const std::vector<std::int16_t>& sums, int width, int height, int z, int yaw, Best* best) {
  const auto at = [&](int x, int y) {
    return x < 0 || y < 0 || x >= width || y >= height
               ? std::int16_t{-32768}
               : sums[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::int16_t s = at(x, y);
      if (s <= best->threshold()) continue;
      if (s < at(x - 1, y) || s < at(x, y - 1) || s < at(x - 1, y - 1) || s < at(x + 1, y - 1)) continue;
      if (s <= at(x + 1, y) || s <= at(x, y + 1) || s <= at(x + 1, y + 1) || s <= at(x - 1, y + 1)) continue;
      best->offer({s, static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), static_cast<std::int16_t>(z),
                   static_cast<std::int16_t>(yaw)});
    }
}

Eigen::Matrix3d yaw_rotation(double yaw_rad, const Eigen::Vector3d& up_map) {
  return Eigen::AngleAxisd(yaw_rad, up_map).toRotationMatrix();
}

/// Scores every position of one yaw.
void search_yaw(const PaddedField& field, const std::vector<Eigen::Vector3f>& level_points, double cell_m,
                int yaw, const Eigen::Matrix3f& R, Best* best) {
  const float inverse = static_cast<float>(1.0 / cell_m);
  std::vector<Eigen::Vector3i> offsets;
  offsets.reserve(level_points.size());
  for (const auto& p : level_points) {
    const Eigen::Vector3i cell = ((R * p).array() * inverse).round().cast<int>();
    if (std::abs(cell.x()) <= field.margin() && std::abs(cell.y()) <= field.margin()) offsets.push_back(cell);
  }
  std::vector<std::int16_t> sums(static_cast<std::size_t>(field.width()) *
                                 static_cast<std::size_t>(field.height()));
  for (int z = 0; z < field.depth(); ++z) {
    std::fill(sums.begin(), sums.end(), std::int16_t{0});
    for (const Eigen::Vector3i& o : offsets)
      if (z + o.z() >= 0 && z + o.z() < field.depth())
        add_rows(sums.data(), field.at(o.x(), o.y(), z + o.z()), field.height(), field.width(), field.stride());
    offer_maxima(sums, field.width(), field.height(), z, yaw, best);
  }
}

/// Hill climbing in x, y, z and yaw on the fine field.
struct Climber {
  const ScoreField& field;
  const std::vector<Eigen::Vector3f> level_points;
  const Eigen::Vector3d up_map;

  [[nodiscard]] int score(const Eigen::Vector4d& pose) const {
    const Eigen::Matrix3f R = yaw_rotation(pose[3], up_map).cast<float>();
    const Eigen::Vector3f t = pose.head<3>().cast<float>();
    int sum = 0;
    for (const auto& p : level_points) sum += field.at(R * p + t);
    return sum;
  }
  int climb(Eigen::Vector4d* pose) const {
    int best = score(*pose);
    for (const double scale : {1.0, 0.5}) {
      for (int round = 0; round < 3; ++round) {
        bool improved = false;
        for (int axis = 0; axis < 4; ++axis) {
          const double step = scale * (axis == 3 ? radians(2.5) : 0.1);
          for (const double sign : {1.0, -1.0}) {
            Eigen::Vector4d next = *pose;
            next[axis] += sign * step;
            const int value = score(next);
            if (value <= best) continue;
            best = value;
            *pose = next;
            improved = true;
            break;
          }
        }
        if (!improved) break;
      }
    }
    return best;
  }
};

struct Start {
  Eigen::Vector4d pose;  ///< x, y, z, yaw
  int score;
};

std::vector<Eigen::Vector3f> every_nth(const std::vector<Eigen::Vector3f>& points, std::size_t n) {
  std::vector<Eigen::Vector3f> result;
  for (std::size_t i = 0; i < points.size(); i += n) result.push_back(points[i]);
  return result;
}

}  // namespace

std::vector<Candidate> gravity_search(const Target& target, const Query& query,
                                      const Eigen::Vector3d& up_sensor, const GravitySearchOptions& options) {
  const ScoreField& coarse = target->field_coarse();
  if (coarse.empty() || query.sparse.empty()) return {};
  const auto deadline = std::chrono::steady_clock::now() + options.time_limit;
  const Eigen::Matrix3d R_level_sensor =
      Eigen::Quaterniond::FromTwoVectors(up_sensor, options.up_map).toRotationMatrix();
  std::vector<Eigen::Vector3f> level_points;
  float range = 0;
  for (const auto& p : query.sparse.points) {
    level_points.push_back(R_level_sensor.cast<float>() * p);
    range = std::max(range, level_points.back().norm());
  }
  const int margin = std::min(64, static_cast<int>(std::ceil(range / coarse.cell_m())) + 1);
  const PaddedField padded(coarse, margin);
  const std::vector<Eigen::Vector3f> first_points = every_nth(level_points, 3);

  const int yaws = std::max(1, static_cast<int>(std::lround(360.0 / options.yaw_step_deg)));
  const int threads = std::clamp(options.threads, 1, 64);
  std::vector<Best> best(static_cast<std::size_t>(threads), Best(kFirstPass * options.keep));
  const auto work = [&](int worker) {  // fixed shares, so that the answer does not depend on scheduling
    for (int yaw = worker; yaw < yaws && std::chrono::steady_clock::now() < deadline; yaw += threads)
      search_yaw(padded, first_points, coarse.cell_m(), yaw,
                 yaw_rotation(yaw * 2 * M_PI / yaws, options.up_map).cast<float>(),
                 &best[static_cast<std::size_t>(worker)]);
  };
  {
    std::vector<std::jthread> pool;
    for (int worker = 1; worker < threads; ++worker) pool.emplace_back(work, worker);
    work(0);
  }
  std::vector<Cell> cells;
  for (const Best& b : best) cells.insert(cells.end(), b.cells().begin(), b.cells().end());
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) {
    return std::tie(b.score, a.yaw, a.z, a.y, a.x) < std::tie(a.score, b.yaw, b.z, b.y, b.x);
  });
  if (cells.size() > kFirstPass * options.keep) cells.resize(kFirstPass * options.keep);

  std::vector<Start> starts;
  const Climber second{coarse, level_points, options.up_map},
      third{target->field_fine(), every_nth(level_points, 2), options.up_map};
  for (const Cell& cell : cells) {
    const Eigen::Vector3d position =
        coarse.origin().cast<double>() +
        (Eigen::Vector3d(cell.x, cell.y, cell.z).array() + 0.5).matrix() * coarse.cell_m();
    const Eigen::Vector4d pose(position.x(), position.y(), position.z(), cell.yaw * 2 * M_PI / yaws);
    starts.push_back({pose, second.score(pose)});
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.score > b.score; });
  if (starts.size() > options.keep) starts.resize(options.keep);

  std::vector<Candidate> candidates;
  for (auto& [pose, ignored] : starts) {
    const int score = third.climb(&pose);
    Candidate candidate;
    candidate.T_map_sensor.linear() = yaw_rotation(pose[3], options.up_map) * R_level_sensor;
    candidate.T_map_sensor.translation() = pose.head<3>();
    candidate.score = score / (ScoreField::kSurface * static_cast<double>(third.level_points.size()));
    candidates.push_back(candidate);
  }
  return distinct(std::move(candidates), options.propose);
}

}  // namespace liloc

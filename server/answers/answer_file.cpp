#include "server/answers/answer_file.hpp"

#include <algorithm>

#include "common/recording/files.hpp"
#include "server/answers/compression.hpp"
#include "server/answers/room_tables.hpp"

namespace liloc::answers {
namespace {

constexpr std::string_view kMagic = "LILOCANS";  // at the start of every file
constexpr std::uint32_t kVersion = 1;            ///< raised when fields.hpp changes
constexpr std::size_t kHead = kMagic.size() + sizeof(kVersion), kMostBytes = std::size_t{512} << 20;

constexpr std::size_t kMostPoints = kMostCloudBytes;

/// What a spot is made of.
struct RememberedSpot {
  SpotRequest request;
  std::vector<std::uint32_t> moving;
  std::uint32_t snapshot = 0;  ///< by its number
};

/// Plain copies of what a session remembers.
struct Remembered {
  std::vector<RememberedSpot> spots;
  std::deque<Tracks::Searched> searches;
  std::vector<Track> tracks;
};

template <class A, class Segment>
void segment_fields(A& a, Segment& segment, Remembered& memory) {
  numbers(a, segment.id, segment.weak_in_a_row, segment.spots_since_search);
  list(a, segment.own_answers, 3, [&](auto& answer) {
    fields(a, answer.T_map_sensor);
    fields(a, answer.T_odom_sensor);
  });
  maybe(a, segment.followed, [&](auto& followed) { fields(a, followed); });
  list(a, memory.spots, kMostSpots, [&](auto& spot) {
    fields(a, spot.request);
    list(a, spot.moving, kMostPoints, [&](auto& point) { a.number(point); });
    a.number(spot.snapshot);
  });
  list(a, memory.searches, kMostSpots, [&](auto& search) {
    fields(a, search.T_odom_sensor);
    fields(a, search.T_map_sensor);
  });
  list(a, memory.tracks, kMostTracks, [&](auto& track) {
    fields(a, track);
    a.require(track.looks.size() == memory.spots.size(), "a track whose looks are not one a spot");
  });
}

using Cells = std::vector<std::pair<GridCell, CellBounds::Cell>>;
template <class A>
void cell_fields(A& a, Cells& cells) {
  list(a, cells, CellBounds::kMostCells, [&](auto& cell) {
    numbers(a, cell.first.x, cell.first.y, cell.second.count, cell.second.mean, cell.second.variance);
  });
}

void write_segment(ArchiveOut& out, const std::optional<DeviceSession::Segment>& before,
                   const std::vector<const Snapshot*>& snapshots) {
  out.number(before.has_value());
  if (!before) return;
  const Tracks::Memory known = before->tracks.memory();
  Remembered memory{{}, known.searches, known.tracks};
  for (const auto& spot : known.spots)
    memory.spots.push_back(
        {spot->request(), spot->moving(),
         static_cast<std::uint32_t>(std::ranges::find(snapshots, spot->snapshot().get()) - snapshots.begin())});
  segment_fields(out, *before, memory);
}

std::shared_ptr<const Spot> spot_of(ArchiveIn& in, const RememberedSpot& remembered, const RoomsIn& rooms,
                                    const LocalizerOptions& options) {
  in.require(remembered.snapshot < rooms.snapshots.size(), "a number of a moment that is not there");
  if (!in.status()) return nullptr;
  const auto spot = Spot::create(remembered.request, rooms.snapshots[remembered.snapshot], options, nullptr,
                                 [&](const Cloud& /*cloud_sensor*/) { return remembered.moving; });
  in.require(spot.has_value(), "a cloud that cannot be used");
  return spot ? *spot : nullptr;
}

std::optional<DeviceSession::Segment> read_segment(ArchiveIn& in, const RoomsIn& rooms,
                                                   const LocalizerOptions& options) {
  bool there = false;
  in.number(there);
  if (!there) return std::nullopt;
  DeviceSession::Segment segment;
  Remembered memory;
  segment_fields(in, segment, memory);
  Tracks::Memory known{{}, std::move(memory.searches), std::move(memory.tracks)};
  for (const RememberedSpot& spot : memory.spots) known.spots.push_back(spot_of(in, spot, rooms, options));
  if (!in.status()) return std::nullopt;
  segment.tracks = Tracks(TrackOptions{}, std::move(known));
  return segment;
}

std::shared_ptr<const CellBounds> read_bounds(ArchiveIn& in) {
  Cells cells;
  cell_fields(in, cells);
  auto bounds = std::make_shared<CellBounds>();
  for (const auto& [at, cell] : cells)
    if (in.status()) in.require(bounds->restore(at, cell), "bounds that nothing taught");
  return bounds;
}

Result<SavedAnswer> from_payload(std::string_view payload) {
  ArchiveIn in(payload);
  SavedAnswer saved;
  Answered& answered = saved.answered;
  fields(in, answered.options);
  fields(in, answered.request);
  fields(in, answered.reply);
  list(in, answered.moving, kMostPoints, [&](auto& point) { in.number(point); });
  in.number(answered.spare_time);
  if (!in.status()) return tl::unexpected(in.status().error());
  const RoomsIn rooms = read_rooms(in, global_cloud_options_for(answered.options).snapshot);
  in.require(!rooms.snapshots.empty(), "an answer without a room");
  if (!in.status()) return tl::unexpected(in.status().error());
  saved.lidars = rooms.lidars;
  answered.room = rooms.snapshots.front();
  answered.bounds = read_bounds(in);
  answered.before = read_segment(in, rooms, answered.options);
  in.require_end();
  if (!in.status()) return tl::unexpected(in.status().error());
  return saved;
}

}  // namespace

std::string to_bytes(const Answered& answered) {
  std::vector<const Snapshot*> snapshots{answered.room.get()};
  if (answered.before)
    for (const auto& spot : answered.before->tracks.memory().spots)
      if (std::ranges::find(snapshots, spot->snapshot().get()) == snapshots.end())
        snapshots.push_back(spot->snapshot().get());
  ArchiveOut out;
  fields(out, answered.options);
  fields(out, answered.request);
  fields(out, answered.reply);
  list(out, answered.moving, kMostPoints, [&](auto& point) { out.number(point); });
  out.number(answered.spare_time);
  RoomsOut(snapshots).write(out);
  Cells cells(answered.bounds->cells().begin(), answered.bounds->cells().end());
  cell_fields(out, cells);
  write_segment(out, answered.before, snapshots);
  ArchiveOut head;
  head.block(kMagic.data(), kMagic.size());
  head.number(kVersion);
  return head.bytes() + compressed(out.bytes());
}

Result<SavedAnswer> from_bytes(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kHead || !bytes.starts_with(kMagic))
    return fail("{}: is no saved answer; give a file that --save-answers wrote", name);
  std::uint32_t version = 0;
  std::memcpy(&version, bytes.data() + kMagic.size(), sizeof(version));
  if (version != kVersion)
    return fail("{}: has version {} of the format, this program reads {}; use the program that saved it", name,
                version, kVersion);
  const auto payload = decompressed(bytes.substr(kHead), kMostBytes);
  if (!payload) return fail("{}: holds {}; save it anew", name, payload.error().message);
  auto saved = from_payload(*payload);
  if (!saved) return fail("{}: is damaged: {}; save it anew", name, saved.error().message);
  return saved;
}

Result<SavedAnswer> read_answer(const std::filesystem::path& file) {
  const auto bytes = read_file(file, kMostBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return from_bytes(*bytes, file.string());
}

}  // namespace liloc::answers

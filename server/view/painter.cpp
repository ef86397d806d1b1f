#include "server/view/painter.hpp"

#include <algorithm>

#include "common/codec/codec.hpp"
#include "server/view/points_message.hpp"
#include "server/view/text_messages.hpp"

namespace liloc::view {
namespace {

using std::chrono::seconds;

/// By hand.
constexpr seconds kRoomEvery{2}, kTrailsEvery{5}, kChartsEvery{1};
constexpr std::size_t kScansDrawn = 8;  // of those who are looked at in turn; at most 0.6 MB each

/// Notes the time where it is so.
bool due(std::optional<Painter::Time>& last, Painter::Time now, seconds every) {
  if (last && now - *last < every) return false;
  last = now;
  return true;
}

/// Here and below: without points where there is nothing any more, so that nobody goes on showing what was.
std::string moving_message(const Snapshot* moment) {
  std::vector<const Cloud*> clouds;
  if (moment != nullptr)
    for (const auto& frame : moment->frames()) clouds.push_back(&frame->moving_map());
  return points_message(Points::moving, clouds);
}

std::string room_message(const StitchedRoom* room) {  // not its indices, which nobody may need
  std::vector<const Cloud*> clouds;
  if (room != nullptr)
    for (const auto& part : room->parts()) clouds.push_back(&part->cloud_map());
  return points_message(Points::room, clouds);
}

/// Null where it cannot be decoded.
std::shared_ptr<const std::string> scan_message(const UnlocatedScan& scan) {
  const auto cloud_sensor = decode(scan.cloud_sensor);
  if (!cloud_sensor) return nullptr;
  const Cloud cloud_map = transformed(*scan.T_map_sensor, *cloud_sensor);
  const Cloud* const all[] = {&cloud_map};
  return std::make_shared<const std::string>(points_message(Points::scan, all));
}

}  // namespace

void Painter::paint_points(Time now) {
  auto moment = source_.moment();
  if (moment != shown_.moment) board_.put(Part::moving, {moving_message(moment.get()), true});
  auto room = moment ? moment->room() : nullptr;
  if (!room) shown_.room_at.reset();  // the end of a room waits for no turn, nor does the one after it
  if (room != shown_.room && (!room || due(shown_.room_at, now, kRoomEvery))) {
    board_.put(Part::room, {room_message(room.get()), true});
    shown_.room = std::move(room);
  }
  shown_.moment = std::move(moment);
}

void Painter::paint(Time now) {
  const web::ServerFacts facts = source_.facts();
  const Devices devices = source_.journal->devices(now);
  if (!shown_.site_at) board_.put(Part::site, {site_message(source_.site, facts)});
  shown_.site_at = now;
  board_.put(Part::now, {now_message(facts, devices, now)});
  paint_points(now);
  if (due(shown_.trails_at, now, kTrailsEvery)) board_.put(Part::trails, {trails_message(devices)});
  if (due(shown_.charts_at, now, kChartsEvery))
    board_.put(Part::charts, {charts_message(source_.journal->columns(now))});
  if (!source_.log) return;
  if (const auto count = source_.log->count(); count != shown_.log_count) {
    board_.put(Part::log, {log_message(source_.log->lines())});
    shown_.log_count = count;
  }
}

void Painter::rest() {
  board_.clear();
  shown_ = {};
  scans_.clear();
}

std::shared_ptr<const std::string> Painter::scan_of(const std::string& client_id) {
  const auto scan = source_.journal->scan_of(client_id);
  if (!scan || !scan->T_map_sensor) return nullptr;
  const auto known = std::ranges::find_if(scans_, [&](const auto& drawn) { return drawn.of.lock() == scan; });
  if (known != scans_.end()) return known->message;
  if (scans_.size() == kScansDrawn) scans_.pop_front();
  return scans_.emplace_back(Drawn{scan, scan_message(*scan)}).message;
}

}  // namespace liloc::view

#include "server/app/session_store.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "common/base/ids.hpp"
#include "common/base/log.hpp"
#include "common/recording/files.hpp"
#include "common/recording/json_fields.hpp"

namespace liloc {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kFormat = "liloc sessions";
constexpr int kVersion = 1;
// Devices are carried on by odometry for about so long before they count as lost; by hand.
constexpr double kMostAge_s = 60;
constexpr std::size_t kMost = 4096;  // ServiceOptions::max_clients

double seconds_between(SessionStore::Time a, SessionStore::Time b) {
  return std::chrono::duration<double>(b - a).count();
}

/// To the last bit: a recalibrated site is another one, whose map lies elsewhere.
std::string name_of_places(const Site& site) {
  std::string name;
  for (const GlobalLidar& lidar : site.global_lidars) {
    name += lidar.id;
    for (const double value : lidar.T_map_sensor.matrix().reshaped()) name += fmt::format(" {:.9g}", value);
    name += "; ";
  }
  return name;
}

ordered_json looks_to_json(const LookTerms& looks) {
  return {{"support", looks.support},
          {"contradiction", looks.contradiction},
          {"excess", looks.excess},
          {"misfit", looks.misfit}};
}

Result<LookTerms> looks_from(const JsonFields& fields) {
  LookTerms looks;
  for (const auto& [name, into] :
       {std::pair{"support", &looks.support}, std::pair{"contradiction", &looks.contradiction},
        std::pair{"excess", &looks.excess}, std::pair{"misfit", &looks.misfit}}) {
    const auto value = fields.number(name, -100, 100);
    if (!value) return tl::unexpected(value.error());
    *into = *value;
  }
  return looks;
}

ordered_json to_json(const Remembered& remembered) {
  const Followed& followed = remembered.followed;
  ordered_json covariance = ordered_json::array();
  for (const double value : followed.estimate.covariance.reshaped()) covariance.push_back(value);
  return {
      {"odom_segment", remembered.odom_segment}, {"T_map_sensor", pose_to_json(followed.estimate.T_map_sensor)},
      {"covariance", std::move(covariance)},     {"T_odom_sensor", pose_to_json(followed.T_odom_sensor)},
      {"log_odds", followed.log_odds},           {"usual", looks_to_json(followed.usual)}};
}

Result<Matrix6d> covariance_from(const JsonFields& fields) {
  const std::string where = fields.path("covariance");
  if (!fields.has("covariance") || !fields.raw("covariance").is_array() ||
      fields.raw("covariance").size() != 36)
    return fail("{} is no list of 36 numbers", where);
  Matrix6d covariance;
  for (Eigen::Index i = 0; i < 36; ++i) {
    const auto& value = fields.raw("covariance").at(static_cast<std::size_t>(i));
    covariance(i / 6, i % 6) = value.is_number() ? value.get<double>() : NAN;
  }
  const bool sound = covariance.allFinite() && covariance.isApprox(covariance.transpose(), 1e-6) &&
                     Eigen::SelfAdjointEigenSolver<Matrix6d>(covariance).eigenvalues().minCoeff() > 0;
  if (!sound) return fail("{} is no covariance", where);
  return covariance;
}

Result<Remembered> remembered_from(const JsonFields& fields) {
  const auto segment = fields.number("odom_segment", 0, 4294967295.0);
  if (!segment) return tl::unexpected(segment.error());
  const auto T_map_sensor = fields.pose("T_map_sensor"), T_odom_sensor = fields.pose("T_odom_sensor");
  if (!T_map_sensor) return tl::unexpected(T_map_sensor.error());
  if (!T_odom_sensor) return tl::unexpected(T_odom_sensor.error());
  const auto covariance = covariance_from(fields);
  if (!covariance) return tl::unexpected(covariance.error());
  const auto log_odds = fields.number("log_odds", -50, 50);
  if (!log_odds) return tl::unexpected(log_odds.error());
  if (!fields.has("usual") || !fields.raw("usual").is_object())
    return fail("{} is missing", fields.path("usual"));
  const auto usual = looks_from(JsonFields(fields.raw("usual"), fields.path("usual")));
  if (!usual) return tl::unexpected(usual.error());
  return Remembered{static_cast<std::uint32_t>(*segment),
                    begun({*T_map_sensor, *covariance}, *T_odom_sensor, *log_odds, *usual)};
}

/// As hexadecimal digits: a number of JSON has 53 bits.
std::optional<std::uint64_t> session_from(const Result<std::string>& text) {
  std::uint64_t session = 0;
  if (!text) return std::nullopt;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), session, 16);
  if (error != std::errc() || end != text->data() + text->size()) return std::nullopt;
  return session;
}

}  // namespace

std::string sessions_file_of(const std::string& state_file) {
  if (state_file.empty()) return "";
  constexpr std::string_view kState = ".state.json";
  const bool usual = state_file.ends_with(kState);
  return (usual ? state_file.substr(0, state_file.size() - kState.size()) : state_file) + ".sessions.json";
}

SessionStore::SessionStore(std::string file, const Site& site, StampNs wall_ns, Time now)
    : file_(std::move(file)), site_(name_of_places(site)) {
  std::error_code error;
  if (!file_.empty() && fs::exists(fs::symlink_status(file_, error))) read(wall_ns, now);
}

void SessionStore::read(StampNs wall_ns, Time now) {
  const auto object = read_json_object(file_);
  const auto unusable = [this](const std::string& why) {
    log::warning("{}: devices are searched anew: {}", file_, why);
    known_.clear();
  };
  if (!object) return unusable(object.error().message);
  const JsonFields fields(*object, file_);
  const auto format = fields.text("format"), site = fields.text("site");
  const auto version = fields.number("version", 0, 1e9), saved_s = fields.number("saved_s", 0, 1e11);
  if (!format || *format != kFormat || !version || *version != kVersion || !site || !saved_s)
    return unusable("it is no file of sessions of this version");
  const double age_s = to_seconds(wall_ns) - *saved_s;
  if (*site != site_ || age_s < 0 || age_s > kMostAge_s) return;
  if (!fields.has("clients") || !fields.raw("clients").is_array() || fields.raw("clients").size() > kMost)
    return unusable("its clients are no list");
  for (const auto& client : fields.raw("clients")) {
    if (!client.is_object()) return unusable("a client is no object");
    const JsonFields each(client, file_ + ": clients");
    const auto id = each.text("id");
    const auto session = session_from(each.text("session"));
    const auto older_s = each.number("age_s", 0, kMostAge_s);
    if (!id || !valid_id(*id, "id") || !session || !older_s)
      return unusable("a client has no id, session or age");
    auto remembered = remembered_from(each);
    if (!remembered) return unusable(remembered.error().message);
    known_[*id] = {
        *session,
        now - std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(age_s + *older_s)),
        std::move(*remembered)};
  }
}

std::optional<SessionStore::Resumable> SessionStore::begin(const std::string& client_id, std::uint64_t session,
                                                           Time now) {
  const std::scoped_lock lock(mutex_);
  make_room(now);
  Known& known = known_[client_id];
  const double age_s = seconds_between(known.at, now);
  if (known.session == session && known.remembered && age_s <= kMostAge_s)
    return Resumable{*known.remembered, age_s};
  known = {session, now, std::nullopt};
  changed_ = true;
  return std::nullopt;
}

void SessionStore::note(const std::string& client_id, std::uint64_t session,
                        const std::optional<Remembered>& remembered, Time now) {
  const std::scoped_lock lock(mutex_);
  const auto found = known_.find(client_id);
  if (found == known_.end() || found->second.session != session) return;
  found->second = {session, now, remembered};
  changed_ = true;
}

/// Of those that are too old to be of use; where that is not enough, the oldest.
void SessionStore::make_room(Time now) {
  if (known_.size() < kMost) return;
  std::erase_if(known_, [&](const auto& entry) { return seconds_between(entry.second.at, now) > kMostAge_s; });
  if (known_.size() < kMost) return;
  known_.erase(std::ranges::min_element(known_, {}, [](const auto& entry) { return entry.second.at; }));
}

Status SessionStore::save(StampNs wall_ns, Time now) {
  std::unique_lock lock(mutex_);
  if (file_.empty() || !std::exchange(changed_, false)) return {};
  ordered_json clients = ordered_json::array();
  for (const auto& [id, known] : known_) {
    const double age_s = seconds_between(known.at, now);
    if (!known.remembered || age_s > kMostAge_s) continue;
    ordered_json client{
        {"id", id}, {"session", fmt::format("{:x}", known.session)}, {"age_s", std::max(age_s, 0.0)}};
    client.update(to_json(*known.remembered));
    clients.push_back(std::move(client));
  }
  lock.unlock();
  const ordered_json object{{"format", kFormat},
                            {"version", kVersion},
                            {"site", site_},
                            {"saved_s", to_seconds(wall_ns)},
                            {"clients", std::move(clients)}};
  return write_file(file_, object.dump() + "\n");
}

}  // namespace liloc

#include "server/app/session_store.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/log.hpp"
#include "common/recording/private_file.hpp"
#include "server/app/remembered_json.hpp"

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
    for (const double value : lidar.T_map_sensor.matrix().reshaped()) name += fmt::format(" {}", value);
    name += "; ";
  }
  return name;
}

/// As hexadecimal digits: a number of JSON has 53 bits.
std::optional<std::uint64_t> session_from(const Result<std::string>& text) {
  std::uint64_t session = 0;
  if (!text) return std::nullopt;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), session, 16);
  if (error != std::errc() || end != text->data() + text->size()) return std::nullopt;
  return session;
}

/// A client as the file has it.
struct Client {
  std::string id;
  std::uint64_t session = 0;
  double age_s = 0;  ///< when it was written
  Remembered remembered;
};

Result<Client> client_from(const nlohmann::json& object, const std::string& where) {
  if (!object.is_object()) return fail("{} is no object", where);
  const JsonFields fields(object, where);
  const auto id =
      fields.text("id").and_then([&](const std::string& s) { return valid_id(s, fields.path("id")); });
  if (!id) return tl::unexpected(id.error());
  const auto session = session_from(fields.text("session"));
  if (!session) return fail("{} is none", fields.path("session"));
  const auto age_s = fields.number("age_s", 0, kMostAge_s);
  if (!age_s) return tl::unexpected(age_s.error());
  auto remembered = remembered_from(fields);
  if (!remembered) return tl::unexpected(remembered.error());
  return Client{*id, *session, *age_s, std::move(*remembered)};
}

/// One that cannot be used costs itself alone.
std::vector<Client> clients_from(const nlohmann::json& list, const std::string& file) {
  std::vector<Client> clients;
  std::string first;  // of what is wrong
  for (std::size_t i = 0; i < list.size(); ++i) {
    auto client = client_from(list[i], fmt::format("clients[{}]", i));
    if (client)
      clients.push_back(std::move(*client));
    else if (first.empty())
      first = client.error().message;
  }
  if (!first.empty())
    log::warning("{}: {} of {} devices are searched anew; the first: {}", file, list.size() - clients.size(),
                 list.size(), first);
  return clients;
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
  for (Client& client : clients_from(fields.raw("clients"), file_)) {
    const std::chrono::duration<double> older(age_s + client.age_s);
    known_[client.id] = {client.session, now - std::chrono::duration_cast<Time::duration>(older),
                         std::move(client.remembered)};
  }
}

std::optional<SessionStore::Resumable> SessionStore::begin(const std::string& client_id, std::uint64_t session,
                                                           Time now) {
  const std::scoped_lock lock(mutex_);
  if (!known_.contains(client_id)) make_room(now);
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
  const std::scoped_lock one_at_a_time(saving_);
  std::unique_lock lock(mutex_);
  if (file_.empty() || !std::exchange(changed_, false)) return {};
  const auto all = known_;  // `begin` and `note` do not wait for what follows
  lock.unlock();
  ordered_json clients = ordered_json::array();
  for (const auto& [id, known] : all) {
    const double age_s = seconds_between(known.at, now);
    if (!known.remembered || age_s > kMostAge_s) continue;
    ordered_json client{
        {"id", id}, {"session", fmt::format("{:x}", known.session)}, {"age_s", std::max(age_s, 0.0)}};
    client.update(to_json(*known.remembered));
    clients.push_back(std::move(client));
  }
  const ordered_json object{{"format", kFormat},
                            {"version", kVersion},
                            {"site", site_},
                            {"saved_s", to_seconds(wall_ns)},
                            {"clients", std::move(clients)}};
  Status written = write_private_file(file_, object.dump() + "\n");
  if (written) return written;
  lock.lock();
  changed_ = true;  // so that the next call tries again
  return written;
}

}  // namespace liloc

#include "server/app/server.hpp"

#include <systemd/sd-daemon.h>

#include "common/base/log.hpp"
#include "server/app/status_line.hpp"
#include "server/web/health.hpp"

namespace liloc {
namespace {

/// `idle` is asked by those who work on a request, so that there is a service.
LocalizerOptions with_idle(LocalizerOptions options, std::function<bool()> idle) {
  options.idle = std::move(idle);
  return options;
}

}  // namespace

Server::Server(const ServerOptions& options, Site site)
    : server_id_(options.service.server_id),
      voxel_size_m_(options.localizer.voxel_size_m),
      global_cloud_(std::move(site), global_cloud_options_for(options.localizer)),
      memory_(options.state_file, global_cloud_.site(), voxel_size_m_),
      localizer_(global_cloud_, with_idle(options.localizer, [this] { return service_->idle(); }),
                 memory_.at_start().learned,
                 options.save_answers
                     ? AnswerSink([this](Answered answered) { keeper_->keep(std::move(answered)); })
                     : AnswerSink()),
      sessions_(sessions_file_of(memory_.at_start().file), global_cloud_.site(), wall_clock_ns(), start_),
      journal_(options.page ? std::make_shared<view::Journal>() : nullptr) {
  memory_.begin(localizer_.learned());
  global_cloud_.set_known_noise(memory_.at_start().noise);
}

Server::~Server() {
  stop();
}

Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options, Site site,
                                              std::shared_ptr<const view::LogTail> log) {
  std::unique_ptr<Server> server(new Server(options, std::move(site)));
  server->log_ = std::move(log);
  if (options.save_answers) {
    auto store = answers::AnswerStore::open(*options.save_answers);
    if (!store) return fail("--{}", store.error().message);
    server->keeper_ = std::make_unique<answers::AnswerKeeper>(std::move(*store));
  }
  if (auto joined = server->join(options); !joined) return tl::unexpected(joined.error());
  return server;
}

Status Server::rejoin(const ServerOptions& options) {
  leave();
  Status joined = join(options);
  if (!joined) halt();
  return joined;
}

Status Server::join(const ServerOptions& options) {
  if (auto opened = open(options); !opened) return opened;
  dispatcher_->start();
  if (options.metrics)
    if (auto opened = open_web(*options.metrics); !opened) return opened;
  if (options.page)
    if (auto opened = page_.open(*options.page, options.page_token_file, page_source()); !opened) return opened;
  upkeep_ = std::make_unique<Upkeep>(Upkeep::Duties{.clients = [this] { return service_->clients(); },
                                                    .prepare = [this] { global_cloud_.prepare(); },
                                                    .save_sessions = [this] { save_sessions(); },
                                                    .save_learned = [this] { save_learned(); }});
  return {};
}

Status Server::open(const ServerOptions& options) {
  auto participant = wire::Participant::create(options.seat);
  if (!participant) return tl::unexpected(participant.error());
  participant_ = *participant;
  auto dispatcher = wire::Dispatcher::create(*participant);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  dispatcher_ = std::move(*dispatcher);
  auto publisher = wire::StatusPublisher::create(*participant);
  if (!publisher) return tl::unexpected(publisher.error());
  status_publisher_ = std::make_unique<wire::StatusPublisher>(std::move(*publisher));
  if (auto opened = open_streams(options); !opened) return opened;

  dispatcher_->every(std::chrono::seconds(1), [this] {
    beat_ = std::chrono::steady_clock::now();
    if (auto sent = status_publisher_->publish(status()); !sent) log::warning("{}", sent.error().message);
  });
  if (std::uint64_t limit_us = 0; sd_watchdog_enabled(0, &limit_us) > 0)  // three words within the limit
    dispatcher_->every(std::chrono::milliseconds(limit_us / 3000 + 1), [this] {
      const web::Page live = web::live_page(facts());
      if (live.status == 200) return (void)sd_notify(0, "WATCHDOG=1");
      log::error("no word to the watchdog, so that this server is started anew: {}", live.body);
    });
  if (options.status_every_s > 0)
    dispatcher_->every(std::chrono::milliseconds(static_cast<int>(options.status_every_s * 1e3) + 1),
                       [this] { log_status(); });
  return {};
}

Status Server::open_streams(const ServerOptions& options) {
  FrameSink sink;
  sink.add_depth = [this](std::size_t lidar, DepthImage image) {
    return global_cloud_.add_depth(lidar, std::move(image));
  };
  sink.add_points = [this](std::size_t lidar, StampNs stamp_ns, const Cloud& cloud_sensor) {
    return global_cloud_.add_points(lidar, stamp_ns, cloud_sensor);
  };
  sink.on_frame = [this] { service_->poke(); };
  auto ingest = Ingest::create(*dispatcher_, global_cloud_.site(), std::move(sink));
  if (!ingest) return tl::unexpected(ingest.error());
  ingest_ = std::move(*ingest);

  ServiceBackend backend;
  backend.locate = [this](const SpotRequest& request) { return locate(request); };
  backend.forget = [this](const std::string& client_id) {
    localizer_.forget(client_id);
    if (journal_) journal_->forget(client_id);
  };
  backend.begin = [this](const std::string& client_id, std::uint64_t session) {
    const auto known = sessions_.begin(client_id, session, std::chrono::steady_clock::now());
    if (!known) return;
    log::debug("{} is taken up again as it was {:.1f} s ago", client_id, known->age_s);
    localizer_.resume(client_id, known->remembered, known->age_s);
  };
  backend.on_located = [this](const std::string& client_id, std::uint64_t session) {
    sessions_.note(client_id, session, localizer_.remembered(client_id), std::chrono::steady_clock::now());
  };
  // A LiDAR whose last frame still counts for the stamp need not show a newer one: people move in between,
  // which registration leaves out anyway, and waiting for the very nearest frame of each takes 80 ms at 6 Hz.
  backend.seen_until = [this]() -> std::optional<StampNs> {
    const auto seen = ingest_->seen_until();
    return seen ? std::optional(*seen + global_cloud_.match_ns()) : std::nullopt;
  };
  backend.ceiling_now = [this](std::chrono::steady_clock::time_point at) { return ingest_->ceiling_now(at); };
  backend.on_stage = [this](Stage stage, double seconds) { metrics_.staged(stage, seconds); };
  backend.on_answer = [this](const SpotReply& reply) { note_answer(reply); };
  auto service = Service::create(*dispatcher_, options.service, std::move(backend));
  if (!service) return tl::unexpected(service.error());
  service_ = std::move(*service);
  return {};
}

Status Server::open_web(const web::Address& address) {
  auto web = web::WebServer::start(
      address, {{"/metrics",
                 [this] {
                   return web::Page{200, metrics_.text(facts()), "text/plain; version=0.0.4; charset=utf-8"};
                 }},
                {"/healthz", [this] { return web::live_page(facts()); }},
                {"/readyz", [this] { return web::ready_page(facts()); }}});
  if (!web) return fail("--metrics: {}", web.error().message);
  web_ = std::move(*web);
  return {};
}

view::Source Server::page_source() {
  return {.site = global_cloud_.site(),
          .facts = [this] { return facts(); },
          .moment = [this] { return global_cloud_.newest(); },
          .journal = journal_,
          .log = log_};
}

SpotReply Server::locate(const SpotRequest& request) {
  SpotReply reply = localizer_.locate(request);
  if (journal_) journal_->located(request, reply);
  return reply;
}

void Server::note_answer(const SpotReply& reply) {
  metrics_.answered(reply);
  if (journal_) journal_->answered(reply, std::chrono::steady_clock::now());
}

web::ServerFacts Server::facts() const {
  const auto now = std::chrono::steady_clock::now();
  web::ServerFacts facts;
  facts.server_id = server_id_;
  facts.version = LILOC_VERSION;
  facts.uptime_s = std::chrono::duration<double>(now - start_).count();
  facts.network_idle_s = std::chrono::duration<double>(now - beat_.load()).count();
  facts.clients = service_->clients();
  facts.service = service_->counters();
  facts.samples_lost = dispatcher_->samples_lost();
  const auto health = ingest_->health();
  const auto ages_s = ingest_->ages_s();
  for (std::size_t i = 0; i < health.size(); ++i) facts.lidars.push_back({health[i], ages_s[i]});
  return facts;
}

void Server::save_sessions() {
  const Status saved = sessions_.save(wall_clock_ns(), std::chrono::steady_clock::now());
  if (!std::exchange(sessions_saved_, saved.has_value()) || saved) return;
  log::warning("{}; devices are searched anew after a restart", saved.error().message);
}

void Server::save_learned() {
  memory_.save(localizer_.learned(), global_cloud_.noise());
}

/// In the order in which members go. `sessions_` stays: devices that join anew are taken up by it. Of those
/// whom the credentials no longer let in nobody asks again, and it has forgotten them after a minute.
void Server::leave() {
  halt();
  dispatcher_.reset();
  service_.reset();
  localizer_.forget_all();  // the next service knows none of its clients, and would never say that one has left
  if (journal_) journal_->forget_all();
  ingest_.reset();
  status_publisher_.reset();
  participant_.reset();
}

void Server::stop() {
  halt();
  if (keeper_) keeper_->stop();
}

void Server::halt() {
  page_.close();
  web_.reset();
  upkeep_.reset();
  if (service_) service_->stop();
  if (dispatcher_) dispatcher_->stop();
  save_learned();
  save_sessions();
}

wire::ServerStatus Server::status() const {
  const ServiceCounters counters = service_->counters();
  wire::ServerStatus status;
  status.server_id = server_id_;
  status.stamp_ns = wall_clock_ns();
  status.uptime_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  status.lidars = ingest_->health();
  status.clients = static_cast<std::uint32_t>(service_->clients());
  status.queued = counters.queued;
  status.answered = counters.answered;
  status.verified = counters.verified;
  status.refused = counters.refused;
  status.codecs.assign(kCloudCodecs.begin(), kCloudCodecs.end());
  return status;
}

void Server::log_status() const {
  log::info("{}", status_line(status(), global_cloud_.noise()));
}

}  // namespace liloc

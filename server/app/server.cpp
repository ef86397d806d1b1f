#include "server/app/server.hpp"

#include <malloc.h>
#include <systemd/sd-daemon.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>

#include "common/base/log.hpp"
#include "server/view/access.hpp"
#include "server/web/health.hpp"

namespace liloc {
namespace {

constexpr auto kPreparePeriod = std::chrono::milliseconds(50);  // a third of a ceiling frame's; by hand
constexpr auto kTrimPeriod = std::chrono::seconds(10);          // a trim takes milliseconds; by hand
constexpr auto kSaveSessionsPeriod = std::chrono::seconds(1);   // about an interval of requests; by hand
constexpr auto kSavePeriod = std::chrono::minutes(1);  // so much is lost with a server that is killed; by hand

/// Gives what clients that left have used back to the system; the C library would keep it.
class HeapTrimmer {
 public:
  void see(std::size_t clients) {
    most_ = std::max(most_, clients);
    const auto now = std::chrono::steady_clock::now();
    if (clients == most_ || now < next_) return;
    malloc_trim(0);
    most_ = clients;
    next_ = now + kTrimPeriod;
  }

 private:
  std::size_t most_ = 0;  ///< since the last trim
  std::chrono::steady_clock::time_point next_;
};

/// Nothing that is worth a write: within a tenth, at 3 m.
bool much_the_same(const std::vector<DepthNoise>& a, const std::vector<DepthNoise>& b) {
  return a.size() == b.size() && std::ranges::equal(a, b, [](const DepthNoise& x, const DepthNoise& y) {
           return (x.samples > 0) == (y.samples > 0) &&
                  std::abs(x.sigma_m(3) - y.sigma_m(3)) < 0.1 * y.sigma_m(3) &&
                  std::abs(x.missing - y.missing) < 0.1;
         });
}

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
      state_(options.state_file.empty()
                 ? SiteState{}
                 : open_site_state(options.state_file, global_cloud_.site(), voxel_size_m_)),
      localizer_(
          global_cloud_, with_idle(options.localizer, [this] { return service_->idle(); }), state_.learned,
          options.save_answers ? AnswerSink([this](Answered answered) { keeper_->keep(std::move(answered)); })
                               : AnswerSink()),
      sessions_(sessions_file_of(state_.file), global_cloud_.site(), wall_clock_ns(), start_),
      journal_(options.page ? std::make_shared<view::Journal>() : nullptr) {
  saved_ = localizer_.learned();
  global_cloud_.set_known_noise(state_.noise);
  saved_noise_ = state_.noise;
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
    if (auto opened = open_page(options); !opened) return opened;
  preparer_ = std::jthread([this](const std::stop_token& stop) { keep_prepared(stop); });
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

Status Server::open_page(const ServerOptions& options) {
  view::PageOptions page{*options.page, page_token_};  // viewers stay when devices have to join anew
  if (!options.page_token_file.empty()) {
    const auto token = view::token_from(options.page_token_file);
    if (!token) return fail("--web-token: {}", token.error().message);
    page.token = *token;
  } else if (page.token.empty() && !web::is_loopback(page.address)) {
    page.token = view::new_token();
  }
  auto server = view::PageServer::start(page, {.site = global_cloud_.site(),
                                               .facts = [this] { return facts(); },
                                               .moment = [this] { return global_cloud_.newest(); },
                                               .journal = journal_,
                                               .log = log_});
  if (!server) return fail("--web: {}", server.error().message);
  page_ = std::move(*server);
  page_token_ = page.token;
  page_url_ = fmt::format("http://{}/", web::text_of({page.address.host, page_->port()}));
  if (!page.token.empty() && options.page_token_file.empty()) page_url_ += "?token=" + page.token;
  return {};
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

/// Builds the room's indices beside the requests, as long as there is anyone who might ask.
void Server::keep_prepared(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  auto save_at = std::chrono::steady_clock::now() + kSavePeriod;
  auto sessions_at = std::chrono::steady_clock::now() + kSaveSessionsPeriod;
  HeapTrimmer trimmer;
  while (!stop.stop_requested()) {
    const std::size_t clients = service_->clients();
    trimmer.see(clients);
    try {
      if (clients > 0) global_cloud_.prepare();
    } catch (const std::exception& trouble) {  // the requests will say what is wrong with the room
      log::error("the room's indices were not made: {}", trouble.what());
    }
    if (std::chrono::steady_clock::now() >= sessions_at) {
      save_sessions();
      sessions_at = std::chrono::steady_clock::now() + kSaveSessionsPeriod;
    }
    if (std::chrono::steady_clock::now() >= save_at) {
      save_learned();
      save_at += kSavePeriod;
    }
    wake.wait_for(lock, stop, kPreparePeriod, [] { return false; });
  }
}

void Server::save_sessions() {
  const Status saved = sessions_.save(wall_clock_ns(), std::chrono::steady_clock::now());
  if (!std::exchange(sessions_saved_, saved.has_value()) || saved) return;
  log::warning("{}; devices are searched anew after a restart", saved.error().message);
}

/// At most once a minute, and at the end; only when something was learned.
void Server::save_learned() {
  auto learned = localizer_.learned();
  auto noise = global_cloud_.noise();
  if (state_.file.empty() || (learned == saved_ && much_the_same(noise, saved_noise_))) return;
  if (const Status written =
          write_site_state(state_.file, global_cloud_.site(), voxel_size_m_, *learned, noise);
      !written)
    log::warning("{}; or name another with --state", written.error().message);
  saved_ = std::move(learned);
  saved_noise_ = std::move(noise);
}

/// In the order in which members go.
void Server::leave() {
  halt();
  dispatcher_.reset();
  service_.reset();
  localizer_.forget_all();  // whom the credentials no longer let in must not be remembered
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
  page_.reset();
  web_.reset();
  preparer_.request_stop();
  if (preparer_.joinable()) preparer_.join();
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
  const auto now = status();
  std::string lidars;
  const auto noise = global_cloud_.noise();
  for (std::size_t i = 0; i < now.lidars.size(); ++i) {
    const auto& lidar = now.lidars[i];
    lidars += fmt::format("{}{} {} {:.1f} Hz", lidars.empty() ? "" : ", ", lidar.id, wire::name_of(lidar.state),
                          lidar.measured_hz);
    if (i < noise.size() && noise[i].samples > 0)
      lidars += fmt::format(" (noise {:.0f} mm at 3 m, {:.0f} % missing)", 1e3 * noise[i].sigma_m(3),
                            100 * noise[i].missing);
  }
  log::info("{} clients, {} queued, {} answered ({} verified, {} refused); {}", now.clients, now.queued,
            now.answered, now.verified, now.refused, lidars);
}

}  // namespace liloc

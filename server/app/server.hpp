#pragma once
// The server put together: ceiling streams in, global cloud, localizer, clients' requests answered.
#include <atomic>
#include <memory>
#include <optional>

#include "common/wire/spots/status.hpp"
#include "server/app/options.hpp"
#include "server/app/session_store.hpp"
#include "server/app/site_memory.hpp"
#include "server/app/site_page.hpp"
#include "server/app/upkeep.hpp"
#include "server/global_cloud/global_cloud.hpp"
#include "server/ingest/ingest.hpp"
#include "server/service/service.hpp"
#include "server/web/metrics.hpp"
#include "server/web/web_server.hpp"

namespace liloc {

class Server {
 public:
  /// `log`: the log's last lines, for the page; may be null.
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(const ServerOptions& options, Site site,
                                                             std::shared_ptr<const view::LogTail> log = {});
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Refuses new requests, finishes what waits, then hears no more of DDS. Safe to call twice.
  void stop();
  /// Leaves the network and joins it again, with credentials that have changed: only then does DDS look at
  /// them. What is known of the site and its clouds stays; devices join anew and are taken up (SessionStore).
  /// By the caller of `start`; an error leaves it stopped.
  [[nodiscard]] Status rejoin(const ServerOptions& options);
  [[nodiscard]] wire::ServerStatus status() const;
  /// Of the metrics; 0 without them.
  [[nodiscard]] int metrics_port() const { return web_ ? web_->port() : 0; }
  /// Of the page; 0 without it.
  [[nodiscard]] int page_port() const { return page_.port(); }
  /// What a browser opens to see the page, with the token where one is asked for; empty without it.
  [[nodiscard]] const std::string& page_url() const { return page_.url(); }

 private:
  Server(const ServerOptions& options, Site site);
  [[nodiscard]] Status join(const ServerOptions& options);
  void leave();
  void halt();  ///< all but what outlives a `rejoin`
  [[nodiscard]] Status open(const ServerOptions& options);
  [[nodiscard]] Status open_streams(const ServerOptions& options);
  [[nodiscard]] Status open_web(const web::Address& address);
  [[nodiscard]] view::Source page_source();
  [[nodiscard]] SpotReply locate(const SpotRequest& request);
  void note_answer(const SpotReply& reply);
  [[nodiscard]] web::ServerFacts facts() const;
  void log_status() const;
  void save_learned();
  void save_sessions();

  const std::string server_id_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double voxel_size_m_;
  GlobalCloud global_cloud_;
  SiteMemory memory_;
  Localizer localizer_;
  SessionStore sessions_;
  std::unique_ptr<answers::AnswerKeeper> keeper_;  ///< null: answers are not kept; holds moments of the room
  const std::shared_ptr<view::Journal> journal_;   ///< null where there is no page
  std::optional<wire::Participant> participant_;   // all below live on it
  std::unique_ptr<wire::StatusPublisher> status_publisher_;
  std::unique_ptr<Ingest> ingest_;
  std::unique_ptr<Service> service_;
  std::unique_ptr<wire::Dispatcher> dispatcher_;  // its thread uses all of the above: it goes first
  bool sessions_saved_ = true;                    ///< the last time; of the upkeep, then of `stop`
  std::unique_ptr<Upkeep> upkeep_;                // its thread asks all of the above
  std::atomic<std::chrono::steady_clock::time_point> beat_ = start_;  ///< when the dispatcher was last at work
  web::Metrics metrics_;
  std::shared_ptr<const view::LogTail> log_;  ///< for the page; may be null
  std::unique_ptr<web::WebServer> web_;       // its threads ask all of the above
  SitePage page_;                             // so does its thread
};

}  // namespace liloc

#pragma once
// The server put together: ceiling streams in, global cloud, localizer, clients' requests answered.
#include <atomic>
#include <memory>
#include <optional>
#include <thread>

#include "common/wire/spots/status.hpp"
#include "server/app/options.hpp"
#include "server/app/session_store.hpp"
#include "server/app/site_state.hpp"
#include "server/global_cloud/global_cloud.hpp"
#include "server/ingest/ingest.hpp"
#include "server/service/service.hpp"
#include "server/view/page_server.hpp"
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
  /// them. What is known of the site and its clouds stays; devices join anew. By the caller of `start`; an
  /// error leaves it stopped.
  [[nodiscard]] Status rejoin(const ServerOptions& options);
  [[nodiscard]] wire::ServerStatus status() const;
  /// Of the metrics; 0 without them.
  [[nodiscard]] int metrics_port() const { return web_ ? web_->port() : 0; }
  /// Of the page; 0 without it.
  [[nodiscard]] int page_port() const { return page_ ? page_->port() : 0; }
  /// What a browser opens to see the page, with the token where one is asked for; empty without it.
  [[nodiscard]] const std::string& page_url() const { return page_url_; }

 private:
  Server(const ServerOptions& options, Site site);
  [[nodiscard]] Status join(const ServerOptions& options);
  void leave();
  void halt();  ///< all but what outlives a `rejoin`
  [[nodiscard]] Status open(const ServerOptions& options);
  [[nodiscard]] Status open_streams(const ServerOptions& options);
  [[nodiscard]] Status open_web(const web::Address& address);
  [[nodiscard]] Status open_page(const ServerOptions& options);
  [[nodiscard]] SpotReply locate(const SpotRequest& request);
  void note_answer(const SpotReply& reply);
  [[nodiscard]] web::ServerFacts facts() const;
  void log_status() const;
  void keep_prepared(const std::stop_token& stop);
  void save_learned();
  void save_sessions();

  const std::string server_id_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double voxel_size_m_;
  std::shared_ptr<const CellBounds> saved_;  ///< as the state file has it; of the preparer, then of `stop`
  std::vector<DepthNoise> saved_noise_;      ///< the same file's
  GlobalCloud global_cloud_;
  const SiteState state_;  ///< as it was at the start
  Localizer localizer_;
  SessionStore sessions_;
  std::unique_ptr<answers::AnswerKeeper> keeper_;  ///< null: answers are not kept; holds moments of the room
  const std::shared_ptr<view::Journal> journal_;   ///< null where there is no page
  std::optional<wire::Participant> participant_;   // all below live on it
  std::unique_ptr<wire::StatusPublisher> status_publisher_;
  std::unique_ptr<Ingest> ingest_;
  std::unique_ptr<Service> service_;
  std::unique_ptr<wire::Dispatcher> dispatcher_;  // its thread uses all of the above: it goes first
  bool sessions_saved_ = true;                    ///< the last time; of the preparer, then of `stop`
  std::jthread preparer_;
  std::atomic<std::chrono::steady_clock::time_point> beat_ = start_;  ///< when the dispatcher was last at work
  web::Metrics metrics_;
  std::shared_ptr<const view::LogTail> log_;  ///< for the page; may be null
  std::string page_url_, page_token_;
  std::unique_ptr<web::WebServer> web_;     // its threads ask all of the above
  std::unique_ptr<view::PageServer> page_;  // so does its thread
};

}  // namespace liloc

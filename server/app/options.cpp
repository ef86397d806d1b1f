#include "server/app/options.hpp"

#include <CLI/CLI.hpp>

#include "common/command/checks.hpp"
#include "common/command/program_options.hpp"
#include "common/command/text.hpp"
#include "common/learned/describer.hpp"
#include "server/app/site_state.hpp"

namespace liloc {
namespace {

using command::in_range;

struct Raw {
  std::string method = "liloc", features = "fpfh", verify, icp, state, save_answers, log_level = "info",
              log_format = "text", metrics, page, weights;
  int hold_ms = 100;
  bool standby = false;
};

/// A second server on one host has its own port, name and file.
void settle_standby(const CLI::App& app, const Raw& raw, ServerOptions& options) {
  options.seat.role = raw.standby ? wire::Role::standby : wire::Role::server;
  if (raw.standby && app.count("--server-id") == 0) options.service.server_id += "-standby";
  if (raw.state == "none") return;
  options.state_file = raw.state.empty() ? state_file_of(options.site_file, raw.standby) : raw.state;
}

void declare_site(CLI::App& app, ServerOptions& options, Raw& raw) {
  app.set_version_flag("--version", LILOC_VERSION);
  app.add_option("--site", options.site_file, "Site description: the ceiling LiDARs and where they hang")
      ->required();
  app.add_option(
      "--state", raw.state,
      "File of what is learned of the site, or none; else beside the site: x/site.json, x/site.state.json");
}

void declare_network(CLI::App& app, ServerOptions& options, Raw& raw) {
  auto* network = app.add_option_group("network");
  network->add_option("--domain", options.seat.domain, "DDS domain")
      ->check(in_range(0, 230))
      ->capture_default_str();
  network->add_option("--interface", options.seat.interface, "Network interface: name, address or auto")
      ->capture_default_str();
  network->add_option(
      "--credentials", options.seat.credentials,
      "Folder of deploy/credentials: encrypted, and closed to all who have none of the same keystore");
  network
      ->add_option("--server-id", options.service.server_id,
                   "Name in replies and status; of two servers each needs its own")
      ->check(command::an_id())
      ->capture_default_str();
  network->add_flag("--standby", raw.standby,
                    "Beside another server on this host; --server-id is then NAME-standby unless it is given");
}

void declare_method(CLI::App& app, ServerOptions& options, Raw& raw) {
  auto* method = app.add_option_group("localization");
  method->add_option("--voxel", options.localizer.voxel_size_m, "Voxel size of the global cloud, m")
      ->check(in_range(0.01, 0.5))
      ->capture_default_str();
  method
      ->add_option("--method", raw.method,
                   "liloc, or for comparison: paper, dynamic-noopt, dynamic-nover, static-noopt")
      ->check(command::one_of({"liloc", "paper", "dynamic-noopt", "dynamic-nover", "static-noopt"}))
      ->capture_default_str();
  method
      ->add_option("--verify", raw.verify,
                   "tracks, paper (three equality checks) or none; else the method's own")
      ->check(command::one_of({"tracks", "paper", "none"}));
  method
      ->add_option("--risk", options.localizer.risk,
                   "Of all verified answers, the share that may be wrong (over 10 deg or 0.3 m)")
      ->check(in_range(1e-6, 0.1))
      ->capture_default_str();
  method
      ->add_option("--icp", raw.icp, "Last refinement: plane, or point as in the paper; else the method's own")
      ->check(command::one_of({"plane", "point"}));
  method->add_option("--features", raw.features, "Of points, for RANSAC: fpfh, or learned with --weights")
      ->check(command::one_of({"fpfh", "learned"}))
      ->capture_default_str();
  method->add_option("--weights", raw.weights,
                     "Network of --features learned, from common/learned/convert_fcgf.py");
  method->add_option("--sampling", options.localizer.sampling, "Share of points with features that RANSAC uses")
      ->check(in_range(0.01, 1.0))
      ->capture_default_str();
  method->add_option("--seed", options.localizer.seed, "Seed of all randomness")
      ->check(command::any_seed())
      ->capture_default_str();
}

void declare_load(CLI::App& app, ServerOptions& options, Raw& raw) {
  auto* load = app.add_option_group("load");
  load->add_option("--workers", options.service.workers, "Requests worked on at once")
      ->check(in_range(1, 64))
      ->capture_default_str();
  load->add_option("--threads", options.localizer.threads, "Threads of each request")
      ->check(in_range(1, 64))
      ->capture_default_str();
  load->add_option("--queue", options.service.queue, "Requests that may wait")
      ->check(in_range(1, 4096))
      ->capture_default_str();
  load->add_option("--max-rate", options.service.max_rate_hz, "Requests a second of one client")
      ->check(in_range(0.001, 1e4))
      ->capture_default_str();
  load->add_option("--max-clients", options.service.max_clients, "Clients served")
      ->check(in_range(1, 4096))
      ->capture_default_str();
  load->add_option("--hold-ms", raw.hold_ms, "Longest wait for the ceiling's next frame, ms")
      ->check(in_range(0, 1000))
      ->capture_default_str();
}

/// What it tells, and where.
void declare_outputs(CLI::App& app, ServerOptions& options, Raw& raw) {
  app.add_option(
      "--save-answers", raw.save_answers,
      "DIR[:refused|all]: keep what was not verified, or all, for liloc explain; the newest 200, 512 MiB");
  app.add_option("--log-level", raw.log_level, "debug, info, warning or error")
      ->check(command::one_of({"debug", "info", "warning", "error"}))
      ->capture_default_str();
  app.add_option("--log-format", raw.log_format, "text, or json: an object a line")
      ->check(command::one_of({"text", "json"}))
      ->capture_default_str();
  app.add_option(
      "--metrics", raw.metrics,
      "PORT or ADDRESS:PORT of /metrics (Prometheus), /healthz and /readyz; PORT alone: on loopback; "
      "default: none");
  app.add_option(
      "--web", raw.page,
      "PORT or ADDRESS:PORT of a page that shows the site in a browser; PORT alone: for browsers on this "
      "host; default: none");
  app.add_option(
      "--web-token", options.page_token_file,
      "File whose first line the page asks for; without it the server makes one up where ADDRESS can be "
      "reached by others, and tells it in the log");
  app.add_option("--status-every", options.status_every_s, "Seconds between status lines; 0: none")
      ->check(in_range(0.0, 86'400.0))
      ->capture_default_str();
}

void declare(CLI::App& app, ServerOptions& options, Raw& raw) {
  declare_site(app, options, raw);
  declare_network(app, options, raw);
  declare_method(app, options, raw);
  declare_load(app, options, raw);
  declare_outputs(app, options, raw);
}

Status set_variants(const Raw& raw, LocalizerOptions& localizer) {
  if (!raw.verify.empty()) {
    const auto verify = verify_from(raw.verify);
    if (!verify) return tl::unexpected(verify.error());
    localizer.verify = *verify;
  }
  if (!raw.icp.empty()) {
    const auto icp = icp_from(raw.icp);
    if (!icp) return tl::unexpected(icp.error());
    localizer.icp = *icp;
  }
  return localizer.validated();
}

Status set_address(const char* name, const std::string& text, std::optional<web::Address>& to) {
  if (text.empty()) return {};
  const auto address = web::address_from(text);
  if (!address) return fail("--{} is '{}'; {}", name, command::excerpt(text), address.error().message);
  to = *address;
  return {};
}

/// What was given as a word, and what must go together.
Status take(const CLI::App& app, const Raw& raw, ServerOptions& options) {
  const auto method = method_from(raw.method);
  if (!method) return tl::unexpected(method.error());
  options.localizer.method = *method;
  auto describer = learned::describer_from(raw.features, raw.weights, options.localizer.threads);
  if (!describer) return tl::unexpected(describer.error());
  options.localizer.describer = std::move(*describer);
  const auto level = log::level_from(raw.log_level);
  if (!level) return fail("--log-level: {}", level.error().message);
  options.log_level = *level;
  options.log_json = raw.log_format == "json";
  if (const auto set = set_address("metrics", raw.metrics, options.metrics); !set) return set;
  if (const auto set = set_address("web", raw.page, options.page); !set) return set;
  if (!options.page_token_file.empty() && !options.page) return fail("--web-token goes with --web");
  settle_standby(app, raw, options);
  if (const auto set = set_variants(raw, options.localizer); !set) return fail("--{}", set.error().message);
  if (!raw.save_answers.empty()) {
    if (options.localizer.describer)
      return fail(
          "--save-answers: answers are kept without the network, so that none could be given again; leave "
          "it out, or use --features fpfh");
    auto store = answers::store_options_from(raw.save_answers);
    if (!store) return fail("--{}", store.error().message);
    if (store->which == answers::Which::wrong)
      return fail(
          "--save-answers: only liloc replay knows which answers are wrong; give DIR:refused or DIR:all");
    options.save_answers = std::move(*store);
  }
  options.service.hold = std::chrono::milliseconds(raw.hold_ms);
  options.localizer.server_id = options.service.server_id;
  if (const auto valid = options.service.validated(); !valid) return tl::unexpected(valid.error());
  if (const auto valid = wire::profile_xml(options.seat); !valid) return fail("--{}", valid.error().message);
  return {};
}

}  // namespace

Result<ServerOptions> parse_arguments(int argc, char** argv, int& exit_code) {
  ServerOptions options;
  Raw raw;
  CLI::App app("Tells devices where they are, from the clouds of the LiDARs on the ceiling.", "liloc-server");
  declare(app, options, raw);
  command::ProgramOptions program(app);
  if (const Status parsed = program.parse(argc, argv, exit_code); !parsed)
    return tl::unexpected(parsed.error());
  exit_code = 2;
  if (const Status set = take(app, raw, options); !set) return tl::unexpected(program.located(set.error()));
  exit_code = 0;
  return options;
}

}  // namespace liloc

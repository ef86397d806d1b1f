#include "proto-tests/replay/options.hpp"

#include <cmath>

#include "client/engine/engine.hpp"
#include "common/learned/describer.hpp"
#include "server/answers/store.hpp"
#include "server/localization/localizer.hpp"

namespace liloc::replay {
namespace {

Status in_range(std::string_view option, double value, double low, double high) {
  if (std::isfinite(value) && value >= low && value <= high) return {};
  return fail("--{}: {} is out of range; give {} to {}", option, value, low, high);
}

}  // namespace

Result<ReplayOptions> ReplayOptions::validated() const {
  for (const Status& status :
       {in_range("interval-ms", interval_ms, 50, 60000), in_range("voxel", voxel_m, 0.01, 0.5),
        in_range("searching-interval-ms", searching_interval_ms, 0, 60000),
        in_range("sampling", sampling, 0.01, 1), in_range("threads", threads, 1, 64),
        in_range("risk", risk, 1e-6, 0.1)})
    if (!status) return tl::unexpected(status.error());
  if (const auto known = method_from(method); !known) return tl::unexpected(known.error());
  LocalizerOptions localizer;
  localizer.method = *method_from(method);
  if (!verify.empty()) {
    const auto known = verify_from(verify);
    if (!known) return tl::unexpected(known.error());
    localizer.verify = *known;
  }
  if (const auto known = icp_from(icp); !icp.empty() && !known) return tl::unexpected(known.error());
  if (const auto works = localizer.validated(); !works) return tl::unexpected(works.error());
  if (const auto known = local_method_from(local); !known) return tl::unexpected(known.error());
  if (!codec_from(codec)) return fail("--codec: '{}' is unknown; use draco, voxel or octree", codec);
  if (const auto describer = learned::describer_from(features, weights, threads); !describer)
    return tl::unexpected(describer.error());
  if (features == "learned" && !save_answers.empty())
    return fail(
        "--save-answers: answers are kept without the network, so that none could be given again; leave "
        "it out, or use --features fpfh");
  if (!save_answers.empty()) {
    const auto store = answers::store_options_from(save_answers);
    if (!store) return fail("--{}", store.error().message);
    if (store->which == answers::Which::wrong && !lockstep)
      return fail(
          "--save-answers: the server cannot know which answers are wrong; add --lockstep, or give DIR:all");
  }
  if (lockstep && clock_ahead_ms != 0)
    return fail("--clock-ahead-ms: does nothing with --lockstep; leave one out");
  if (out.empty()) return fail("--out: missing; name the folder for the results");
  return *this;
}

}  // namespace liloc::replay

#pragma once
#include <functional>
#include <memory>

#include "server/global_cloud/snapshot.hpp"
#include "server/view/journal.hpp"
#include "server/view/log_tail.hpp"
#include "server/web/facts.hpp"

namespace liloc::view {

/// What the page is drawn from. Called by the page's thread, at most five times a second, and only while
/// someone looks.
struct Source {
  Site site = {};
  std::function<web::ServerFacts()> facts = {};
  std::function<std::shared_ptr<const Snapshot>()> moment =
      {};  ///< the newest one; null before the first frame
  std::shared_ptr<const Journal> journal = {};
  std::shared_ptr<const LogTail> log = {};  ///< may be null
};

}  // namespace liloc::view

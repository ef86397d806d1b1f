#pragma once
// Where an answer is not verified: what would help.
#include "common/protocol/spot.hpp"
#include "server/localization/following.hpp"
#include "server/localization/verification.hpp"

namespace liloc {

struct Advised {
  Advice advice = Advice::none;
  std::string text;  ///< for people
};

/// After a search, by what weighs most against the best place. `judgement`: of it, at the newest spot.
[[nodiscard]] Advised advice_for(const Evidence& evidence, const Judgement& judgement);
/// For a followed pose that is in doubt, while nobody has searched the room.
[[nodiscard]] Advised advice_for(const Followed& followed, const Judgement& judgement);

}  // namespace liloc

#pragma once
// Where an answer is not verified: what would help.
#include "common/protocol/spot.hpp"
#include "server/localization/verification.hpp"

namespace liloc {

struct Advised {
  Advice advice = Advice::none;
  std::string text;  ///< for people
};

/// By what weighs most against the best place. `judgement`: of it, at the newest spot.
[[nodiscard]] Advised advice_for(const Evidence& evidence, const Judgement& judgement);

}  // namespace liloc

#pragma once
// Which answers of a replay are kept for `liloc explain`: unlike the server it knows the truth.
#include <map>
#include <optional>
#include <string>

#include "proto-tests/replay/truth.hpp"
#include "server/answers/store.hpp"

namespace liloc::replay {

class SavedAnswers {
 public:
  /// `where`: DIR[:refused|wrong|all]; empty: none are kept. Errors: the folder cannot be made, the truth
  /// cannot be read.
  [[nodiscard]] Status open(const std::string& where, const Recording& recording);
  /// Writes it, if it is one of those.
  void take(const Answered& answered);
  /// Whether all could be written so far.
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  [[nodiscard]] bool wanted(const Answered& answered) const;

  std::optional<answers::AnswerStore> store_;
  std::map<std::string, Truth> truth_;  ///< by device; where wrong ones are asked for
  Status status_;
};

}  // namespace liloc::replay

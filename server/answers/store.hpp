#pragma once
// Saved answers in a folder, bounded in number and size.
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <thread>

#include "common/base/bounded_queue.hpp"
#include "server/localization/answered.hpp"

namespace liloc::answers {

/// Which answers are kept: those that are not verified; verified ones that the truth contradicts; or all.
enum class Which : std::uint8_t { refused, wrong, all };
[[nodiscard]] std::string_view name_of(Which which);

struct StoreOptions {
  std::filesystem::path folder;
  Which which = Which::refused;
  std::size_t most_files = 200;                           ///< some three minutes of one device
  std::uintmax_t most_bytes = std::uintmax_t{512} << 20;  ///< an answer takes 1 to 3 MB
};
/// "DIR" or "DIR:refused", "DIR:wrong", "DIR:all". Error: no folder is named.
[[nodiscard]] Result<StoreOptions> store_options_from(std::string_view text);

/// Writes DIR/<stamp>-<client>-<seq>.answer, and removes what was written first beyond the
/// bounds, earlier runs' included.
/// Not thread-safe.
class AnswerStore {
 public:
  /// Makes the folder. Error: it cannot be made, or is none.
  [[nodiscard]] static Result<AnswerStore> open(StoreOptions options);
  /// Error: the disk is full, or the folder is gone.
  [[nodiscard]] Status save(const Answered& answered) const;
  [[nodiscard]] const StoreOptions& options() const { return options_; }

 private:
  explicit AnswerStore(StoreOptions options) : options_(std::move(options)) {}
  void make_room() const;

  StoreOptions options_;
};

/// A store with a thread of its own, so that no device waits for the disk. Each answer holds a moment of the
/// room: it must end before the room does.
class AnswerKeeper {
 public:
  explicit AnswerKeeper(AnswerStore store);
  ~AnswerKeeper() { stop(); }
  AnswerKeeper(const AnswerKeeper&) = delete;
  AnswerKeeper& operator=(const AnswerKeeper&) = delete;

  /// Never blocks; any thread. When answers come faster than they are written the oldest that wait are left
  /// out.
  void keep(Answered answered);
  /// Writes what waits, then ends. Safe to call twice.
  void stop();

 private:
  void work(const std::stop_token& stop);

  const AnswerStore store_;
  BoundedQueue<Answered> waiting_{8};
  std::atomic<bool> told_ = false;
  std::jthread writer_;  // last: it uses all of the above
};

}  // namespace liloc::answers

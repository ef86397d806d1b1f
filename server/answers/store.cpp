#include "server/answers/store.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <vector>

#include "common/base/log.hpp"
#include "common/recording/files.hpp"
#include "server/answers/answer_file.hpp"

namespace liloc::answers {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kExtension = ".answer";

/// Stamps stand first and have equally many digits, so that a listing sorts by them.
std::string file_name(const SpotRequest& request) {
  return fmt::format("{:020}-{}-{}{}", request.match_stamp_ns(), request.client_id, request.seq, kExtension);
}

bool is_ours(const fs::path& path) {
  const std::string name = path.filename();
  return path.extension() == kExtension && name.size() > 20 && name[20] == '-' &&
         name.find_first_not_of("0123456789") == 20;
}

struct Kept {
  fs::path path;
  std::uintmax_t bytes = 0;
  fs::file_time_type written;
};

/// By when they were written: stamps are the devices', whose clocks may run ahead.
std::vector<Kept> newest_first(const fs::path& folder) {
  std::vector<Kept> kept;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (!is_ours(it->path())) continue;
    std::error_code gone, unknown;
    const auto bytes = fs::file_size(it->path(), gone);
    const auto written = fs::last_write_time(it->path(), unknown);
    if (!gone && !unknown) kept.push_back({it->path(), bytes, written});
  }
  std::ranges::sort(kept, std::ranges::greater{},
                    [](const Kept& k) { return std::pair(k.written, k.path.filename().string()); });
  return kept;
}

}  // namespace

std::string_view name_of(Which which) {
  return which == Which::all ? "all" : which == Which::wrong ? "wrong" : "refused";
}

Result<StoreOptions> store_options_from(std::string_view text) {
  StoreOptions options;
  for (const Which which : {Which::refused, Which::wrong, Which::all}) {
    const std::string suffix = ":" + std::string(name_of(which));
    if (!text.ends_with(suffix)) continue;
    options.which = which;
    text.remove_suffix(suffix.size());
    break;
  }
  if (text.empty()) return fail("save-answers: no folder is named; give DIR, DIR:refused or DIR:all");
  options.folder = text;
  return options;
}

Result<AnswerStore> AnswerStore::open(StoreOptions options) {
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (error || !fs::is_directory(options.folder))
    return fail("save-answers: {}: is no folder and cannot be made one ({}); name another",
                options.folder.string(), error ? error.message() : "a file stands there");
  return AnswerStore(std::move(options));
}

Status AnswerStore::save(const Answered& answered) const {
  const Status written = write_file(options_.folder / file_name(answered.request), to_bytes(answered));
  make_room();
  return written;
}

void AnswerStore::make_room() const {
  std::uintmax_t bytes = 0;
  std::size_t files = 0;
  for (const Kept& kept : newest_first(options_.folder)) {
    bytes += kept.bytes;
    if (++files <= options_.most_files && bytes <= options_.most_bytes) continue;
    std::error_code gone;
    fs::remove(kept.path, gone);
  }
}

AnswerKeeper::AnswerKeeper(AnswerStore store)
    : store_(std::move(store)), writer_([this](const std::stop_token& stop) { work(stop); }) {}

void AnswerKeeper::keep(Answered answered) {
  const Which which = store_.options().which;
  if (which == Which::wrong || (which == Which::refused && answered.reply.verified())) return;
  if (waiting_.push(std::move(answered)) && !told_.exchange(true))
    log::warning("answers come faster than they are saved; some are left out");
}

void AnswerKeeper::work(const std::stop_token& stop) {
  bool told = false;
  while (const auto answered = waiting_.pop(stop)) {
    Status saved;
    try {
      saved = store_.save(*answered);
    } catch (const std::exception& trouble) {  // out of memory: the next one may fit
      saved = fail("an answer was not saved: {}", trouble.what());
    }
    if (!saved && !told) log::warning("{}", saved.error().message);
    told = !saved;
  }
}

void AnswerKeeper::stop() {
  writer_.request_stop();
  if (writer_.joinable()) writer_.join();
}

}  // namespace liloc::answers

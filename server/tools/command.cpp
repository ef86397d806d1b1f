#include "server/tools/command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "common/command/text.hpp"

namespace liloc::toolbox {

int complain(const Error& error, ExitCode code) {
  fmt::print(stderr, "liloc: {}\n", command::one_line(error.message));
  return code;
}

ProgressBar::ProgressBar(std::string_view label) : label_(label), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
}

void ProgressBar::show(double share) {
  constexpr double kPatience_ms = 2000, kRedraw_ms = 100;  // what is done sooner shows no bar; by hand
  constexpr int kWidth = 40;                               // columns; by hand
  const double now_ms = watch_.elapsed_ms();
  if (!terminal_ || now_ms < kPatience_ms || now_ms < drawn_ms_ + kRedraw_ms) return;
  drawn_ms_ = now_ms;
  drawn_ = true;
  share = std::clamp(share, 0.0, 1.0);
  const int filled = static_cast<int>(share * kWidth);
  const double left_s = share > 0.01 ? now_ms / 1e3 * (1 - share) / share : 0;
  fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3.0f} %, {:.0f} s left\x1b[K", label_, "", filled, "",
             kWidth - filled, 100 * share, left_s);
  std::fflush(stderr);
}

}  // namespace liloc::toolbox

#include "examples/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

namespace rayengine::cli {
namespace {

constexpr int bar_width = 40;
constexpr auto interval = std::chrono::milliseconds(100);

}  // namespace

Progress::Progress(std::string label, bool wanted)
    : label_(std::move(label)), enabled_(wanted && isatty(STDERR_FILENO)) {}

Progress::~Progress() {
  if (drawn_) std::cerr << "\r\033[K" << std::flush;
}

void Progress::update(double share) {
  if (!enabled_) return;
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (share < share_ || now < next_) return;
  share_ = std::min(share, 1.0);
  next_ = now + interval;
  draw(share_, std::chrono::duration<double>(now - start_).count());
}

void Progress::draw(double share, double seconds) {
  const int full = static_cast<int>(share * bar_width);
  const std::string left = share > 0 ? fmt::format(", {:.0f} s left", seconds * (1 - share) / share) : "";
  std::cerr << fmt::format("\r\033[K{} [{:=<{}}{:{}}] {:3.0f} %{}", label_, "", full, "", bar_width - full, 100 * share,
                           left)
            << std::flush;
  drawn_ = true;
}

}  // namespace rayengine::cli

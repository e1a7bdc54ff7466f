#include "app/cli/output/console.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <unistd.h>

namespace patina::cli {

namespace {

// A signal handler can reach nothing but a global; Console keeps these to itself.
std::atomic<Progress*> interrupted_progress{nullptr};
std::atomic<bool> interrupted{false};

extern "C" void onInterrupt(int) {
  interrupted = true;
  if (Progress* progress = interrupted_progress.load()) progress->cancel();
}

extern "C" void catchInterrupt() {
  struct sigaction action = {};
  action.sa_handler = onInterrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
}

// Before the constructors of all libraries, which take longer than some commands: a shell starts
// what is in the background with SIGINT ignored, and until it is caught it would be lost.
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_all)() = catchInterrupt;

} // namespace

Console::Console()
    : stderr_is_terminal_(isatty(STDERR_FILENO) == 1),
      progress_([this](double fraction, std::string_view what) { drawBar(fraction, what); }) {
  interrupted_progress = &progress_;
  if (interrupted) progress_.cancel();
}

Console::~Console() {
  clearBar();
  std::signal(SIGINT, SIG_DFL);
  interrupted_progress = nullptr;
}

void Console::endOnInterrupt() {
  progress_.throwIfCancelled();
  std::signal(SIGINT, SIG_DFL);
}

void Console::warn(const std::string& line) {
  clearBar();
  std::fprintf(stderr, "patina: warning: %s\n", line.c_str());
}

void Console::report(const Report& report, const std::string& below) {
  print(json ? report.json().dump() + "\n" : report.text() + below);
}

void Console::print(const std::string& text) {
  clearBar();
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void Console::say(const std::string& line) {
  if (json) return;
  clearBar();
  std::fprintf(stderr, "%s\n", line.c_str());
}

void Console::clearBar() {
  if (!bar_drawn_) return;
  std::fputs("\r\033[K", stderr);
  bar_drawn_ = false;
}

void Console::drawBar(double fraction, std::string_view what) {
  if (!stderr_is_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (bar_drawn_ && now - last_draw_ < std::chrono::milliseconds(50)) return;
  last_draw_ = now;
  bar_drawn_ = true;
  constexpr int kWidth = 30;
  const int done = static_cast<int>(kWidth * std::clamp(fraction, 0.0, 1.0));
  const std::string bar = std::string(static_cast<std::size_t>(done), '#') +
                          std::string(static_cast<std::size_t>(kWidth - done), '.');
  std::fprintf(stderr, "\r[%s] %3.0f %% %.*s\033[K", bar.c_str(), 100 * fraction,
               static_cast<int>(what.size()), what.data());
}

} // namespace patina::cli

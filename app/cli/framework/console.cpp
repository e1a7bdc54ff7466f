#include "app/cli/framework/console.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <new>
#include <poll.h>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>

#include "app/cli/framework/command.h"
#include "core/error.h"
#include "core/partial_output.h"
#include "core/version.h"

namespace patina::cli {

namespace {

// A signal handler can only use globals; they are private to Console.
std::atomic<Progress*> interrupted_progress{nullptr};
std::atomic<bool> interrupted{false};
std::atomic<int> wakes{-1};      // eventfd that wakes the watchdog thread
std::atomic<bool> ending{false}; // the last line is being printed

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr std::uint64_t kInterrupt = 1, kEnd = 1ULL << 32; // values added to the eventfd

void wake(std::uint64_t what) {
  const int descriptor = wakes.load();
  if (descriptor < 0) return;
  const ssize_t unused = ::write(descriptor, &what, sizeof what);
  (void)unused;
}

extern "C" void onInterrupt(int number) {
  const int code = errno;
  // A shell forwards SIGHUP after the kernel sent it; only a second Ctrl-C forces the exit.
  if (interrupted.exchange(true) && number != SIGINT) return;
  if (Progress* progress = interrupted_progress.load()) progress->cancel();
  wake(kInterrupt);
  errno = code;
}

extern "C" void catchInterrupt() {
  struct sigaction action = {};
  action.sa_handler = onInterrupt;
  action.sa_flags = SA_RESTART;
  for (const int number : kSignals) {
    struct sigaction before = {};
    sigaction(number, nullptr, &before);
    // nohup ignores SIGHUP, which stays ignored; shells ignore SIGINT for background jobs.
    if (number != SIGINT && before.sa_handler == SIG_IGN) continue;
    sigaction(number, &action, nullptr);
  }
}

void letSignalsEnd() {
  struct sigaction now = {};
  for (const int number : kSignals)
    if (sigaction(number, nullptr, &now) == 0 && now.sa_handler == onInterrupt)
      std::signal(number, SIG_DFL);
}

// Runs before the constructors of all libraries, which take longer than some commands: a shell
// starts background jobs with SIGINT ignored, and a signal before the handler would be lost.
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_all)() = catchInterrupt;

// Replaces control characters from files and their names, which could move the cursor or end the
// line.
std::string onOneLine(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
    if (text[i] == '\n' || text[i] == '\t')
      text[i] = ' ';
    else if (byte < 0x20 || byte == 0x7F)
      text[i] = '?';
    else if (byte == 0xC2 && next >= 0x80 && next < 0xA0) // the same in UTF-8
      text[i] = text[i + 1] = '?';
  }
  return text;
}

// Returns true if the Console ended within the time (-1: any) and before the next interrupt.
bool endsWithin(int descriptor, int milliseconds) {
  pollfd wait{descriptor, POLLIN, 0};
  while (::poll(&wait, 1, milliseconds) < 0 && errno == EINTR) {
  }
  std::uint64_t sum = 0;
  return (wait.revents & POLLIN) && ::read(descriptor, &sum, sizeof sum) == sizeof sum &&
         sum >= kEnd;
}

} // namespace

Console::Console()
    : stderr_is_terminal_(isatty(STDERR_FILENO) == 1),
      progress_([this](double fraction, std::string_view what) { drawBar(fraction, what); }) {
  interrupted_progress = &progress_;
  wakes = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  watchdog_ = std::thread([this] { forceExit(); });
  if (!interrupted) return;
  progress_.cancel();
  wake(kInterrupt);
}

Console::~Console() {
  wake(kEnd);
  watchdog_.join();
  ::close(wakes.exchange(-1));
  clearBar();
  letSignalsEnd();
  interrupted_progress = nullptr;
}

// Ends the process if a long library call, a blocked pipe or freeing memory does not check for
// cancellation.
void Console::forceExit() {
  const int descriptor = wakes.load();
  if (endsWithin(descriptor, -1) || endsWithin(descriptor, static_cast<int>(kTimeout.count())))
    return;
  if (ending.exchange(true) && endsWithin(descriptor, static_cast<int>(kTimeout.count()))) return;
  if (hasCompleteOutput() && endsWithin(descriptor, static_cast<int>(kTimeout.count()))) return;
  if (hasCompleteOutput() && reported_ >= 0) { // only memory remains to be freed
    std::fflush(stdout);
    _exit(reported_);
  }
  committing_.lock();
  if (!committed_) removeUnfinished();
  const std::string_view line =
      committed_ ? "patina: warning: the change was made before Ctrl-C\n" : "patina: cancelled\n";
  const ssize_t unused = ::write(STDERR_FILENO, line.data(), line.size());
  (void)unused;
  _exit(committed_ ? kDone : kCancelledByUser);
}

void Console::commit(const std::function<void()>& act) {
  const std::lock_guard hold(committing_);
  progress_.throwIfCancelled();
  act();
  committed_ = true;
}

void Console::endOnInterrupt() {
  progress_.throwIfCancelled();
  letSignalsEnd();
}

int Console::fail(const std::exception& error) {
  while (ending.exchange(true)) pause();
  clearBar();
  const auto* file = dynamic_cast<const FileError*>(&error);
  const bool cancelled = dynamic_cast<const Cancelled*>(&error);
  const int code = cancelled ? kCancelledByUser : kBadInput;
  std::string message = error.what();
  if (dynamic_cast<const std::bad_alloc*>(&error)) message = "not enough memory";
  if (dynamic_cast<const std::system_error*>(&error))
    message = "the system refused what is needed: " + message;
  if (committed_) {
    warn(message + "; the change was made before that");
    return kDone;
  }
  if (json) {
    Json object = Json::object();
    object.set("message", message).set("exit", code);
    if (file) object.set("file", file->path());
    if (file && file->line() > 0) object.set("line", file->line());
    std::fputs((Json::object().set("error", std::move(object)).dump() + "\n").c_str(), reports());
  }
  std::fprintf(stderr, "patina: %s\n", onOneLine(message).c_str());
  return code;
}

void Console::markCommitted() {
  const std::lock_guard hold(committing_);
  committed_ = true;
}

int Console::finish(int code) {
  if (code == kDone || code == kNotSolved)
    for (const std::string& line : takeOutputWarnings()) warn(line);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  std::fprintf(stderr, "patina: %sstandard output cannot be written%s\n",
               committed_ ? "warning: " : "",
               committed_ ? "; the change was made before that" : "");
  return committed_ ? code : kBadInput;
}

void Console::warn(const std::string& line) {
  if (line.empty()) return;
  clearBar();
  std::fprintf(stderr, "patina: warning: %s\n", onOneLine(line).c_str());
}

void Console::warnOfNoEffect(std::initializer_list<const char*> options, const std::string& where) {
  for (const char* option : options)
    if (given.contains(option)) warn(std::string(option) + " has no effect " + where);
}

Json Console::published(const Report& report) const {
  Json object = report.json();
  return object.set("program", programDescription()).set("inputs", inputs);
}

int Console::report(const Report& report, ExitCode code, const std::string& below) {
  print(json ? published(report).dump() + "\n" : report.text() + below);
  reported_ = code;
  return code;
}

void Console::print(const std::string& text) {
  clearBar();
  std::fwrite(text.data(), 1, text.size(), reports());
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

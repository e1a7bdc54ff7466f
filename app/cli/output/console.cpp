#include "app/cli/output/console.h"

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

#include "app/cli/commands/command.h"
#include "core/error.h"
#include "core/unfinished.h"
#include "core/version.h"

namespace patina::cli {

namespace {

// A signal handler can reach nothing but a global; Console keeps these to itself.
std::atomic<Progress*> interrupted_progress{nullptr};
std::atomic<bool> interrupted{false};
std::atomic<int> wakes{-1};      // the descriptor that wakes the impatient thread
std::atomic<bool> ending{false}; // somebody says the last line already

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr std::uint64_t kInterrupt = 1, kEnd = 1ULL << 32; // what is added to it

void wake(std::uint64_t what) {
  const int descriptor = wakes.load();
  if (descriptor < 0) return;
  const ssize_t unused = ::write(descriptor, &what, sizeof what);
  (void)unused;
}

extern "C" void onInterrupt(int number) {
  const int code = errno;
  // A shell sends SIGHUP on after the kernel did: only a second Ctrl-C is impatience.
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
    // As nohup asks for it; SIGINT is ignored by what a shell puts in the background.
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

// Before the constructors of all libraries, which take longer than some commands: a shell starts
// what is in the background with SIGINT ignored, and until it is caught it would be lost.
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_all)() = catchInterrupt;

// What files and their names bring along must not move a terminal's cursor, nor end the line.
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

// Whether the Console ended within the time (-1: any) and before the next interrupt.
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
  impatient_ = std::thread([this] { endWhatDoesNot(); });
  if (!interrupted) return;
  progress_.cancel();
  wake(kInterrupt);
}

Console::~Console() {
  wake(kEnd);
  impatient_.join();
  ::close(wakes.exchange(-1));
  clearBar();
  letSignalsEnd();
  interrupted_progress = nullptr;
}

// A long call into a library, a wait for a pipe or a gigabyte that is freed asks nobody whether it
// was cancelled.
void Console::endWhatDoesNot() {
  const int descriptor = wakes.load();
  if (endsWithin(descriptor, -1) || endsWithin(descriptor, static_cast<int>(kPatience.count())))
    return;
  if (ending.exchange(true) && endsWithin(descriptor, static_cast<int>(kPatience.count()))) return;
  if (anyFinished() && endsWithin(descriptor, static_cast<int>(kPatience.count()))) return;
  if (anyFinished() && reported_ >= 0) { // nothing is left but to give memory back
    std::fflush(stdout);
    _exit(reported_);
  }
  removeUnfinished();
  static constexpr std::string_view kLine = "patina: cancelled\n";
  const ssize_t unused = ::write(STDERR_FILENO, kLine.data(), kLine.size());
  (void)unused;
  _exit(kCancelledByUser);
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

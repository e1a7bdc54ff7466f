// Output of a command: reports on stdout, warnings and the progress bar on stderr. Ctrl-C cancels.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <functional>
#include <initializer_list>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <thread>

#include "app/cli/framework/report.h"
#include "core/progress.h"

namespace patina::cli {

enum ExitCode { kDone = 0, kNotSolved = 1, kBadInput = 2, kCancelledByUser = 130 };

class Console {
 public:
  // Handles SIGINT, SIGTERM and SIGHUP until destroyed; the handlers are set at the start of the
  // process. One per process.
  Console();
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  bool json = false;
  bool data_on_stdout = false; // an output is named "-", so reports go to stderr

  // The first Ctrl-C requests cancellation. If the command has not ended after kTimeout, the
  // process exits with code 130 and removes partial outputs; if an output is already complete, it
  // waits once more. A second Ctrl-C exits at once.
  static constexpr std::chrono::milliseconds kTimeout{200};
  Progress& progress() { return progress_; }
  // Runs the one act that completes the command's change, such as a record of a journal. The change
  // has then happened: no error, interrupt or closed stdout gives another exit code any more.
  // Throws Cancelled before it if Ctrl-C came.
  void commit(const std::function<void()>& act);
  void markCommitted(); // the same after an act that Ctrl-C may break off, such as writing a folder
  // Name that the caller gives with --intent; "": none.
  std::string intent;
  // Lets Ctrl-C end the process from now on, for work that touches no file and cannot be polled.
  void endOnInterrupt();
  void warn(const std::string& line); // "": no warning
  // Long names of the options given.
  std::set<std::string> given;
  // Warns for each of these options that was given: "--load has no effect without
  // --emulated-falcon".
  void warnOfNoEffect(std::initializer_list<const char*> options, const std::string& where);
  // Input files for published(): describeInputs().
  Json inputs = Json::array();
  // The report with `program` and `inputs` (commonKeys), as --json prints it.
  Json published(const Report& report) const;
  // Prints the object with --json, otherwise the rows and `below`. Must be a command's last output:
  // returns the exit code, which stays even if Ctrl-C comes while memory is freed.
  int report(const Report& report, ExitCode code = kDone, const std::string& below = "");
  void print(const std::string& text); // on stdout
  // Prints one line on stderr and, with --json, an object on stdout. Returns the exit code.
  int fail(const std::exception& error);
  // Prints warnings of complete outputs and flushes stdout: a full disk behind it must not look
  // like success. Call last; returns the exit code.
  int finish(int code);
  // Prints a line for waiting users that is not part of a report. Nothing with --json.
  void say(const std::string& line);
  void clearBar();

 private:
  void drawBar(double fraction, std::string_view what);
  void forceExit();
  std::FILE* reports() const { return data_on_stdout ? stderr : stdout; }

  bool stderr_is_terminal_;
  bool bar_drawn_ = false;
  std::atomic<int> reported_{-1}; // exit code after the report, else -1
  std::mutex committing_;         // held during commit()'s act
  bool committed_ = false;
  std::chrono::steady_clock::time_point last_draw_;
  Progress progress_;
  std::thread watchdog_;
};

} // namespace patina::cli

// Where a command speaks: reports on stdout, warnings and the progress bar on stderr, Ctrl-C as a
// cancel.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <thread>

#include "app/cli/output/report.h"
#include "core/progress.h"

namespace patina::cli {

enum ExitCode { kDone = 0, kNotSolved = 1, kBadInput = 2, kCancelledByUser = 130 };

class Console {
 public:
  // SIGINT, SIGTERM and SIGHUP, which are caught from the start of the process, are its until
  // destroyed. One a process.
  Console();
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  bool json = false;
  bool data_on_stdout = false; // of an output named "-": reports go to stderr then

  // Cancelled by the first Ctrl-C. What has not ended kPatience after it is ended (exit 130): files
  // and folders that are being made are removed, what stood on disk stays. Where an output is whole
  // already it gets as long again to end as if nothing had come. A second one does not wait that
  // long.
  static constexpr std::chrono::milliseconds kPatience{200};
  Progress& progress() { return progress_; }
  // From here on Ctrl-C ends the process: for work that touches no file and cannot be polled.
  void endOnInterrupt();
  void warn(const std::string& line); // an empty line is no warning
  // The options that this run was given, by their long names.
  std::set<std::string> given;
  // Of these options, each that was given: "--load has no effect without --wire".
  void warnOfNoEffect(std::initializer_list<const char*> options, const std::string& where);
  // The list of the input files for published(): describeInputs().
  Json inputs = Json::array();
  // The report's object with `program` and `inputs` (commonKeys), as --json prints it.
  Json published(const Report& report) const;
  // The object with --json, else the rows, and below them what else is for people. The last that a
  // command says: returns the code, with which it ends even if Ctrl-C comes while it frees memory.
  int report(const Report& report, ExitCode code = kDone, const std::string& below = "");
  void print(const std::string& text); // on stdout
  // One line on stderr and, with --json, an object on stdout. Returns the exit code.
  int fail(const std::exception& error);
  // For people who wait: no line of it is part of a report. Nothing with --json.
  void say(const std::string& line);
  // Removes the progress bar, if one is drawn.
  void clearBar();

 private:
  void drawBar(double fraction, std::string_view what);
  void endWhatDoesNot();
  std::FILE* reports() const { return data_on_stdout ? stderr : stdout; }

  bool stderr_is_terminal_;
  bool bar_drawn_ = false;
  std::atomic<int> reported_{-1}; // the code, once all is said
  std::chrono::steady_clock::time_point last_draw_;
  Progress progress_;
  std::thread impatient_;
};

} // namespace patina::cli

// Ticks of the servo, written to tables while they come.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "scene/tool_sample.h"
#include "session/store/autosave.h"
#include "session/store/growing_file.h"

namespace patina {

// Writes ticks to a table, as writeToolSamplesCsv() does, but as they come: memory is bounded, and
// a killed program loses the last second (GrowingFile). Its calls are for one thread.
class SampleLog {
 public:
  // dropped: ticks that the servo's buffer has lost so far. Throws FileError.
  SampleLog(const std::filesystem::path& path, std::size_t dropped);

  void pause() { on_ = false; }
  void resume() { on_ = true; }
  void add(const std::vector<ToolSample>& samples, std::size_t dropped);

  bool on() const { return on_; }
  std::size_t rows() const { return rows_; }
  std::size_t lost() const { return lost_; }            // missing ticks among the rows
  double seconds() const { return last_t_ - first_t_; } // from the first to the last row
  std::string problem() const { return file_.problem(); }
  void flush() { file_.flush(); } // all rows are on disk then; throws FileError

 private:
  GrowingFile file_;
  std::size_t rows_ = 0, lost_ = 0, dropped_;
  double first_t_ = 0, last_t_ = 0;
  bool on_ = true;
};

// A table in a folder of its own, until it is saved elsewhere or discarded. If the program ends
// before that, the next one offers it (recoverableScenes()).
class Recording {
 public:
  explicit Recording(std::filesystem::path root) : root_(std::move(root)) {}

  void start(std::size_t dropped); // discards the former one; throws FileError
  void clear() {
    log_.reset();
    place_.reset();
  }
  void keepForRecovery() { // at exit
    if (place_) place_->keepForRecovery();
  }
  void add(const std::vector<ToolSample>& samples, std::size_t dropped) {
    if (log_) log_->add(samples, dropped);
  }
  SampleLog* log() { return log_ ? &*log_ : nullptr; } // nullptr: nothing is recorded
  const SampleLog* log() const { return log_ ? &*log_ : nullptr; }
  bool on() const { return log_ && log_->on(); }
  // Copies the table to `path` and then clears. Throws FileError and keeps it.
  void save(const std::filesystem::path& path);

 private:
  std::filesystem::path root_;
  std::unique_ptr<Autosave> place_; // destroyed after its file
  std::optional<SampleLog> log_;
};

// Copies the table of a killed program from its folder, without a last row that is incomplete.
void saveRecovered(const Autosave& place, const std::filesystem::path& path);

// Checks before a recording that the file can be written. Throws FileError.
void requireWritable(const std::filesystem::path& path);

} // namespace patina

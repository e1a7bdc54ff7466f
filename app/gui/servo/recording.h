// Ticks kept until they are in a file: nothing else empties a recording but a word to drop it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "scene/tool_sample.h"

namespace patina {

class Recording {
 public:
  // Empties it. `dropped` counts what the servo's ring has lost so far.
  void start(std::size_t dropped);
  void pause() { on_ = false; }
  void resume() { on_ = true; }
  void clear();
  void add(const std::vector<ToolSample>& samples, std::size_t dropped);

  bool on() const { return on_; }
  const std::vector<ToolSample>& samples() const { return samples_; }
  double seconds() const { // from the first tick to the last
    return samples_.empty() ? 0 : samples_.back().t - samples_.front().t;
  }
  std::size_t lost() const { return lost_; } // ticks that are missing among the samples
  // Writes, and only then empties. Throws FileError; the samples are still there.
  void save(const std::filesystem::path& path);

 private:
  std::vector<ToolSample> samples_;
  std::size_t dropped_ = 0, lost_ = 0;
  bool on_ = false;
};

// Throws FileError where a file of this name could not be written: better now than after an hour.
void requireWritable(const std::filesystem::path& path);

} // namespace patina

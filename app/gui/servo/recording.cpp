#include "app/gui/servo/recording.h"

#include <cerrno>
#include <cstring>

#include <unistd.h>

#include "core/error.h"
#include "visualization/export/export_files.h"

namespace patina {

void Recording::start(std::size_t dropped) {
  clear();
  dropped_ = dropped;
  on_ = true;
}

void Recording::clear() {
  samples_ = {};
  lost_ = 0;
  on_ = false;
}

void Recording::add(const std::vector<ToolSample>& samples, std::size_t dropped) {
  if (on_) {
    samples_.insert(samples_.end(), samples.begin(), samples.end());
    lost_ += dropped - dropped_;
  }
  dropped_ = dropped;
}

void Recording::save(const std::filesystem::path& path) {
  writeToolSamplesCsv(path, samples_);
  clear();
}

void requireWritable(const std::filesystem::path& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code))
    throw FileError(path.string(), 0, "cannot be written: it is a folder");
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, code))
    throw FileError(path.string(), 0, "cannot be written: no folder " + folder.string());
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw FileError(path.string(), 0, std::string("cannot be written: ") + std::strerror(errno));
}

} // namespace patina

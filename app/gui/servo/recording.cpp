#include "app/gui/servo/recording.h"

#include <cerrno>
#include <cstring>

#include <unistd.h>

#include "core/error.h"
#include "core/file_kind.h"
#include "core/output_target.h"
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
  const OutputTarget target = outputTarget(path);
  if (target.is_stream) return;
  const std::filesystem::path end = target.path;
  std::error_code code;
  const std::filesystem::path folder = end.has_parent_path() ? end.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, code))
    throw FileError(path.string(), 0, "cannot be written: no folder " + folder.string());
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw FileError(path.string(), 0, std::string("cannot be written: ") + std::strerror(errno));
  requireSameKind(end, FileKind::table);
}

} // namespace patina

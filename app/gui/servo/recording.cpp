#include "app/gui/servo/recording.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <unistd.h>

#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"
#include "core/file_kind.h"
#include "visualization/export/export_files.h"

namespace patina {
namespace {

void copyRows(const std::filesystem::path& from, const std::filesystem::path& to) {
  const Descriptor source(openToRead(from));
  AtomicFile target(to);
  std::string rows(std::size_t{1} << 20, '\0'); // no row is longer
  std::size_t held = 0;
  while (const std::size_t more =
             readSome(source.get(), from.string(), rows.data() + held, rows.size() - held)) {
    held += more;
    const std::size_t whole = std::string_view(rows.data(), held).rfind('\n') + 1; // npos: 0
    target.append(std::string_view(rows.data(), whole));
    std::memmove(rows.data(), rows.data() + whole, held -= whole);
  }
  target.commit();
}

} // namespace

SampleLog::SampleLog(const std::filesystem::path& path, std::size_t dropped)
    : file_(path, csvHeader(toolSampleColumns())), dropped_(dropped) {}

void SampleLog::add(const std::vector<ToolSample>& samples, std::size_t dropped) {
  if (on_) lost_ += dropped - dropped_;
  dropped_ = dropped;
  if (!on_) return;
  for (const ToolSample& sample : samples) {
    if (!file_.append(csvRow(toolSampleRow(sample)))) {
      ++lost_;
      continue;
    }
    if (rows_++ == 0) first_t_ = sample.t;
    last_t_ = sample.t;
  }
}

void Recording::start(std::size_t dropped) {
  clear();
  auto place = std::make_unique<Autosave>(root_);
  log_.emplace(place->recording(), dropped);
  place_ = std::move(place);
}

void Recording::save(const std::filesystem::path& path) {
  log_->flush();
  copyRows(place_->recording(), path);
  clear();
}

void saveRecovered(const Autosave& place, const std::filesystem::path& path) {
  copyRows(place.recording(), path);
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

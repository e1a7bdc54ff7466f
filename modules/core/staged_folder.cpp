#include "core/staged_folder.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <string_view>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

#include "core/descriptor.h"
#include "core/disk_error.h"
#include "core/file.h"
#include "core/file_kind.h"
#include "core/numbers.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

struct Move {
  fs::path from, to;
};

std::string headOf(const fs::path& path) {
  const Descriptor file(openToRead(path));
  std::string head(1024, '\0');
  head.resize(readSome(file.get(), path.string(), head.data(), head.size()));
  return head;
}

void move(const Move& one) {
  if (::rename(one.from.c_str(), one.to.c_str()) != 0)
    throw DiskError(one.to.string(), "cannot be replaced: " + reason(errno));
}

void flush(const fs::path& folder) {
  const Descriptor directory(openRetrying(folder.c_str(), O_RDONLY | O_DIRECTORY));
  if (directory.get() < 0 || !syncRetrying(directory.get()))
    throw DiskError(folder.string(), "cannot be flushed to disk: " + reason(errno));
}

constexpr std::string_view kStaging = ".writing-"; // and the process's number, and one more

// What runs that were killed have left.
std::vector<fs::path> abandonedIn(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kStaging)) continue;
    const auto number = parseNumber(
        name.substr(kStaging.size(), name.find('-', kStaging.size()) - kStaging.size()));
    const bool gone =
        number && *number > 1 && ::kill(static_cast<pid_t>(*number), 0) != 0 && errno == ESRCH;
    if (gone) found.push_back(entry.path());
  }
  return found;
}

} // namespace

bool wasAbandoned(const fs::path& folder) {
  return fs::is_directory(folder) && !abandonedIn(folder).empty();
}

StagedFolder::StagedFolder(const fs::path& folder, const std::string& last)
    : folder_(folder), last_(last), fresh_(folder, last) {
  makeFolder(folder_);
  // Never one that is there: a run that was killed may have left files in it.
  for (int i = 0;; ++i) {
    staging_ =
        folder_ / (std::string(kStaging) + std::to_string(::getpid()) + "-" + std::to_string(i));
    if (::mkdir(staging_.c_str(), 0777) == 0) break;
    if (errno != EEXIST)
      throw DiskError(staging_.string(), "cannot be made a folder: " + reason(errno));
  }
  unfinished_ = Unfinished(staging_);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

void StagedFolder::commit() {
  const std::vector<fs::path> abandoned = abandonedIn(folder_);
  // What an earlier run has made, or had begun to put in place when it was killed.
  const bool ours = pathExists(folder_ / last_) || !abandoned.empty();
  std::vector<Move> moves;
  std::vector<fs::path> folders = {folder_};
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(staging_)) {
    const fs::path to = folder_ / file.path().lexically_relative(staging_);
    if (file.is_directory()) {
      folders.push_back(to);
      continue;
    }
    const OutputTarget target = outputTarget(to);
    if (target.is_stream)
      throw FileError(to.string(), 0,
                      "cannot be written: a folder's files are no pipes or devices");
    const FileKind kind = kindOf(headOf(file.path()), file.file_size());
    if (!ours || (kind != FileKind::other && kind != FileKind::empty))
      requireSameKind(target.path, kind);
    moves.push_back({file.path(), target.path});
  }
  for (const fs::path& folder : folders) makeFolder(folder);
  const fs::path index = staging_ / last_;
  std::partition(moves.begin(), moves.end(), [&](const Move& one) { return one.from != index; });
  const fs::path old = outputTarget(folder_ / last_).path; // where the new one comes, too
  unfinished_.finish([&] {
    if (::unlink(old.c_str()) == 0)
      flush(old.parent_path());
    else if (errno != ENOENT)
      throw DiskError(old.string(), "cannot be replaced: " + reason(errno));
    for (const Move& one : moves) move(one);
    for (const fs::path& folder : folders) flush(folder);
    if (old.parent_path() != folder_) flush(old.parent_path());
    return 0;
  });
  fresh_.keep();
  std::error_code ignored;
  for (const fs::path& left : abandoned) fs::remove_all(left, ignored);
}

} // namespace patina

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

constexpr std::string_view kStaging = ".writing-"; // followed by the process id and a counter

// Returns staging folders of processes that were killed.
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

bool isInterruptedWrite(const fs::path& folder) {
  return fs::is_directory(folder) && !abandonedIn(folder).empty();
}

StagedFolder::StagedFolder(const fs::path& folder, const std::string& index_file)
    : folder_(folder), index_file_(index_file), fresh_(folder, index_file) {
  makeFolder(folder_);
  // Always uses a new name: a killed process may have left files in an existing folder.
  for (int i = 0;; ++i) {
    staging_ =
        folder_ / (std::string(kStaging) + std::to_string(::getpid()) + "-" + std::to_string(i));
    if (::mkdir(staging_.c_str(), 0777) == 0) break;
    if (errno != EEXIST)
      throw DiskError(staging_.string(), "cannot be made a folder: " + reason(errno));
  }
  unfinished_ = PartialOutput(staging_);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

void StagedFolder::commit() {
  const std::vector<fs::path> abandoned = abandonedIn(folder_);
  // True if an earlier run wrote the folder, completely or not.
  const bool ours = pathExists(folder_ / index_file_) || !abandoned.empty();
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
  const fs::path index = staging_ / index_file_;
  std::partition(moves.begin(), moves.end(), [&](const Move& one) { return one.from != index; });
  const fs::path old =
      outputTarget(folder_ / index_file_).path; // link target that receives the new file
  std::string unflushed;
  unfinished_.finish([&] {
    if (::unlink(old.c_str()) == 0)
      flush(old.parent_path());
    else if (errno != ENOENT)
      throw DiskError(old.string(), "cannot be replaced: " + reason(errno));
    for (const Move& one : moves) move(one);
    // All files are in their places: nobody could take that back.
    if (old.parent_path() != folder_) folders.push_back(old.parent_path());
    try {
      for (const fs::path& folder : folders) flush(folder);
    } catch (const DiskError& error) {
      unflushed = std::string(error.what()) + ": a power loss soon may undo what was written";
    }
    return 0;
  });
  if (!unflushed.empty()) warnOfOutput(unflushed);
  fresh_.keep();
  std::error_code ignored;
  for (const fs::path& left : abandoned) fs::remove_all(left, ignored);
}

} // namespace patina

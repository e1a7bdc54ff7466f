#include "workspace/content_files.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <typeindex>

#include "core/error.h"
#include "core/file.h"
#include "core/sha256.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNameDigits = 16;
constexpr std::size_t kOldNameDigits = 8; // file names of version 1
constexpr std::string_view kHex = "0123456789abcdef";

// "ball-0123456789abcdef.ply" -> the digits; "" if the name has another form.
std::string_view hashIn(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  const std::size_t dash = name.rfind('-');
  if (dot == std::string_view::npos || dash == std::string_view::npos || dash == 0 || dash > dot)
    return {};
  const std::string_view hash = name.substr(dash + 1, dot - dash - 1);
  const bool whole = (hash.size() == kNameDigits || hash.size() == kOldNameDigits) &&
                     hash.find_first_not_of(kHex) == std::string_view::npos;
  return whole ? hash : std::string_view();
}

std::string pathFor(const std::string& prefix, const std::string& extension,
                    const std::string& digest) {
  return prefix + "-" + digest.substr(0, kNameDigits) + extension;
}

bool isJournalName(std::string_view name) {
  constexpr std::string_view kStart = "journal-", kEnd = ".jsonl";
  if (!name.starts_with(kStart) || !name.ends_with(kEnd)) return false;
  name = name.substr(kStart.size(), name.size() - kStart.size() - kEnd.size());
  return !name.empty() && name.find_first_not_of("0123456789") == std::string_view::npos;
}

struct ContentCache {
  std::mutex guard;
  std::map<std::weak_ptr<const void>, content_cache::Digest, std::owner_less<>> digests;
  std::map<std::pair<std::type_index, std::string>, std::weak_ptr<const void>> values;
  std::size_t limit = 64; // number of entries at which expired ones are removed

  void removeExpired() {
    if (digests.size() + values.size() < limit) return;
    std::erase_if(digests, [](const auto& item) { return item.first.expired(); });
    std::erase_if(values, [](const auto& item) { return item.second.expired(); });
    limit = 64 + 2 * (digests.size() + values.size());
  }
};

// A static is safe here: it only caches immutable values.
ContentCache& cache() {
  static ContentCache instance;
  return instance;
}

} // namespace

fs::path insidePath(const fs::path& folder, const std::string& relative) {
  std::error_code code;
  const fs::path root = fs::weakly_canonical(folder, code);
  const fs::path full = code ? fs::path() : fs::weakly_canonical(folder / relative, code);
  const auto [end, unused] = std::mismatch(root.begin(), root.end(), full.begin(), full.end());
  if (code || end != root.end()) {
    throw FileError((folder / kManifestName).string(), 0,
                    "path '" + relative + "' leaves the workspace's folder");
  }
  return full;
}

// Throws if a stored folder is a link that leads out of the workspace.
void refuseLinks(const fs::path& folder) {
  for (const char* part : kStoredFolders) insidePath(folder, part);
}

// Returns nullopt for a link, an unreadable file or one of another size; it is then written again.
std::optional<std::string> storedBytes(const fs::path& path, std::size_t size) {
  std::error_code code;
  if (fs::symlink_status(path, code).type() != fs::file_type::regular ||
      fs::file_size(path, code) != size || code)
    return std::nullopt;
  try {
    return readFile(path);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

std::optional<ContentFile> findStored(const fs::path& folder, const std::string& prefix,
                                      const std::string& extension,
                                      const content_cache::Digest& digest) {
  refuseLinks(folder);
  ContentFile file{pathFor(prefix, extension, digest.sha256), digest.sha256};
  const auto bytes = storedBytes(folder / file.path, digest.size);
  return bytes && sha256(*bytes) == digest.sha256 ? std::optional(std::move(file)) : std::nullopt;
}

ContentFile storeContent(const fs::path& folder, const std::string& prefix,
                         const std::string& extension, std::string_view bytes) {
  refuseLinks(folder);
  const std::string digest = sha256(bytes);
  ContentFile file{pathFor(prefix, extension, digest), digest};
  const fs::path path = folder / file.path;
  if (storedBytes(path, bytes.size()) == bytes) return file;
  makeFolder(path.parent_path());
  std::error_code code; // a link's target must not be overwritten
  if (fs::is_symlink(path, code)) fs::remove(path, code);
  writeFileDurably(path, bytes);
  return file;
}

std::string loadContent(const fs::path& folder, const ContentFile& file) {
  const fs::path path = insidePath(folder, file.path);
  std::string bytes = readFile(path);
  if (sha256(bytes) != file.sha256) {
    throw FileError(
        path.string(), 0,
        std::string(
            "is not the file that was saved (its SHA-256 differs from that in workspace.json)") +
            kAdvice);
  }
  return bytes;
}

std::string loadNamed(const fs::path& folder, const std::string& relative, ContentFile* found) {
  const fs::path path = insidePath(folder, relative);
  std::string bytes = readFile(path);
  const std::string digest = sha256(bytes);
  const std::string_view wanted = hashIn(relative);
  if (wanted.empty() || !digest.starts_with(wanted))
    throw FileError(
        path.string(), 0,
        std::string("is not the file that was saved (its SHA-256 differs from its name)") +
            kAdvice);
  if (found) *found = {relative, digest};
  return bytes;
}

bool isStoredName(const std::string& folder, const std::string& name) {
  if (folder.empty())
    return isJournalName(name) || isTemporaryFor(kManifestName, name) || name == kUnfinishedName;
  // Temporary files of interrupted saves: those of version 1, and ".NAME.123-0.tmp".
  if (name.starts_with(".saving-") || name.starts_with("..saving-")) return true;
  if (name.starts_with('.')) {
    const std::size_t end = name.rfind('.', name.size() - 5);
    if (end == 0 || end == std::string::npos) return false;
    const std::string inner = name.substr(1, end - 1);
    return isTemporaryFor(inner, name) && !hashIn(inner).empty();
  }
  return !hashIn(name).empty();
}

namespace content_cache {

std::optional<Digest> digest(const std::shared_ptr<const void>& value) {
  ContentCache& all = cache();
  const std::lock_guard hold(all.guard);
  const auto found = all.digests.find(value);
  return found == all.digests.end() ? std::nullopt : std::optional(found->second);
}

void remember(const std::shared_ptr<const void>& value, const std::type_info& type, Digest digest) {
  ContentCache& all = cache();
  const std::lock_guard hold(all.guard);
  all.removeExpired();
  all.values[{type, digest.sha256}] = value;
  all.digests[value] = std::move(digest);
}

std::shared_ptr<const void> find(const std::type_info& type, const std::string& sha256) {
  ContentCache& all = cache();
  const std::lock_guard hold(all.guard);
  const auto found = all.values.find({type, sha256});
  return found == all.values.end() ? nullptr : found->second.lock();
}

} // namespace content_cache
} // namespace patina

// Content-addressed files, named by their hash and never changed. Internal to the workspace.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <typeinfo>

#include "workspace/manifest.h"

namespace patina {

// Remedy for a damaged file; appended to a message.
inline constexpr const char* kAdvice =
    "; restore it from a backup, or recover the rest with patina scene --recover";

// Writes folder/prefix-HASH.extension to disk unless it is there unchanged. Throws FileError and
// writes nothing if a folder of the workspace is a link that leads out of it.
ContentFile storeContent(const std::filesystem::path& folder, const std::string& prefix,
                         const std::string& extension, std::string_view bytes);
// Throws FileError if the file is missing, lies outside the folder (also through a link) or does
// not have the stored hash.
std::string loadContent(const std::filesystem::path& folder, const ContentFile& file);
// The same for a file whose name contains its hash.
std::string loadNamed(const std::filesystem::path& folder, const std::string& path,
                      ContentFile* found = nullptr);

// Marker file of a first save in progress. A folder that still contains it was left by an
// interrupted save and may be overwritten.
inline constexpr const char* kUnfinishedName = ".unfinished";

// Returns an absolute path; throws FileError naming workspace.json.
std::filesystem::path insidePath(const std::filesystem::path& folder, const std::string& relative);

// Returns true for a file name that saving uses, also temporarily, and may remove. `folder` is the
// file's own, relative to the workspace.
bool isStoredName(const std::string& folder, const std::string& name);
inline constexpr const char* kStoredFolders[] = {"meshes", "paint", "scans", "states"};

// Cache of the hashes of immutable values while they live: saving skips the encoding of unchanged
// values, and loading reuses values in memory. Thread-safe.
namespace content_cache {
struct Digest {
  std::string sha256;
  std::size_t size = 0;
};
std::optional<Digest> digest(const std::shared_ptr<const void>& value);
void remember(const std::shared_ptr<const void>& value, const std::type_info& type, Digest digest);
std::shared_ptr<const void> find(const std::type_info& type, const std::string& sha256);
} // namespace content_cache

// Stores `value` and encodes it only if needed.
template <typename T, typename Encode>
ContentFile storeValue(const std::filesystem::path& folder, const std::string& prefix,
                       const std::string& extension, const std::shared_ptr<const T>& value,
                       const Encode& encode);

// Verifies the same bytes that it decodes, so that the file cannot change in between.
template <typename T, typename Decode>
std::shared_ptr<const T> loadValue(const std::filesystem::path& folder, const ContentFile& file,
                                   const Decode& decode) {
  const std::string bytes = loadContent(folder, file);
  if (const auto found = content_cache::find(typeid(T), file.sha256))
    return std::static_pointer_cast<const T>(found);
  auto value = std::make_shared<const T>(decode(bytes, (folder / file.path).string()));
  content_cache::remember(value, typeid(T), {file.sha256, bytes.size()});
  return value;
}

// Returns the file if it is there unchanged.
std::optional<ContentFile> findStored(const std::filesystem::path& folder,
                                      const std::string& prefix, const std::string& extension,
                                      const content_cache::Digest& digest);

template <typename T, typename Encode>
ContentFile storeValue(const std::filesystem::path& folder, const std::string& prefix,
                       const std::string& extension, const std::shared_ptr<const T>& value,
                       const Encode& encode) {
  if (const auto digest = content_cache::digest(value))
    if (const auto file = findStored(folder, prefix, extension, *digest)) return *file;
  const std::string bytes = encode(*value);
  const ContentFile file = storeContent(folder, prefix, extension, bytes);
  content_cache::remember(value, typeid(T), {file.sha256, bytes.size()});
  return file;
}

} // namespace patina

// Files that are named by what they hold, and so never change. Internal to the workspace.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <typeinfo>

#include "workspace/manifest.h"

namespace patina {

// What to do about a file that is not what was saved; follows a message.
inline constexpr const char* kAdvice =
    "; put it back from a copy, or keep what is whole with patina scene --recover";

// folder/prefix-HASH.extension, on disk when it returns; one that is there already, whole, is kept.
// FileError, and nothing written, where a folder of the workspace's is a link that leads out of it.
ContentFile storeContent(const std::filesystem::path& folder, const std::string& prefix,
                         const std::string& extension, std::string_view bytes);
// Throws FileError: missing, leaves the folder (through a link, too), not the bytes that were
// stored.
std::string loadContent(const std::filesystem::path& folder, const ContentFile& file);
// The same for a file whose name says its hash.
std::string loadNamed(const std::filesystem::path& folder, const std::string& path,
                      ContentFile* found = nullptr);

// Stands in a folder from before its first file until its workspace.json is there: what a killed
// saver leaves, in place of which another may save.
inline constexpr const char* kUnfinishedName = ".unfinished";

// Absolute; throws FileError naming workspace.json.
std::filesystem::path insidePath(const std::filesystem::path& folder, const std::string& relative);

// A name that saving gives, or a temporary one of it: what saving may remove. `folder` is the
// file's own, relative to the workspace.
bool isStoredName(const std::string& folder, const std::string& name);
inline constexpr const char* kStoredFolders[] = {"meshes", "paint", "scans", "states"};

// What immutable values hash to, for as long as they live: saving again need not encode what did
// not change, and loading finds what is in memory already. Any thread.
namespace known {
struct Digest {
  std::string sha256;
  std::size_t size = 0;
};
std::optional<Digest> digest(const std::shared_ptr<const void>& value);
void remember(const std::shared_ptr<const void>& value, const std::type_info& type, Digest digest);
std::shared_ptr<const void> find(const std::type_info& type, const std::string& sha256);
} // namespace known

// The file of `value`, encoded only where it must be.
template <typename T, typename Encode>
ContentFile storeValue(const std::filesystem::path& folder, const std::string& prefix,
                       const std::string& extension, const std::shared_ptr<const T>& value,
                       const Encode& encode);

// Verified from the same bytes that are decoded, so that the file cannot change in between.
template <typename T, typename Decode>
std::shared_ptr<const T> loadValue(const std::filesystem::path& folder, const ContentFile& file,
                                   const Decode& decode) {
  const std::string bytes = loadContent(folder, file);
  if (const auto found = known::find(typeid(T), file.sha256))
    return std::static_pointer_cast<const T>(found);
  auto value = std::make_shared<const T>(decode(bytes, (folder / file.path).string()));
  known::remember(value, typeid(T), {file.sha256, bytes.size()});
  return value;
}

// Whether the file is there, whole.
std::optional<ContentFile> findStored(const std::filesystem::path& folder,
                                      const std::string& prefix, const std::string& extension,
                                      const known::Digest& digest);

template <typename T, typename Encode>
ContentFile storeValue(const std::filesystem::path& folder, const std::string& prefix,
                       const std::string& extension, const std::shared_ptr<const T>& value,
                       const Encode& encode) {
  if (const auto digest = known::digest(value))
    if (const auto file = findStored(folder, prefix, extension, *digest)) return *file;
  const std::string bytes = encode(*value);
  const ContentFile file = storeContent(folder, prefix, extension, bytes);
  known::remember(value, typeid(T), {file.sha256, bytes.size()});
  return file;
}

} // namespace patina

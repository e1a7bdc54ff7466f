#include "workspace/workspace.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <set>
#include <unistd.h>

#include "core/error.h"
#include "core/file.h"
#include "geometry/mesh_io.h"
#include "workspace/manifest.h"
#include "workspace/sha256.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMeshFolder = "meshes";
constexpr std::string_view kTemporaryPrefix = ".saving-";

// `..` is refused in the manifest; a symbolic link may still lead out of the folder.
fs::path insidePath(const fs::path& folder, const std::string& relative) {
  const fs::path root = fs::weakly_canonical(folder);
  const fs::path full = fs::weakly_canonical(folder / relative);
  const auto [end, unused] = std::mismatch(root.begin(), root.end(), full.begin(), full.end());
  if (end != root.end()) {
    throw FileError((folder / kManifestName).string(), 0,
                    "path '" + relative + "' leaves the workspace's folder");
  }
  return full;
}

void syncFolder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool synced = fd >= 0 && (::fsync(fd) == 0 || errno == EINVAL);
  const int code = errno;
  if (fd >= 0) ::close(fd);
  if (!synced)
    throw FileError(folder.string(), 0, std::string("cannot be flushed: ") + std::strerror(code));
}

void makeFolder(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (!fs::is_directory(folder)) {
    throw FileError(folder.string(), 0,
                    "cannot be made a folder: " +
                        (code ? code.message() : std::string("a file stands there")));
  }
}

// The name holds the content's hash: a new mesh never takes the place of one that the old
// workspace.json still names.
ManifestObject storeMesh(const SceneObject& object, const fs::path& folder) {
  const fs::path meshes = folder / kMeshFolder;
  const fs::path temporary = meshes / (std::string(kTemporaryPrefix) + std::to_string(::getpid()) +
                                       "-" + object.name + ".ply");
  writeMesh(temporary, *object.mesh);
  ManifestObject stored;
  stored.name = object.name;
  stored.world_from_object = object.world_from_object;
  stored.sha256 = sha256(readFile(temporary));
  stored.mesh =
      std::string(kMeshFolder) + "/" + object.name + "-" + stored.sha256.substr(0, 8) + ".ply";
  std::error_code code;
  fs::rename(temporary, folder / stored.mesh, code);
  if (code) throw FileError((folder / stored.mesh).string(), 0, code.message());
  return stored;
}

bool isStoredMeshName(const std::string& name) {
  if (name.starts_with(kTemporaryPrefix) || name.starts_with("." + std::string(kTemporaryPrefix)))
    return true;
  constexpr std::size_t kTail = sizeof("-01234567.ply") - 1;
  if (name.size() <= kTail || !name.ends_with(".ply") || name[name.size() - kTail] != '-')
    return false;
  return name.find_first_not_of("0123456789abcdef", name.size() - kTail + 1) == name.size() - 4;
}

// Only names that saving makes; a file that a person put there stays.
void removeUnused(const fs::path& meshes, const std::vector<ManifestObject>& objects) {
  std::set<std::string> used;
  for (const ManifestObject& object : objects) used.insert(fs::path(object.mesh).filename());
  std::error_code code;
  std::vector<fs::path> unused;
  for (fs::directory_iterator item(meshes, code), end; !code && item != end; item.increment(code)) {
    const std::string name = item->path().filename();
    if (isStoredMeshName(name) && !used.contains(name)) unused.push_back(item->path());
  }
  // What cannot be removed only takes room: the workspace is saved all the same.
  for (const fs::path& path : unused) fs::remove(path, code);
}

// Saving over a workspace that a newer program wrote would lose what this one cannot read.
void refuseNewer(const fs::path& folder) {
  const fs::path path = folder / kManifestName;
  if (!fs::exists(path)) return;
  Json json;
  try {
    json = parseJson(readFile(path), path.string());
  } catch (const FileError&) {
    return; // broken: saving repairs it
  }
  const Json* version = json.isObject() ? json.find("version") : nullptr;
  if (version && version->isNumber() && version->asNumber() > kWorkspaceVersion) {
    throw FileError(path.string(), 0,
                    "was written by a newer version of this program; save to another folder");
  }
}

} // namespace

Scene loadWorkspace(const fs::path& folder) {
  Manifest manifest = readManifest(folder);
  Scene scene = std::move(manifest.values);
  for (ManifestObject& object : manifest.objects) {
    const fs::path path = insidePath(folder, object.mesh);
    // Hashed and parsed from the same bytes, so that the file cannot change in between.
    const std::string bytes = readFile(path);
    if (sha256(bytes) != object.sha256) {
      throw FileError(path.string(), 0,
                      "is not the file that was saved (its SHA-256 differs from workspace.json)");
    }
    auto mesh = std::make_shared<const TriangleMesh>(parsePly(bytes, path.string()));
    scene.objects.push_back({std::move(object.name), std::move(mesh), object.world_from_object});
  }
  try {
    validate(scene);
  } catch (const Error& error) {
    throw FileError((folder / kManifestName).string(), 0, error.what());
  }
  return scene;
}

void saveWorkspace(const Scene& scene, const fs::path& folder) {
  validate(scene);
  makeFolder(folder);
  refuseNewer(folder);
  const fs::path meshes = folder / kMeshFolder;
  makeFolder(meshes);
  Manifest manifest;
  manifest.values = scene;
  for (const SceneObject& object : scene.objects)
    manifest.objects.push_back(storeMesh(object, folder));
  syncFolder(meshes);
  syncFolder(folder);
  // The one moment at which the old workspace becomes the new one.
  writeFileAtomically(folder / kManifestName, toJson(manifest).dump() + "\n");
  removeUnused(meshes, manifest.objects);
}

bool isWorkspace(const fs::path& path) {
  std::error_code code;
  return fs::is_regular_file(path / kManifestName, code);
}

} // namespace patina

#include "app/cli/input/input_files.h"

#include <algorithm>

#include "core/error.h"
#include "core/sha256.h"
#include "session/store/attach_scan.h"
#include "workspace/manifest.h"
#include "workspace/workspace.h"

namespace patina::cli {

namespace {

namespace fs = std::filesystem;

void addFile(const fs::path& path, Json& list) {
  std::error_code code;
  Json hash;
  try {
    if (fs::is_regular_file(path, code)) hash = sha256OfFile(path);
  } catch (const FileError&) { // the command reads it too and reports the error
  }
  list.push(Json::object().set("path", path.string()).set("sha256", std::move(hash)));
}

void addWorkspace(const fs::path& folder, Json& list) {
  addFile(folder / kManifestName, list);
  try {
    if (const auto journal = readManifest(folder).journal) addFile(folder / journal->file, list);
  } catch (const FileError&) { // a damaged workspace, which may be recovered
  }
}

void addFolder(const fs::path& folder, Json& list) {
  std::error_code code;
  for (const ScanFile& file : kScanFiles)
    if (const fs::path path = folder / file.name; fs::exists(path, code)) addFile(path, list);
  const bool scan = fs::is_directory(folder / "frames", code);
  const std::string digest = scan ? framesDigest(folder) : picturesDigest(folder);
  if (digest.empty()) return;
  const fs::path pictures = scan ? folder / "frames" : folder;
  list.push(Json::object().set("path", pictures.string()).set("digest", digest));
}

} // namespace

Json describeInputs(const std::vector<fs::path>& paths) {
  Json list = Json::array();
  for (const fs::path& path : paths) {
    std::error_code code;
    if (isWorkspace(path))
      addWorkspace(path, list);
    else if (fs::is_directory(path, code))
      addFolder(path, list);
    else if (path == "-" || fs::exists(path, code))
      addFile(path, list);
  }
  return list;
}

std::vector<fs::path> filesOfSource(const std::string& source) {
  if (source.starts_with("replay:")) return {source.substr(7)};
  for (const char* live : {"camera:", "stream:", "serial:", "usb:"})
    if (source.starts_with(live)) return {};
  return {source};
}

} // namespace patina::cli

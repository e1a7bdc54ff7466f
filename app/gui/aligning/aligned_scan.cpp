#include "app/gui/aligning/aligned_scan.h"

#include <algorithm>

#include "acquisition/files/registered_file.h"
#include "acquisition/files/scan_files.h"
#include "acquisition/registration/first_guess.h"
#include "core/error.h"
#include "geometry/io/pose_file.h"

namespace patina {
namespace {

bool samePlaces(const std::vector<PathSample>& a, const std::vector<PathSample>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const PathSample& one, const PathSample& other) {
                      return one.t == other.t && one.position == other.position;
                    });
}

} // namespace

AlignedPath alignedPathOf(const SceneScan& scan) {
  const std::string where = "scan '" + scan.name + "': ";
  AlignedPath aligned{parsePath(*scan.text("path.csv"), where + "path.csv"), {}};
  if (const std::string* pose = scan.text("registered.txt"))
    aligned.mesh_from_path = parsePose(*pose, where + "registered.txt");
  return aligned;
}

SceneScan alignedScan(const std::string& name, const Alignment& alignment) {
  SceneScan scan;
  scan.name = scanNameOf(name);
  const auto put = [&](const char* file, std::string text) {
    scan.files[file] = std::make_shared<const std::string>(std::move(text));
  };
  put("path.csv", pathText(alignment.path()));
  put("registered.csv", registeredText(alignment.path(), alignment.registration()));
  put("registered.txt", poseText(alignment.pose(), "mesh_from_scan"));
  return scan;
}

SceneScan withAlignment(const SceneScan* known, const SceneScan& aligned) {
  if (known == nullptr) return aligned;
  if (known->text("path.csv")) {
    const std::vector<PathSample> path = alignedPathOf(aligned).path,
                                  own = alignedPathOf(*known).path;
    // It may have been stored by this desk, or whole; only what is in contact is laid.
    if (!samePlaces(path, own) && !samePlaces(path, inContact(own)))
      throw Error("scan '" + known->name +
                  "' of the workspace has another path than the one that lies here: put that "
                  "scan into the workspace first, or take its own path from the list");
  }
  SceneScan scan = *known;
  for (const auto& [file, text] : aligned.files)
    if (file != "path.csv" || !known->text(file)) scan.files[file] = text;
  return scan;
}

} // namespace patina

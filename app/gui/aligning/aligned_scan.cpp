#include "app/gui/aligning/aligned_scan.h"

#include "acquisition/files/registered_file.h"
#include "acquisition/files/scan_files.h"
#include "geometry/io/pose_file.h"

namespace patina {

AlignedPath alignedPathOf(const SceneScan& scan) {
  const std::string where = "scan '" + scan.name + "': ";
  AlignedPath aligned{parsePath(*scan.text("path.csv"), where + "path.csv"), {}};
  if (const std::string* pose = scan.text("registered.txt"))
    aligned.mesh_from_path = parsePose(*pose, where + "registered.txt");
  return aligned;
}

SceneScan withAlignment(const Scene& scene, const std::string& name, const Alignment& alignment) {
  SceneScan scan;
  scan.name = scanNameOf(name);
  if (const SceneScan* known = findScan(scene, scan.name)) scan = *known;
  const auto put = [&](const char* file, std::string text) {
    scan.files[file] = std::make_shared<const std::string>(std::move(text));
  };
  if (!scan.text("path.csv")) put("path.csv", pathText(alignment.path()));
  put("registered.csv",
      registeredText(alignment.path(),
                     registeredAt(*alignment.target(), alignment.path(), alignment.pose())));
  put("registered.txt", poseText(alignment.pose(), "mesh_from_scan"));
  return scan;
}

} // namespace patina

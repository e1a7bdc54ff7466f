#include "app/gui/texturing/aligned_scan.h"

#include "app/gui/scanning/scan_path.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"

namespace patina {

AlignedScan makeAlignedScan(const OpenScan& scan, const AlignDesk& align, const Scene& scene) {
  if (scan.files() == nullptr || scan.path() == nullptr)
    throw Error("no scan is open: open its folder on the desk Scan");
  const ScanPath& path = *scan.path();
  if (!scan.files()->rig || path.poses.empty() || path.probe.empty())
    throw Error("the scan has no poses, no probe's stream or no rig.json: the height profile needs "
                "all three");
  if (path.filtered.whole.empty())
    throw Error("the scan's rig.json contains no accelerometers: the height profile needs them");
  if (scene.objects.size() != 1)
    throw Error(
        "the texture of a scan needs a scene with only the scanned object: remove the others");
  // The scan may have another name in the workspace.
  const QString stored = shownText(scan.files()->scan.name);
  if (!align.alignment().isReady() || (align.name() != scan.name() && align.name() != stored))
    throw Error("the scan's path is not aligned with the mesh: align it on the desk Align");
  AlignedScan aligned;
  aligned.name = scan.files()->scan.name;
  aligned.filtered = path.filtered;
  std::erase_if(aligned.filtered.path, [](const PathSample& sample) { return !sample.touching; });
  aligned.poses = path.poses;
  aligned.rig = *scan.files()->rig;
  const std::vector<PathSample>& path_on_mesh = align.alignment().path();
  Registration registration;
  if (const auto& found = align.alignment().found())
    registration = *found;
  else
    registration.inliers.assign(path_on_mesh.size(), true);
  registration.mesh_from_path =
      scene.objects[0].world_from_object.inverse() * align.alignment().pose();
  aligned.place = scanPlace(path_on_mesh, registration);
  return aligned;
}

} // namespace patina

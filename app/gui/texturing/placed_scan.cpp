#include "app/gui/texturing/placed_scan.h"

#include "core/error.h"

namespace patina {

PlacedScan placedScan(const OpenScan& scan, const AlignDesk& align, const Scene& scene) {
  if (scan.files() == nullptr || scan.path() == nullptr)
    throw Error("no scan is open: open its folder on the desk Scan");
  const ScanPath& path = *scan.path();
  if (!scan.files()->rig || path.poses.empty() || path.probe.empty())
    throw Error("the scan has no poses, no probe's stream or no rig.json: heights need all three");
  if (path.filtered.whole.empty())
    throw Error("the scan's rig.json names no accelerometers, from which heights are made");
  if (scene.objects.size() != 1)
    throw Error("a scan's texture needs a scene of one object, the one that was scanned");
  // A scan that was put into the workspace is aligned under the name that it has there.
  const QString stored = QString::fromStdString(scan.files()->scan.name);
  if (!align.alignment().isReady() || (align.name() != scan.name() && align.name() != stored))
    throw Error("the scan's path is not laid onto the mesh: do that on the desk Align");
  PlacedScan placed;
  placed.name = scan.files()->scan.name;
  placed.filtered = path.filtered;
  std::erase_if(placed.filtered.path, [](const PathSample& sample) { return !sample.touching; });
  placed.poses = path.poses;
  placed.rig = *scan.files()->rig;
  placed.path = align.alignment().path();
  if (const auto& found = align.alignment().found())
    placed.registration = *found;
  else
    placed.registration.counts.assign(placed.path.size(), true);
  placed.registration.mesh_from_path =
      scene.objects[0].world_from_object.inverse() * align.alignment().pose();
  return placed;
}

} // namespace patina

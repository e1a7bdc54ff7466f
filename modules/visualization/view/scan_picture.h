// The picture of a scan: the tip's path, the probe on it, the camera that saw it and the mesh that
// was scanned. No window and no Qt. UI thread only. All in one frame, the picture's.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include "geometry/mesh/triangle_mesh.h"
#include "visualization/layers/handle_layer.h"
#include "visualization/layers/path_layer.h"
#include "visualization/values/palette.h"
#include "visualization/view/view_options.h"

namespace patina {

// Where a camera stands and what it sees: its picture is as wide and high at a distance of 1.
struct DrawnCamera {
  Pose picture_from_camera = Pose::Identity(); // z forward, y down
  double wide = 1, high = 1;
};

// The probe: its frame, and its tip in that frame [m].
struct DrawnProbe {
  Pose picture_from_probe = Pose::Identity();
  Vec3 tip = Vec3::Zero();
};

class ScanPicture {
 public:
  ScanPicture();
  ~ScanPicture();
  ScanPicture(const ScanPicture&) = delete;
  ScanPicture& operator=(const ScanPicture&) = delete;

  // Adds its renderers (scene, and what must never be hidden by it) to a window.
  void attachTo(vtkRenderWindow& window);
  vtkRenderer& renderer();

  void setMesh(std::shared_ptr<const TriangleMesh> mesh); // nullptr: none
  // One a vertex of the mesh, in the unit and the colours of the path; not finite: none there.
  // Empty: the mesh has its own colour.
  void setMeshValues(const std::vector<float>& values);
  // Faces that lie on the mesh, in another colour, and others in a paler one; nullptr: none.
  void setHighlight(const std::shared_ptr<const TriangleMesh>& faces,
                    const std::shared_ptr<const TriangleMesh>& pale = nullptr);
  void setPath(const DrawnPath& path);
  void setMarks(const std::vector<DrawnMark>& marks);
  void setCamera(const std::optional<DrawnCamera>& camera);
  void setProbe(const std::optional<DrawnProbe>& probe);
  void setScale(bool on); // a bar of a round length, where there is something
  HandleLayer& handle();
  void setDirty(); // the handle has changed

  // Path and mesh in the picture, with `up` up, at an angle; the camera too where there is no mesh.
  void lookAtAll(const Vec3& up);
  void setGround(const palette::Ground& ground); // light, unless said
  void setView(ViewPreset view);                 // and fit
  void fit();                                    // path and mesh, from the present direction
  std::optional<double> timeAt(double x, double y, double reach) const; // see PathLayer

  // Call before a render. True if something changed since the last call.
  bool prepare();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace patina

// Picture of a scan: the tip's path, the probe on it, the camera and the scanned mesh, in one
// common frame. No window and no Qt. UI thread only.
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
#include "visualization/values/view_options.h"

namespace patina {

// Pose and field of view of a camera: its image has this width and height at a distance of 1.
struct DrawnCamera {
  Pose picture_from_camera = Pose::Identity(); // z forward, y down
  double wide = 1, high = 1;
};

// Probe pose, and its tip in the probe frame [m].
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

  // Adds its renderers (the scene, and an overlay that nothing hides) to a window.
  void attachTo(vtkRenderWindow& window);
  vtkRenderer& renderer();

  void setMesh(std::shared_ptr<const TriangleMesh> mesh); // nullptr: none
  // One value per vertex of the mesh, in the unit and the colours of the path; not finite: no
  // value. Empty: the mesh has its own colour.
  void setMeshValues(const std::vector<float>& values);
  // Faces on the mesh in another colour, and others in a paler one; nullptr: none.
  void setHighlight(const std::shared_ptr<const TriangleMesh>& faces,
                    const std::shared_ptr<const TriangleMesh>& pale = nullptr);
  void setPath(const DrawnPath& path);
  void setMarks(const std::vector<DrawnMark>& marks);
  void setCamera(const std::optional<DrawnCamera>& camera);
  void setProbe(const std::optional<DrawnProbe>& probe);
  void setScale(bool on); // a bar of a round length, if the picture is not empty
  HandleLayer& handle();
  void setDirty(); // call after a change of the handle

  // Fits path and mesh at an angle, with `up` up; includes the camera if there is no mesh.
  void resetCamera(const Vec3& up);
  void setBackgroundStyle(const palette::BackgroundStyle& ground); // default: light
  void setView(ViewPreset view);                                   // resets the camera
  void fit(); // path and mesh, from the present direction
  std::optional<DrawnSample> sampleAt(double x, double y, double reach) const; // see PathLayer
  const std::string& pathTitle() const;         // title of the path's values
  std::optional<ValueRange> valueRange() const; // range of their colours; nullopt: no values

  // Call before a render. Returns true if something changed since the last call.
  bool prepare();

 private:
  struct Impl;
  std::unique_ptr<Impl> my_;
};

} // namespace patina

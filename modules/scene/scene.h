// The scene: all authored and recorded data as plain values. An absent feature is an absent value.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/types.h"
#include "field/sampling/field_sampler.h"
#include "field/store/field_grid.h"
#include "geometry/mesh/triangle_mesh.h"
#include "scene/color_scale.h"
#include "scene/device_model.h"
#include "scene/haptic_properties.h"
#include "scene/paint/object_paint.h"
#include "scene/paint/relief_settings.h"
#include "scene/pin.h"
#include "scene/scene_scan.h"
#include "scene/slice_position.h"

namespace patina {

struct SceneObject {
  std::string name;                         // unique in the scene; letters, digits, '-', '_'
  std::shared_ptr<const TriangleMesh> mesh; // [m], object frame
  Pose world_from_object = Pose::Identity();
  std::shared_ptr<const ObjectPaint> paint{}; // null before the first stroke
};

struct Scene {
  std::vector<SceneObject> objects;
  std::vector<SceneScan> scans; // without haptic effect
  FieldSpec field;
  // Several objects form one field by the minimum (K14): exact outside, and too shallow inside
  // overlaps (F9). true = inside distances are measured from the union's surface.
  bool redistance = false;
  Sampler sampler = Sampler::high;
  HapticProperties haptics;
  ReliefSettings relief;                             // for painted relief
  ForceForm material_form = ForceForm::conservative; // for painted stiffness (F6)
  int paint_size = 512;                              // texels a side of images created by painting
  std::string device = "mouse"; // name in the catalogue of devices; checked when it is opened
  std::optional<DeviceModel> device_model; // absent: unknown, so no stability limit
  std::optional<Stabilisers> stabilisers;  // absent: chosen from device_model (auto)
  std::vector<Pin> pins;                   // without haptic effect
  ColorScales colors;                      // colours of pictures
  Slices slices;                           // planes of pictures
};

// Returns true if the text is a valid name of an object or a scan.
bool isName(const std::string& name);

// Returns the values for unpainted points.
Material baseMaterial(const HapticProperties& haptics);
// Returns the largest |relief height| of all images [m]; 0 without relief. Reads every texel.
double highestRelief(const Scene& scene);

// Throws Error in one line, naming the key and the allowed range, for an invalid value.
void validate(const Scene& scene);

// Sets a value by its key of docs/file_formats.md, such as "friction.static" to "0.5"; "none"
// removes an optional value. Throws Error for an unknown key (listing the known ones) or an invalid
// value and leaves the scene unchanged. Lengths accept a unit ("0.5mm"). The later of resolution
// and voxel applies. The first friction coefficient sets both, so that the order does not matter;
// "none" for either removes friction.
void setValue(Scene& scene, const std::string& key, const std::string& value);
// Sets several values and validates at the end, so that their order does not matter.
void setValues(Scene& scene, const std::vector<std::pair<std::string, std::string>>& list);
// Returns keys and present values, in the order of the documentation.
std::vector<std::pair<std::string, std::string>> values(const Scene& scene);

} // namespace patina

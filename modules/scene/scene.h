// Everything a person authored or recorded, as plain values. An absent feature is an absent value.
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
#include "scene/device_model.h"
#include "scene/haptic_properties.h"
#include "scene/paint/object_paint.h"
#include "scene/paint/relief_settings.h"
#include "scene/scene_scan.h"

namespace patina {

struct SceneObject {
  std::string name;                         // unique in the scene; letters, digits, '-', '_'
  std::shared_ptr<const TriangleMesh> mesh; // [m], object frame
  Pose world_from_object = Pose::Identity();
  std::shared_ptr<const ObjectPaint> paint{}; // absent until the first stroke
};

struct Scene {
  std::vector<SceneObject> objects;
  std::vector<SceneScan> scans; // nothing of them is felt
  FieldSpec field;
  // Several objects are one field by min (K14): right outside and, where they overlap, too shallow
  // inside (F9). true = distances inside are those to the union's own surface.
  bool redistance = false;
  Sampler sampler = Sampler::high;
  HapticProperties haptics;
  ReliefSettings relief;                             // of painted relief, where there is any
  ForceForm material_form = ForceForm::conservative; // of painted stiffness (F6)
  int paint_size = 512;                              // texels a side of images that painting makes
  std::string device = "mouse";            // named in the catalogue of devices; who opens it judges
  std::optional<DeviceModel> device_model; // absent: nothing is known that could be unstable
  std::optional<Stabilisers> stabilisers;  // absent: chosen from device_model (auto)
};

// Whether an object or a scan may be called so.
bool isName(const std::string& name);

// What is felt where nothing is painted.
Material baseMaterial(const HapticProperties& haptics);
// Of all objects' images, height included [m]; 0 without relief. Looks at every texel.
double highestRelief(const Scene& scene);

// Throws Error in one line, naming the key and the allowed range, if a value makes no sense.
void validate(const Scene& scene);

// "friction.static", "0.5" and so on; the keys of docs/file_formats.md; "none" makes one absent.
// Throws Error for an unknown key (listing those known) or a bad value; the scene is then
// unchanged. Lengths take a unit ("0.5mm"). Of resolution and voxel the last one set holds. A first
// friction coefficient is both, so that the two may be set in either order; "none" for either
// takes friction away.
void setValue(Scene& scene, const std::string& key, const std::string& value);
// Several at once, judged together at the end, so that their order does not matter.
void setValues(Scene& scene, const std::vector<std::pair<std::string, std::string>>& list);
// Keys and present values, in the order of the documentation.
std::vector<std::pair<std::string, std::string>> values(const Scene& scene);

} // namespace patina

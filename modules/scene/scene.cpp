#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/numbers.h"
#include "core/utf8.h"
#include "scene/paint/grey_relief.h"
#include "scene/scene_values.h"

namespace patina {
namespace {

constexpr double kMaxReliefHeight = 0.1; // [m]
constexpr double kMaxDistance = 1e6;     // [m], up to which doubles resolve a nanometre

void require(bool holds, const std::string& key, double value, const std::string& range) {
  if (!holds) throw Error(key + " = " + formatNumber(value) + ": it must be " + range);
}

// Returns a suffix like " N/m", or an empty text for a ratio.
std::string unitAfter(const std::string& key) {
  const std::string unit(sceneKey(key).unit);
  return unit.empty() ? "" : " " + unit;
}

// NaN fails every comparison and is therefore rejected.
void requireBetween(const std::string& key, double value, double low, double high) {
  require(value >= low && value <= high, key, value,
          "between " + formatNumber(low) + " and " + formatNumber(high) + unitAfter(key));
}

void requireAllowed(MaterialChannel channel, double value) {
  const auto [least, most] = rangeOf(channel);
  requireBetween(std::string(name(channel)), value, least, most);
}

void requirePositive(const std::string& key, double value, double high) {
  require(value > 0 && value <= high, key, value,
          "above 0 and at most " + formatNumber(high) + unitAfter(key));
}

void validate(const Friction& friction) {
  requireAllowed(MaterialChannel::static_friction, friction.static_coefficient);
  requireAllowed(MaterialChannel::dynamic_friction, friction.dynamic_coefficient);
  requireBetween("friction.depth", friction.depth_gain, 0, 100);
  require(friction.dynamic_coefficient <= friction.static_coefficient, "friction.dynamic",
          friction.dynamic_coefficient,
          "at most friction.static = " + formatNumber(friction.static_coefficient));
}

void validate(const Magnet& magnet) {
  requireBetween("magnet.range", magnet.range, 0, 1);
  requireBetween("magnet.strength", magnet.strength, 0, 1e7);
}

void validate(const DeviceModel& device) {
  requirePositive("device.mass", device.mass, 100);
  requireBetween("device.damping", device.damping, 0, 1e4);
  requireBetween("device.coulomb", device.coulomb, 0, 100);
  requireBetween("device.encoder", device.encoder_step, 0, 0.01);
  requireBetween("device.rate", device.rate, 100, 10000);
  requireBetween("device.delay", device.delay, 0, kMaxDelay);
}

void validate(const HapticProperties& haptics) {
  requireAllowed(MaterialChannel::stiffness, haptics.stiffness);
  if (haptics.damping) requireAllowed(MaterialChannel::damping, *haptics.damping);
  if (haptics.damping_cutoff) requirePositive("damping.cutoff", *haptics.damping_cutoff, 1e5);
  if (haptics.friction) validate(*haptics.friction);
  if (haptics.tip_radius) requireBetween("tip.radius", *haptics.tip_radius, 0, 1);
  if (haptics.offset) requireBetween("offset", *haptics.offset, 0, 1);
  if (haptics.magnet) validate(*haptics.magnet);
  if (haptics.texture_gain) requirePositive("texture.gain", *haptics.texture_gain, 100);
  if (haptics.offset.value_or(0) > 0 && haptics.magnet)
    throw Error("offset and magnet use the same band: set one of them to none");
  requirePositive("force.limit", haptics.force_limit, 1000);
}

void validate(const FieldSpec& field) {
  requireBetween("band", field.band, 2, 64);
  if (field.voxel) {
    requirePositive("voxel", *field.voxel, 1000);
    return;
  }
  requireBetween("resolution", field.resolution, 8, 4095);
  require(field.resolution > 2 * field.band + 2, "resolution", field.resolution,
          "above 2 band + 2 = " + formatNumber(2 * field.band + 2) +
              ", because the band lies on both ends");
}

void validate(const std::vector<SceneObject>& objects) {
  std::set<std::string> seen;
  for (const SceneObject& object : objects) {
    if (!isName(object.name)) {
      throw Error("object name '" + object.name +
                  "': use letters (UTF-8), digits, '-' and '_' only, up to 100 bytes");
    }
    if (!seen.insert(object.name).second)
      throw Error("object name '" + object.name + "' is used twice");
    if (!object.mesh || object.mesh->triangles.empty())
      throw Error("object '" + object.name + "' has no triangles");
    try {
      if (object.paint && object.paint->textures)
        validate(*object.paint->textures, object.mesh->triangles.size());
    } catch (const Error& error) {
      throw Error("object '" + object.name + "': " + error.what());
    }
    const Eigen::Matrix3d rotation = object.world_from_object.linear();
    const bool rigid =
        object.world_from_object.matrix().allFinite() &&
        (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-6 &&
        rotation.determinant() > 0;
    // A scaled pose would scale distances and thus the force.
    if (!rigid) throw Error("object '" + object.name + "': its pose is not a rigid transform");
    const double away = object.world_from_object.translation().cwiseAbs().maxCoeff();
    if (!(away <= kMaxDistance))
      throw Error("object '" + object.name + "': its pose puts it " + formatNumber(away) +
                  " m away; the farthest is " + formatNumber(kMaxDistance) + " m");
  }
}

} // namespace

bool isName(const std::string& name) {
  if (name.empty() || name.size() > 100 || !isUtf8(name)) return false;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80);
    if (!letter && !(c >= '0' && c <= '9') && c != '-' && c != '_') return false;
  }
  return true;
}

Material baseMaterial(const HapticProperties& haptics) {
  Material base;
  base.stiffness = haptics.stiffness;
  if (haptics.friction) {
    base.static_friction = haptics.friction->static_coefficient;
    base.dynamic_friction = haptics.friction->dynamic_coefficient;
  }
  base.damping = haptics.damping.value_or(0);
  return base;
}

double highestRelief(const Scene& scene) {
  float highest = 0;
  for (const SceneObject& object : scene.objects) {
    const auto image = object.paint ? reliefOf(*object.paint, scene.relief.source) : nullptr;
    for (std::size_t i = 0; image && i < image->tileCount(); ++i)
      if (const auto& tile = image->sharedTile(i))
        for (const float g : *tile) highest = std::max(highest, std::abs(g));
  }
  return std::abs(scene.relief.height) * static_cast<double>(highest);
}

void validate(const Scene& scene) {
  validate(scene.objects);
  validate(scene.scans);
  validate(scene.field);
  validate(scene.haptics);
  if (haveTwoSides(scene.field.sides) &&
      !(scene.haptics.tip_radius.value_or(0) > 0 || scene.haptics.offset.value_or(0) > 0))
    throw Error("surface.sides = two: feeling both sides of a sheet needs a tip with a size; also "
                "set tip.radius or offset above 0");
  if (scene.device_model) validate(*scene.device_model);
  requireBetween("relief.height", scene.relief.height, -kMaxReliefHeight, kMaxReliefHeight);
  requireBetween("relief.smoothing", scene.relief.smoothing, 0, kMaxReliefHeight);
  const int size = scene.paint_size;
  require(size >= 64 && size <= 4096 && (size & (size - 1)) == 0, "paint.size", size,
          "64, 128, 256, 512, 1024, 2048 or 4096 texels");
}

} // namespace patina

#include <algorithm>
#include <cmath>

#include "acquisition/files/scan_files.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json.h"

namespace patina {
namespace {

constexpr const char* kAxes[] = {"a1u", "a1v", "a2u", "a2v"};

Json jsonOf(const Vec3& v) {
  return Json(Json::Array{v.x(), v.y(), v.z()});
}

Vec3 vectorIn(const Json& json, const std::string& key) {
  const Json& list = json.at(key);
  const bool three = list.isArray() && list.asArray().size() == 3 &&
                     std::all_of(list.asArray().begin(), list.asArray().end(),
                                 [](const Json& number) { return number.isNumber(); });
  if (!three) throw Error("'" + key + "' must be three numbers");
  const Json::Array& numbers = list.asArray();
  Vec3 v(numbers[0].asNumber(), numbers[1].asNumber(), numbers[2].asNumber());
  if (!v.allFinite()) throw Error("'" + key + "' is not finite");
  return v;
}

AccelerometerAxis axisIn(const Json& json) {
  const Vec3 direction = vectorIn(json, "direction");
  if (!(std::abs(direction.norm() - 1) < 0.01)) throw Error("a 'direction' must have length 1");
  return {vectorIn(json, "position"), direction.normalized()};
}

void setNumber(const Json& json, const std::string& key, double& number) {
  const Json* found = json.find(key);
  if (!found) return;
  number = found->isNumber() ? found->asNumber() : -1;
  if (!(number >= 0) || !std::isfinite(number)) throw Error("'" + key + "' must be 0 or more");
}

Rig rigIn(const Json& json) {
  Rig rig;
  rig.probe.tip = vectorIn(json, "tip");
  setNumber(json, "acceleration_step", rig.probe.acceleration_step);
  setNumber(json, "acceleration_noise", rig.probe.acceleration_noise);
  setNumber(json, "force_step", rig.probe.force_step);
  setNumber(json, "force_noise", rig.probe.force_noise);
  const Json* axes = json.find("accelerometers");
  if (!axes) return rig;
  for (std::size_t i = 0; i < rig.probe.axes.size(); ++i)
    rig.probe.axes[i] = axisIn(axes->at(kAxes[i]));
  if (!(rig.probe.accelerationVariance() > 0))
    throw Error("'acceleration_step' and 'acceleration_noise' cannot both be 0");
  rig.gravity = vectorIn(json, "gravity");
  rig.accelerometers = true;
  return rig;
}

} // namespace

Rig readRig(const std::filesystem::path& path) {
  const Json json = parseJson(readFile(path), path.string());
  try {
    return rigIn(json);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(path.string(), 0, error.what());
  }
}

std::string rigText(const Rig& rig) {
  Json json = Json::object(), axes = Json::object();
  json.set("tip", jsonOf(rig.probe.tip));
  for (std::size_t i = 0; i < rig.probe.axes.size(); ++i) {
    Json axis = Json::object();
    axis.set("position", jsonOf(rig.probe.axes[i].position));
    axes.set(kAxes[i], axis.set("direction", jsonOf(rig.probe.axes[i].direction)));
  }
  json.set("accelerometers", axes).set("gravity", jsonOf(rig.gravity));
  json.set("acceleration_step", rig.probe.acceleration_step);
  json.set("acceleration_noise", rig.probe.acceleration_noise);
  json.set("force_step", rig.probe.force_step).set("force_noise", rig.probe.force_noise);
  return json.dump() + "\n";
}

} // namespace patina

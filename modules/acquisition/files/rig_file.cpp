#include <algorithm>
#include <cctype>
#include <cmath>

#include "acquisition/files/scan_tables.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json.h"
#include "core/numbers.h"
#include "geometry/io/pose_file.h"

namespace patina {
namespace {

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

// Reads a position on a hand-held body [m].
Vec3 placeIn(const Json& json, const std::string& key) {
  const Vec3 place = vectorIn(json, key);
  if (!(place.norm() < 10)) throw Error("'" + key + "' is more than 10 m away");
  return place;
}

AccelerometerAxis axisIn(const Json& json) {
  const Vec3 direction = vectorIn(json, "direction");
  if (!(std::abs(direction.norm() - 1) < 0.01)) throw Error("a 'direction' must have length 1");
  return {placeIn(json, "position"), direction.normalized()};
}

void setNumber(const Json& json, const std::string& key, double& number) {
  const Json* found = json.find(key);
  if (!found) return;
  number = found->isNumber() ? found->asNumber() : -1;
  if (!(number >= 0) || !std::isfinite(number)) throw Error("'" + key + "' must be 0 or more");
}

Rig rigIn(const Json& json) {
  Rig rig;
  rig.probe.tip = placeIn(json, "tip");
  setNumber(json, "acceleration_step", rig.probe.acceleration_step);
  setNumber(json, "acceleration_noise", rig.probe.acceleration_noise);
  setNumber(json, "gyroscope_noise", rig.probe.rate_noise);
  rig.gyroscope = json.find("gyroscope_noise") != nullptr;
  setNumber(json, "force_step", rig.probe.force_step);
  setNumber(json, "force_noise", rig.probe.force_noise);
  setNumber(json, "tip_radius", rig.tip_radius);
  if (const Json* zero = json.find("force_zero")) rig.force_zero = zero->asNumber();
  if (!std::isfinite(rig.force_zero)) throw Error("'force_zero' is not finite");
  if (const Json* gain = json.find("force_gain")) rig.force_gain = gain->asNumber();
  if (!std::isfinite(rig.force_gain) || rig.force_gain == 0)
    throw Error("'force_gain' must be finite and not 0");
  const Json* axes = json.find("accelerometers");
  if (!axes) return rig;
  for (std::size_t i = 0; i < rig.probe.axes.size(); ++i)
    rig.probe.axes[i] = axisIn(axes->at(kAxisNames[i]));
  if (!(rig.probe.accelerationVariance() > 0))
    throw Error("'acceleration_step' and 'acceleration_noise' cannot both be 0");
  rig.gravity = vectorIn(json, "gravity");
  if (!(std::abs(rig.gravity.norm() - 9.8) < 1))
    throw Error("'gravity' has length " + formatNumber(rig.gravity.norm()) +
                " m/s^2, on the ground it is 9.8");
  rig.accelerometers = true;
  return rig;
}

// Reads a pose. Rounded rotations are normalised; matrices that are not rigid are refused.
Pose roundedPoseIn(const Json& json, const std::string& key) {
  Pose pose = poseIn(json, key, 0.01);
  pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return pose;
}

template <class Marker, class Visit> void forEachDeviation(Marker& marker, const Visit& visit) {
  visit("size_deviation", marker.size_deviation);
  visit("place_deviation", marker.place_deviation);
  visit("angle_deviation", marker.angle_deviation);
}

RigMarker markerIn(const Json& json) {
  RigMarker marker;
  for (const char c : json.at("dictionary").asString())
    marker.family += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (marker.family.starts_with("dict_")) marker.family = marker.family.substr(5); // OpenCV's name
  const std::int64_t id = json.at("id").asInteger();
  if (id < 0 || id > 100000) throw Error("an 'id' must be 0 or more");
  marker.id = static_cast<int>(id);
  marker.size = json.at("size").asNumber();
  if (!(marker.size > 0)) throw Error("a 'size' must be above 0 [m]");
  if (marker.size > 1)
    throw Error("a marker of " + formatNumber(marker.size) +
                " m? lengths of rig.json are in metres, so that 27 mm are 0.027");
  marker.probe_from_marker = roundedPoseIn(json, "probe_from_marker");
  forEachDeviation(marker, [&](const char* key, double& deviation) {
    if (const Json* value = json.find(key)) deviation = value->asNumber();
    if (!(deviation >= 0 && std::isfinite(deviation)))
      throw Error("'" + std::string(key) + "' must be 0 or more");
  });
  return marker;
}

std::vector<RigMarker> markersIn(const Json& json) {
  std::vector<RigMarker> markers;
  for (const Json& each : json.at("markers").asArray()) {
    const RigMarker marker = markerIn(each);
    for (const RigMarker& other : markers)
      if (other.id == marker.id && other.family == marker.family)
        throw Error("marker " + std::to_string(marker.id) + " is there twice");
    markers.push_back(marker);
  }
  if (markers.empty()) throw Error("there is no marker in it");
  return markers;
}

RigDeviations deviationsIn(const Json& json) {
  RigDeviations found;
  if (json.find("tip_deviation")) found.tip = vectorIn(json, "tip_deviation").cwiseAbs().maxCoeff();
  if (json.find("markers"))
    for (const RigMarker& marker : markersIn(json))
      if (marker.size_deviation > 0)
        found.size = std::max(found.size.value_or(0), marker.size_deviation / marker.size);
  found.calibrated = found.tip || found.size || json.find("accelerometers") ||
                     json.find("force_zero") || json.find("force_gain");
  return found;
}

template <class Read>
auto readJson(const std::string& text, const std::string& name, const Read& read) {
  const Json json = parseJson(text, name);
  try {
    return read(json);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(name, 0, error.what());
  }
}

Json jsonOf(const RigMarker& marker) {
  Json json = Json::object();
  json.set("dictionary", marker.family).set("id", marker.id).set("size", marker.size);
  json.set("probe_from_marker", poseJson(marker.probe_from_marker));
  forEachDeviation(marker, [&](const char* key, double deviation) {
    if (deviation > 0) json.set(key, deviation);
  });
  return json;
}

} // namespace

Rig readRig(const std::filesystem::path& path) {
  return parseRig(readFile(path), path.string());
}

Rig parseRig(const std::string& text, const std::string& name) {
  return readJson(text, name, rigIn);
}

std::vector<RigMarker> readMarkers(const std::filesystem::path& path) {
  return parseMarkers(readFile(path), path.string());
}

std::vector<RigMarker> parseMarkers(const std::string& text, const std::string& name) {
  return readJson(text, name, markersIn);
}

RigDeviations parseRigDeviations(const std::string& text, const std::string& name) {
  return readJson(text, name, deviationsIn);
}

std::string rigText(const Rig& rig, const std::vector<RigMarker>& markers) {
  Json json = Json::object(), axes = Json::object();
  json.set("tip", jsonOf(rig.probe.tip));
  if (rig.accelerometers) {
    for (std::size_t i = 0; i < rig.probe.axes.size(); ++i) {
      Json axis = Json::object();
      axis.set("position", jsonOf(rig.probe.axes[i].position));
      axes.set(kAxisNames[i], axis.set("direction", jsonOf(rig.probe.axes[i].direction)));
    }
    json.set("accelerometers", axes).set("gravity", jsonOf(rig.gravity));
  }
  if (rig.force_zero != 0) json.set("force_zero", rig.force_zero);
  if (rig.force_gain != 1) json.set("force_gain", rig.force_gain);
  if (rig.tip_radius != 0) json.set("tip_radius", rig.tip_radius);
  json.set("acceleration_step", rig.probe.acceleration_step);
  json.set("acceleration_noise", rig.probe.acceleration_noise);
  if (rig.gyroscope) json.set("gyroscope_noise", rig.probe.rate_noise);
  json.set("force_step", rig.probe.force_step).set("force_noise", rig.probe.force_noise);
  Json list = Json::array();
  for (const RigMarker& marker : markers) list.push(jsonOf(marker));
  if (!markers.empty()) json.set("markers", list);
  return json.dump() + "\n";
}

} // namespace patina

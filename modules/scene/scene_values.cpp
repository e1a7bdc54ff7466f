// Scene values as text: one table serves setting, listing and the message for an unknown key.
#include <array>
#include <cmath>
#include <functional>

#include "core/error.h"
#include "core/numbers.h"
#include "scene/scene.h"

namespace patina {
namespace {

double numberFor(const std::string& key, const std::string& text) {
  const std::optional<double> value = parseNumber(text);
  if (!value) throw Error(key + " = '" + text + "': it must be a number");
  return *value;
}

double lengthFor(const std::string& key, const std::string& text) {
  try {
    return parseLength(text);
  } catch (const Error& error) {
    throw Error(key + ": " + error.what());
  }
}

[[noreturn]] void refuseNone(const std::string& key) {
  throw Error(key + " cannot be none: a scene always has one");
}

bool isNone(const std::string& text) {
  return text == "none";
}

enum class Coefficient { static_one, dynamic_one };

// One number given for friction that was absent is both coefficients, so that the order in which
// the two are set does not matter and one alone is plain Coulomb friction.
void setCoefficient(Scene& scene, Coefficient which, double value) {
  Friction friction = scene.haptics.friction.value_or(Friction{});
  const bool unset = friction.static_coefficient == 0 && friction.dynamic_coefficient == 0;
  if (unset || which == Coefficient::static_one) friction.static_coefficient = value;
  if (unset || which == Coefficient::dynamic_one) friction.dynamic_coefficient = value;
  scene.haptics.friction = friction;
}

Friction& frictionOf(Scene& scene) {
  if (!scene.haptics.friction) scene.haptics.friction.emplace();
  return *scene.haptics.friction;
}

void setSlip(Scene& scene, const std::string& text) {
  if (text == "paper") {
    frictionOf(scene).slip = Friction::SlipDirection::paper;
  } else if (text == "displacement") {
    frictionOf(scene).slip = Friction::SlipDirection::displacement;
  } else {
    throw Error("friction.slip = '" + text + "': it must be paper or displacement");
  }
}

std::string slipName(Friction::SlipDirection slip) {
  return slip == Friction::SlipDirection::paper ? "paper" : "displacement";
}

std::optional<std::string> text(const std::optional<double>& value) {
  if (!value) return std::nullopt;
  return formatNumber(*value);
}

using Text = std::optional<std::string>;

bool yesOrNo(const std::string& key, const std::string& text) {
  if (text == "on" || text == "true" || text == "1" || text == "yes") return true;
  if (text == "off" || text == "false" || text == "0" || text == "no") return false;
  throw Error(key + " = '" + text + "': it must be on or off");
}

Text onOff(bool value) {
  return Text(value ? "on" : "off");
}

int wholeFor(const std::string& key, const std::string& text, const char* what) {
  const double value = numberFor(key, text);
  if (!(value == std::floor(value) && std::abs(value) <= 1e6))
    throw Error(key + " = '" + text + "': it must be a whole number of " + what);
  return static_cast<int>(value);
}

Magnet& magnetOf(Scene& scene) {
  if (!scene.haptics.magnet) scene.haptics.magnet.emplace();
  return *scene.haptics.magnet;
}

DeviceModel& deviceOf(Scene& scene) {
  if (!scene.device_model) scene.device_model.emplace();
  return *scene.device_model;
}

std::optional<Stabilisers> stabilisersFor(const std::string& text) {
  if (text == "auto") return std::nullopt;
  if (text == "none") return Stabilisers{};
  if (text == "coupling") return Stabilisers{true, false};
  if (text == "passivity") return Stabilisers{false, true};
  if (text == "coupling,passivity") return Stabilisers{true, true};
  throw Error("stabiliser = '" + text +
              "': it must be auto, none, coupling, passivity or coupling,passivity");
}

std::string nameOf(const std::optional<Stabilisers>& chosen) {
  if (!chosen) return "auto";
  if (chosen->coupling) return chosen->passivity ? "coupling,passivity" : "coupling";
  return chosen->passivity ? "passivity" : "none";
}

ForceForm formFor(const char* key, const std::string& text) {
  if (text == "conservative") return ForceForm::conservative;
  if (text == "literal") return ForceForm::literal;
  throw Error(key + (" = '" + text + "': it must be conservative or literal"));
}

Text nameOf(ForceForm form) {
  return form == ForceForm::conservative ? Text() : Text("literal");
}

struct Entry {
  const char* key;
  std::function<void(Scene&, const std::string&)> set;
  std::function<Text(const Scene&)> get;
};

// A number of the haptic properties that may be absent.
Entry optionalEntry(const char* key, std::optional<double> HapticProperties::*member,
                    double (*read)(const std::string&, const std::string&)) {
  return {key,
          [=](Scene& s, const std::string& t) {
            s.haptics.*member = isNone(t) ? std::nullopt : std::optional<double>(read(key, t));
          },
          [=](const Scene& s) { return text(s.haptics.*member); }};
}

// A number of the magnet; "none" takes the magnet away.
Entry magnetEntry(const char* key, double Magnet::*member,
                  double (*read)(const std::string&, const std::string&)) {
  return {key,
          [=](Scene& s, const std::string& t) {
            if (isNone(t)) return s.haptics.magnet.reset();
            const double value = read(key, t);
            magnetOf(s).*member = value;
          },
          [=](const Scene& s) {
            return s.haptics.magnet ? Text(formatNumber((*s.haptics.magnet).*member)) : Text();
          }};
}

// A number of the device's model; "none" takes the model away.
Entry deviceEntry(const char* key, double DeviceModel::*member,
                  double (*read)(const std::string&, const std::string&)) {
  return {key,
          [=](Scene& s, const std::string& t) {
            if (isNone(t)) return s.device_model.reset();
            const double value = read(key, t);
            deviceOf(s).*member = value;
          },
          [=](const Scene& s) {
            return s.device_model ? Text(formatNumber((*s.device_model).*member)) : Text();
          }};
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> kEntries = {
      {"stiffness",
       [](Scene& s, const std::string& t) {
         if (isNone(t)) refuseNone("stiffness");
         s.haptics.stiffness = numberFor("stiffness", t);
       },
       [](const Scene& s) { return Text(formatNumber(s.haptics.stiffness)); }},
      optionalEntry("damping", &HapticProperties::damping, numberFor),
      optionalEntry("damping.cutoff", &HapticProperties::damping_cutoff, numberFor),
      {"friction.static",
       [](Scene& s, const std::string& t) {
         if (isNone(t)) return s.haptics.friction.reset();
         setCoefficient(s, Coefficient::static_one, numberFor("friction.static", t));
       },
       [](const Scene& s) {
         return s.haptics.friction ? text(s.haptics.friction->static_coefficient) : Text();
       }},
      {"friction.dynamic",
       [](Scene& s, const std::string& t) {
         if (isNone(t)) return s.haptics.friction.reset();
         setCoefficient(s, Coefficient::dynamic_one, numberFor("friction.dynamic", t));
       },
       [](const Scene& s) {
         return s.haptics.friction ? text(s.haptics.friction->dynamic_coefficient) : Text();
       }},
      {"friction.depth",
       [](Scene& s, const std::string& t) {
         if (!isNone(t)) {
           frictionOf(s).depth_gain = numberFor("friction.depth", t);
         } else if (s.haptics.friction) {
           s.haptics.friction->depth_gain = 0;
         }
       },
       [](const Scene& s) {
         const bool present = s.haptics.friction && s.haptics.friction->depth_gain != 0;
         return present ? text(s.haptics.friction->depth_gain) : Text();
       }},
      {"friction.slip",
       [](Scene& s, const std::string& t) {
         if (!isNone(t)) {
           setSlip(s, t);
         } else if (s.haptics.friction) {
           s.haptics.friction->slip = Friction::SlipDirection::paper;
         }
       },
       [](const Scene& s) {
         return s.haptics.friction ? Text(slipName(s.haptics.friction->slip)) : Text();
       }},
      optionalEntry("offset", &HapticProperties::offset, lengthFor),
      magnetEntry("magnet.range", &Magnet::range, lengthFor),
      magnetEntry("magnet.strength", &Magnet::strength, numberFor),
      {"magnet.fades",
       [](Scene& s, const std::string& t) {
         if (!isNone(t)) {
           magnetOf(s).fades = yesOrNo("magnet.fades", t);
         } else if (s.haptics.magnet) {
           s.haptics.magnet->fades = false;
         }
       },
       [](const Scene& s) {
         return s.haptics.magnet && s.haptics.magnet->fades ? onOff(true) : Text();
       }},
      {"contact",
       [](Scene& s, const std::string& t) {
         if (t != "proxy" && t != "ray")
           throw Error("contact = '" + t + "': it must be proxy or ray");
         s.haptics.contact =
             t == "ray" ? HapticProperties::Contact::ray : HapticProperties::Contact::proxy;
       },
       [](const Scene& s) {
         return s.haptics.contact == HapticProperties::Contact::proxy ? Text() : Text("ray");
       }},
      optionalEntry("tip.radius", &HapticProperties::tip_radius, lengthFor),
      {"force.limit",
       [](Scene& s, const std::string& t) {
         if (isNone(t)) refuseNone("force.limit");
         s.haptics.force_limit = numberFor("force.limit", t);
       },
       [](const Scene& s) { return Text(formatNumber(s.haptics.force_limit)); }},
      {"resolution",
       [](Scene& s, const std::string& t) {
         if (isNone(t)) refuseNone("resolution");
         s.field.resolution = wholeFor("resolution", t, "cells");
         s.field.voxel.reset(); // whichever of the two was set last holds
       },
       [](const Scene& s) {
         return s.field.voxel ? Text() : Text(std::to_string(s.field.resolution));
       }},
      {"voxel",
       [](Scene& s, const std::string& t) {
         s.field.voxel.reset();
         if (!isNone(t)) s.field.voxel = lengthFor("voxel", t);
       },
       [](const Scene& s) { return text(s.field.voxel); }},
      {"band",
       [](Scene& s, const std::string& t) {
         if (isNone(t)) refuseNone("band");
         s.field.band = numberFor("band", t);
       },
       [](const Scene& s) { return Text(formatNumber(s.field.band)); }},
      {"sampler",
       [](Scene& s, const std::string& t) {
         if (isNone(t)) refuseNone("sampler");
         s.sampler = parseSampler(t);
       },
       [](const Scene& s) { return Text(std::string(name(s.sampler))); }},
      {"surface.sides",
       [](Scene& s, const std::string& t) {
         if (t != "one" && t != "two")
           throw Error("surface.sides = '" + t + "': it must be one or two");
         s.field.sides = t == "one" ? OpenSides::one : OpenSides::two;
       },
       [](const Scene& s) { return s.field.sides == OpenSides::one ? Text() : Text("two"); }},
      {"merge.redistance",
       [](Scene& s, const std::string& t) { s.redistance = yesOrNo("merge.redistance", t); },
       [](const Scene& s) { return s.redistance ? onOff(true) : Text(); }},
      {"relief.mode",
       [](Scene& s, const std::string& t) {
         if (t != "pulled" && t != "baked")
           throw Error("relief.mode = '" + t + "': it must be pulled or baked");
         s.relief.mode = t == "pulled" ? ReliefMode::pulled : ReliefMode::baked;
       },
       [](const Scene& s) { return s.relief.mode == ReliefMode::pulled ? Text() : Text("baked"); }},
      {"relief.source",
       [](Scene& s, const std::string& t) {
         if (t != "painted" && t != "color" && !isNone(t))
           throw Error("relief.source = '" + t + "': it must be painted or color");
         s.relief.source = t == "color" ? ReliefFrom::color : ReliefFrom::painted;
       },
       [](const Scene& s) {
         return s.relief.source == ReliefFrom::painted ? Text() : Text("color");
       }},
      {"relief.height",
       [](Scene& s, const std::string& t) {
         s.relief.height = isNone(t) ? ReliefSettings{}.height : lengthFor("relief.height", t);
       },
       [](const Scene& s) {
         return s.relief.height == ReliefSettings{}.height ? Text() : text(s.relief.height);
       }},
      {"relief.force",
       [](Scene& s, const std::string& t) { s.relief.form = formFor("relief.force", t); },
       [](const Scene& s) { return nameOf(s.relief.form); }},
      {"relief.smoothing",
       [](Scene& s, const std::string& t) {
         s.relief.smoothing = isNone(t) ? 0 : lengthFor("relief.smoothing", t);
       },
       [](const Scene& s) { return s.relief.smoothing == 0 ? Text() : text(s.relief.smoothing); }},
      {"material.force",
       [](Scene& s, const std::string& t) { s.material_form = formFor("material.force", t); },
       [](const Scene& s) { return nameOf(s.material_form); }},
      {"paint.size",
       [](Scene& s, const std::string& t) {
         s.paint_size = isNone(t) ? Scene{}.paint_size : wholeFor("paint.size", t, "texels");
       },
       [](const Scene& s) {
         return s.paint_size == Scene{}.paint_size ? Text() : Text(std::to_string(s.paint_size));
       }},
      {"stabiliser", [](Scene& s, const std::string& t) { s.stabilisers = stabilisersFor(t); },
       [](const Scene& s) { return s.stabilisers ? Text(nameOf(s.stabilisers)) : Text(); }},
      deviceEntry("device.mass", &DeviceModel::mass, numberFor),
      deviceEntry("device.damping", &DeviceModel::damping, numberFor),
      deviceEntry("device.coulomb", &DeviceModel::coulomb, numberFor),
      deviceEntry("device.encoder", &DeviceModel::encoder_step, lengthFor),
      deviceEntry("device.rate", &DeviceModel::rate, numberFor),
      {"device.delay",
       [](Scene& s, const std::string& t) {
         if (isNone(t)) return s.device_model.reset();
         const int delay = wholeFor("device.delay", t, "samples");
         deviceOf(s).delay = delay;
       },
       [](const Scene& s) {
         return s.device_model ? Text(std::to_string(s.device_model->delay)) : Text();
       }},
      {"device", [](Scene& s, const std::string& t) { s.device = t; },
       [](const Scene& s) { return Text(s.device); }},
  };
  return kEntries;
}

} // namespace

void setValues(Scene& scene, const std::vector<std::pair<std::string, std::string>>& list) {
  Scene changed = scene; // meshes are shared, so this is cheap
  const auto assign = [&](const std::string& key, const std::string& value) {
    for (const Entry& entry : entries()) {
      if (key == entry.key) return entry.set(changed, value);
    }
    std::string known;
    for (const Entry& entry : entries()) known += std::string(" ") + entry.key;
    throw Error("unknown key '" + key + "'; known are:" + known);
  };
  // First, because a first coefficient is both: "dynamic 0, static 0.5" must not lose its zero.
  for (const auto& [key, value] : list)
    if (key == "friction.static") assign(key, value);
  for (const auto& [key, value] : list)
    if (key != "friction.static") assign(key, value);
  validate(changed);
  scene = std::move(changed);
}

void setValue(Scene& scene, const std::string& key, const std::string& value) {
  setValues(scene, {{key, value}});
}

std::vector<std::pair<std::string, std::string>> values(const Scene& scene) {
  std::vector<std::pair<std::string, std::string>> list;
  for (const Entry& entry : entries())
    if (Text value = entry.get(scene)) list.emplace_back(entry.key, std::move(*value));
  return list;
}

} // namespace patina

// Scene values as text: one table for setting, listing and the error for an unknown key.
#include <cmath>
#include <functional>
#include <stdexcept>

#include "core/error.h"
#include "core/named.h"
#include "core/numbers.h"
#include "scene/scene.h"
#include "scene/scene_values.h"

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

Friction& frictionOf(Scene& scene) {
  if (!scene.haptics.friction) scene.haptics.friction.emplace();
  return *scene.haptics.friction;
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

constexpr Named<Friction::SlipDirection> kSlips[] = {
    {Friction::SlipDirection::paper, "paper"},
    {Friction::SlipDirection::displacement, "displacement"}};
constexpr Named<HapticProperties::Contact> kContacts[] = {
    {HapticProperties::Contact::proxy, "proxy"}, {HapticProperties::Contact::ray, "ray"}};
constexpr Named<OpenSides> kSides[] = {{OpenSides::automatic, "auto"},
                                       {OpenSides::one, "one"},
                                       {OpenSides::two, "two"},
                                       {OpenSides::closed, "closed"},
                                       {OpenSides::automatic_two, "auto-two"}};
constexpr Named<ReliefMode> kModes[] = {{ReliefMode::pulled, "pulled"},
                                        {ReliefMode::baked, "baked"}};
constexpr Named<ReliefSource> kSources[] = {{ReliefSource::painted, "painted"},
                                            {ReliefSource::color, "color"}};
constexpr Named<ForceForm> kForms[] = {{ForceForm::conservative, "conservative"},
                                       {ForceForm::literal, "literal"}};
constexpr Named<std::optional<Stabilisers>> kStabilisers[] = {
    {std::nullopt, "auto"},
    {Stabilisers{}, "none"},
    {Stabilisers{true, false}, "coupling"},
    {Stabilisers{false, true}, "passivity"},
    {Stabilisers{true, true}, "coupling,passivity"}};

template <typename Table>
auto chosen(const std::string& key, const std::string& text, const Table& table) {
  if (const auto found = parseIn(table, text)) return *found;
  throw Error(key + " = '" + text + "': it must be " + allNames(table, " or "));
}

struct Entry : SceneKey {
  std::function<void(Scene&, const std::string&)> set;
  std::function<Text(const Scene&)> get;
};

// Entry for one word of a table, omitted if it is the default.
template <typename Table, typename Member>
Entry choiceEntry(const char* key, const Table& table, const Member& member) {
  const auto default_value = member(Scene{});
  return {{key, "", std::string(nameIn(table, default_value))},
          [=, &table](Scene& s, const std::string& t) { member(s) = chosen(key, t, table); },
          [=, &table](const Scene& s) {
            const auto& value = member(s);
            return value == default_value ? Text() : Text(nameIn(table, value));
          }};
}

// Entry for a number that a scene always has.
template <typename Member>
Entry numberEntry(const char* key, std::string_view unit, const Member& member) {
  return {{key, unit, formatNumber(member(Scene{}))},
          [=](Scene& s, const std::string& t) {
            if (isNone(t)) refuseNone(key);
            member(s) = numberFor(key, t);
          },
          [=](const Scene& s) { return Text(formatNumber(member(s))); }};
}

// Entry for an optional number of the haptic properties.
Entry optionalEntry(const char* key, std::string_view unit,
                    std::optional<double> HapticProperties::*member,
                    double (*read)(const std::string&, const std::string&)) {
  return {{key, unit, "none"},
          [=](Scene& s, const std::string& t) {
            s.haptics.*member = isNone(t) ? std::nullopt : std::optional<double>(read(key, t));
          },
          [=](const Scene& s) { return text(s.haptics.*member); }};
}

// Entry for a friction coefficient. The first one sets both, so that their order does not matter.
Entry frictionEntry(const char* key, MaterialChannel channel, double Friction::*member) {
  return {{key, unit(channel), "none"},
          [=](Scene& s, const std::string& t) {
            if (isNone(t)) return s.haptics.friction.reset();
            const double value = numberFor(key, t);
            Friction& friction = frictionOf(s);
            if (friction.static_coefficient == 0 && friction.dynamic_coefficient == 0)
              friction.static_coefficient = friction.dynamic_coefficient = value;
            friction.*member = value;
          },
          [=](const Scene& s) {
            return s.haptics.friction ? text((*s.haptics.friction).*member) : Text();
          }};
}

// Entry for a length of the relief, omitted if it is the default.
Entry reliefEntry(const char* key, const std::string& default_value,
                  double ReliefSettings::*member) {
  return {{key, "m", default_value},
          [=](Scene& s, const std::string& t) {
            s.relief.*member = isNone(t) ? ReliefSettings{}.*member : lengthFor(key, t);
          },
          [=](const Scene& s) {
            return s.relief.*member == ReliefSettings{}.*member ? Text() : text(s.relief.*member);
          }};
}

// Entry for a number of the magnet; "none" removes the magnet.
Entry magnetEntry(const char* key, std::string_view unit, double Magnet::*member,
                  double (*read)(const std::string&, const std::string&)) {
  return {{key, unit, "none"},
          [=](Scene& s, const std::string& t) {
            if (isNone(t)) return s.haptics.magnet.reset();
            const double value = read(key, t);
            magnetOf(s).*member = value;
          },
          [=](const Scene& s) {
            return s.haptics.magnet ? Text(formatNumber((*s.haptics.magnet).*member)) : Text();
          }};
}

// Entry for a number of the device's model; "none" removes the model.
Entry deviceEntry(const char* key, std::string_view unit, double DeviceModel::*member,
                  double (*read)(const std::string&, const std::string&)) {
  return {{key, unit, "none"},
          [=](Scene& s, const std::string& t) {
            if (isNone(t)) return s.device_model.reset();
            const double value = read(key, t);
            deviceOf(s).*member = value;
          },
          [=](const Scene& s) {
            return s.device_model ? Text(formatNumber((*s.device_model).*member)) : Text();
          }};
}

std::vector<Entry> hapticEntries() {
  return {
      numberEntry(
          "stiffness", unit(MaterialChannel::stiffness),
          [](auto&& s) -> auto& { return s.haptics.stiffness; }),
      optionalEntry("damping", unit(MaterialChannel::damping), &HapticProperties::damping,
                    numberFor),
      optionalEntry("damping.cutoff", "Hz", &HapticProperties::damping_cutoff, numberFor),
      frictionEntry("friction.static", MaterialChannel::static_friction,
                    &Friction::static_coefficient),
      frictionEntry("friction.dynamic", MaterialChannel::dynamic_friction,
                    &Friction::dynamic_coefficient),
      {{"friction.depth", "", "none"},
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
      {{"friction.slip", "", "none"},
       [](Scene& s, const std::string& t) {
         if (!isNone(t)) {
           frictionOf(s).slip = chosen("friction.slip", t, kSlips);
         } else if (s.haptics.friction) {
           s.haptics.friction->slip = Friction::SlipDirection::paper;
         }
       },
       [](const Scene& s) {
         return s.haptics.friction ? Text(nameIn(kSlips, s.haptics.friction->slip)) : Text();
       }},
      optionalEntry("offset", "m", &HapticProperties::offset, lengthFor),
      magnetEntry("magnet.range", "m", &Magnet::range, lengthFor),
      magnetEntry("magnet.strength", "N/m", &Magnet::strength, numberFor),
      {{"magnet.fades", "", "none"},
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
      optionalEntry("texture.gain", "", &HapticProperties::texture_gain, numberFor),
      choiceEntry(
          "contact", kContacts, [](auto&& s) -> auto& { return s.haptics.contact; }),
      optionalEntry("tip.radius", "m", &HapticProperties::tip_radius, lengthFor),
      numberEntry(
          "force.limit", "N", [](auto&& s) -> auto& { return s.haptics.force_limit; }),
      {{"resolution", "cells", std::to_string(FieldSpec{}.resolution)},
       [](Scene& s, const std::string& t) {
         if (isNone(t)) refuseNone("resolution");
         s.field.resolution = wholeFor("resolution", t, "cells");
         s.field.voxel.reset(); // the later of the two applies
       },
       [](const Scene& s) {
         return s.field.voxel ? Text() : Text(std::to_string(s.field.resolution));
       }},
      {{"voxel", "m", "none"},
       [](Scene& s, const std::string& t) {
         s.field.voxel.reset();
         if (!isNone(t)) s.field.voxel = lengthFor("voxel", t);
       },
       [](const Scene& s) { return text(s.field.voxel); }},
      numberEntry(
          "band", "voxels", [](auto&& s) -> auto& { return s.field.band; }),
      {{"sampler", "", std::string(name(Scene{}.sampler))},
       [](Scene& s, const std::string& t) {
         if (isNone(t)) refuseNone("sampler");
         s.sampler = parseSampler(t);
       },
       [](const Scene& s) { return Text(std::string(name(s.sampler))); }},
      choiceEntry(
          "surface.sides", kSides, [](auto&& s) -> auto& { return s.field.sides; }),
      {{"merge.redistance", "", "off"},
       [](Scene& s, const std::string& t) { s.redistance = yesOrNo("merge.redistance", t); },
       [](const Scene& s) { return s.redistance ? onOff(true) : Text(); }},
      choiceEntry(
          "relief.mode", kModes, [](auto&& s) -> auto& { return s.relief.mode; }),
      {{"relief.source", "", "none"},
       [](Scene& s, const std::string& t) {
         s.relief.source = isNone(t) ? ReliefSource::painted : chosen("relief.source", t, kSources);
       },
       [](const Scene& s) {
         return s.relief.source == ReliefSource::painted ? Text()
                                                         : Text(nameIn(kSources, s.relief.source));
       }},
      reliefEntry("relief.height", formatNumber(ReliefSettings{}.height), &ReliefSettings::height),
      choiceEntry(
          "relief.force", kForms, [](auto&& s) -> auto& { return s.relief.form; }),
      reliefEntry("relief.smoothing", "none", &ReliefSettings::smoothing),
      choiceEntry(
          "material.force", kForms, [](auto&& s) -> auto& { return s.material_form; }),
      {{"paint.size", "texels", std::to_string(Scene{}.paint_size)},
       [](Scene& s, const std::string& t) {
         s.paint_size = isNone(t) ? Scene{}.paint_size : wholeFor("paint.size", t, "texels");
       },
       [](const Scene& s) {
         return s.paint_size == Scene{}.paint_size ? Text() : Text(std::to_string(s.paint_size));
       }},
      choiceEntry(
          "stabiliser", kStabilisers, [](auto&& s) -> auto& { return s.stabilisers; }),
      deviceEntry("device.mass", "kg", &DeviceModel::mass, numberFor),
      deviceEntry("device.damping", "N s/m", &DeviceModel::damping, numberFor),
      deviceEntry("device.coulomb", "N", &DeviceModel::coulomb, numberFor),
      deviceEntry("device.encoder", "m", &DeviceModel::encoder_step, lengthFor),
      deviceEntry("device.rate", "Hz", &DeviceModel::rate, numberFor),
      {{"device.delay", "samples", "none"},
       [](Scene& s, const std::string& t) {
         if (isNone(t)) return s.device_model.reset();
         const int delay = wholeFor("device.delay", t, "samples");
         deviceOf(s).delay = delay;
       },
       [](const Scene& s) {
         return s.device_model ? Text(std::to_string(s.device_model->delay)) : Text();
       }},
      {{"device", "", Scene{}.device},
       [](Scene& s, const std::string& t) { s.device = t; },
       [](const Scene& s) { return Text(s.device); }},
  };
}

// Entry for the colour scale of a drawn thing; the key must outlive it.
Entry colorEntry(const std::string& key, const std::string& thing) {
  return {{key, "", "none"},
          [&key, thing](Scene& s, const std::string& t) {
            try {
              const ColorScale scale = parseColorScale(t);
              s.colors.erase(thing);
              if (scale != ColorScale{}) s.colors[thing] = scale;
            } catch (const Error& error) {
              throw Error(key + ": " + error.what());
            }
          },
          [thing](const Scene& s) {
            const std::string words = format(scaleOf(s.colors, thing));
            return words.empty() ? Text() : Text(words);
          }};
}

// Entry for the position of a slice; the key must outlive it.
Entry sliceEntry(const std::string& key, std::size_t index) {
  return {{key, "", "none"},
          [&key, index](Scene& s, const std::string& t) {
            try {
              s.slices[index] = isNone(t) ? std::nullopt : std::optional(parseSlice(t));
            } catch (const Error& error) {
              throw Error(key + ": " + error.what());
            }
          },
          [index](const Scene& s) {
            return s.slices[index] ? Text(format(*s.slices[index])) : Text();
          }};
}

const std::vector<Entry>& entries() {
  static const std::vector<Entry> kEntries = [] {
    std::vector<Entry> all = hapticEntries();
    static const std::vector<std::string> keys = [] {
      std::vector<std::string> names;
      for (const std::string& thing : coloredThings()) names.push_back("colors." + thing);
      return names;
    }();
    all.push_back({{"pins", "", "none"},
                   [](Scene& s, const std::string& t) { s.pins = parsePins(t); },
                   [](const Scene& s) { return s.pins.empty() ? Text() : Text(format(s.pins)); }});
    for (std::size_t i = 0; i < keys.size(); ++i)
      all.push_back(colorEntry(keys[i], coloredThings()[i]));
    static const std::array<std::string, kMaxSlices> slices = {"slice", "slice2", "slice3"};
    for (std::size_t i = 0; i < kMaxSlices; ++i) all.push_back(sliceEntry(slices[i], i));
    return all;
  }();
  return kEntries;
}

} // namespace

const SceneKey& sceneKey(std::string_view key) {
  for (const Entry& entry : entries())
    if (entry.key == key) return entry;
  throw std::out_of_range("sceneKey: no key " + std::string(key));
}

void setValues(Scene& scene, const std::vector<std::pair<std::string, std::string>>& list) {
  Scene changed = scene; // cheap, since meshes are shared
  const auto assign = [&](const std::string& key, const std::string& value) {
    for (const Entry& entry : entries()) {
      if (key == entry.key) return entry.set(changed, value);
    }
    std::string known;
    for (const Entry& entry : entries()) known += " " + std::string(entry.key);
    throw Error("unknown key '" + key + "'; known are:" + known);
  };
  // Assigned first, because the first coefficient sets both: "dynamic 0, static 0.5" must keep its
  // zero.
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
    if (Text value = entry.get(scene)) list.emplace_back(std::string(entry.key), std::move(*value));
  return list;
}

} // namespace patina

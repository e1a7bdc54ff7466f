#include "app/cli/input/scene_options.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/numbers.h"
#include "scene/scene_values.h"
#include "session/compile/compile_warnings.h"
#include "workspace/texture_file.h"

namespace patina::cli {

namespace {

// Scene in which only the key itself can be invalid.
Scene trialFor(const std::string& key) {
  Scene trial;
  if (key == "resolution") trial.field.band = 2;
  if (key == "band") trial.field.resolution = 4095;
  return trial;
}

// "--friction-static"
std::string optionFor(std::string key) {
  std::ranges::replace(key, '.', '-');
  return "--" + key;
}

Argument setting(SceneOptions& options, const SettingEntry& entry) {
  const SceneKey& known = sceneKey(entry.key);
  // The caption of a counted value contains its unit.
  const bool counted = known.unit == "cells" || known.unit == "voxels" || known.unit == "samples";
  return {entry.option.empty() ? optionFor(entry.key) : entry.option,
          entry.value,
          counted ? "" : std::string(known.unit),
          entry.usual.value_or(known.default_value == "none" ? "" : known.default_value),
          entry.caption,
          [&options, key = entry.key](const std::string& text) {
            Scene trial = trialFor(key);
            setValue(trial, key, text);
            options.settings.emplace_back(key, text);
          }};
}

// "ID=T.json"
void addTexture(const std::string& text, TextureTable& textures) {
  const std::size_t equals = text.find('=');
  const auto number = parseNumber(text.substr(0, equals));
  if (equals == std::string::npos || equals + 1 == text.size() || !number || *number < 0 ||
      *number > 1e9 || *number != std::floor(*number))
    throw Error("'" + text + "' is not ID=T.json");
  const std::string file = text.substr(equals + 1);
  try {
    textures[static_cast<std::int32_t>(*number)] = hapticTexture(readTexture(file));
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(file, 0, error.what());
  }
}

} // namespace

void addSettings(Command& command, SceneOptions& options,
                 const std::vector<SettingEntry>& entries) {
  for (const SettingEntry& entry : entries) command.arguments.push_back(setting(options, entry));
}

void addOpenOptions(Command& command, OpenOptions& open) {
  command.arguments.push_back({"--unit", "mm|cm|m|in|fit", "", "mm",
                               "Unit of a mesh file; fit scales its longest side to 100 mm. "
                               "Workspaces and fields written by patina are in metres already.",
                               [&open](const std::string& text) {
                                 open.unit = parseMeshUnit(text);
                                 open.unit_chosen = true;
                               }});
  command.arguments.push_back({"--up", "z|y", "", "z",
                               "Axis of a mesh file that points upwards; y is turned to z.",
                               parsedInto(open.up, parseUpAxis)});
  command.arguments.push_back({"--iso", "VALUE", "", "",
                               "Value at which a volume (.vti) from elsewhere is a surface.",
                               into(open.iso)});
}

void addTextureOption(Command& command, TextureTable& textures) {
  command.arguments.push_back(
      {"--texture",
       "ID=T.json",
       "",
       "",
       "A Fourier texture for the faces that an OBJ or a workspace gives this number.",
       {[&textures](const std::string& text) { addTexture(text, textures); },
        [](const std::string& text) {
          return std::vector<std::filesystem::path>{text.substr(text.find('=') + 1)};
        }},
       Times::any});
}

void addFieldOptions(Command& command, SceneOptions& options) {
  addSettings(command, options,
              {{"resolution", "N", "Cells along the longest side, with the band on both ends."},
               {"voxel", "LENGTH", "Side of a cell; takes the place of --resolution."},
               {"band", "N", "Voxels on each side of the surface in which the field is stored."}});
}

void addSampledFieldOptions(Command& command, SceneOptions& options) {
  std::vector<std::string> names, captions;
  for (const SamplerEntry& entry : kSamplers) {
    names.emplace_back(entry.name);
    captions.push_back(names.back() + " " + std::string(entry.caption));
  }
  addFieldOptions(command, options);
  addSettings(command, options,
              {{"sampler", joined(names, "|"),
                "How the field is read between nodes: " + joined(captions) + "."}});
  addOpenOptions(command, options.open);
}

void addHapticOptions(Command& command, SceneOptions& options) {
  addSettings(
      command, options,
      {{"stiffness", "K", "Spring."},
       {"damping", "B", "Damper along the normal."},
       {"friction.static", "MU", "Coefficient that holds the tip at rest."},
       {"friction.dynamic", "MU", "Coefficient while the tip slips; not above the static one."},
       {"friction.depth", "GAIN", "Growth of friction with depth, for each mm."},
       {"friction.slip", "paper|displacement",
        "Direction of slip: towards the tip, or against the contact point's own motion.", "paper"},
       {"damping.cutoff", "HZ", "Low-pass of the velocity that the damper sees."},
       {"offset", "LENGTH", "Offset surface: contact begins this far from the model."},
       {"magnet.range", "LENGTH", "Magnetic surface: the tip is pulled from this far."},
       {"magnet.strength", "K", "Pull of the magnet for each metre of distance."},
       {"magnet.fades", "on|off", "The pull falls to zero over the last quarter of its range.",
        "off"},
       {"texture.gain", "RATIO",
        "Fourier textures as a layer so many times as stiff as the surface, pressed beside it."},
       {"contact", "proxy|ray",
        "proxy: the nearest point that the tip's proxy reaches over the surface; ray: the "
        "paper's, from the tip alone."},
       {"tip.radius", "LENGTH", "Radius of the tip; its centre feels the surface that far out."},
       {"force.limit", "N", "Largest force."}});
  addTextureOption(command, options.textures);
}

void applySettings(Scene& scene, const Settings& settings) {
  Settings ordered = settings;
  // Resolution and voxel replace each other; a voxel given beside a resolution wins.
  std::ranges::stable_partition(ordered,
                                [](const auto& setting) { return setting.first != "voxel"; });
  setValues(scene, ordered);
}

bool setsTipRadius(const Settings& settings) {
  for (auto setting = settings.rbegin(); setting != settings.rend(); ++setting)
    if (setting->first == "tip.radius") {
      Scene scene;
      setValue(scene, setting->first, setting->second);
      return scene.haptics.tip_radius.value_or(0.0) > 0;
    }
  return false;
}

int paintSizeOf(const Settings& settings, int before) {
  Scene scene;
  scene.paint_size = before;
  for (const auto& [key, value] : settings)
    if (key == "paint.size") setValue(scene, key, value);
  return scene.paint_size;
}

namespace {

// Warns of settings without a condition for their effect.
void warnOfNoEffect(const Scene& scene, const SceneOptions& options, Console& console) {
  const HapticProperties& haptics = scene.haptics;
  const auto given = [&](std::string_view key) {
    return std::ranges::any_of(options.settings,
                               [&](const auto& setting) { return setting.first == key; });
  };
  const auto needs = [&](const std::string& key, bool there, const std::string& what) {
    if (given(key) && !there) console.warn(optionFor(key) + " has no effect without " + what);
  };
  const auto some = [&](auto member) {
    return std::ranges::any_of(scene.objects, [&](const SceneObject& object) {
      return object.paint && (*object.paint).*member;
    });
  };
  const bool painted = some(&ObjectPaint::material); // any channel
  needs("damping.cutoff", painted || haptics.damping, "--damping");
  const bool rubs = haptics.friction && haptics.friction->static_coefficient > 0;
  for (const char* key : {"friction.depth", "friction.slip"})
    needs(key, painted || rubs, "--friction-static");
  needs("magnet.fades", haptics.magnet && haptics.magnet->range > 0, "--magnet-range");
  needs("texture.gain", some(&ObjectPaint::textures), "a texture");
  if (given("voxel") && given("resolution"))
    console.warn("--resolution has no effect beside --voxel");
}

} // namespace

OpenedScene openedWith(const std::filesystem::path& path, const SceneOptions& options,
                       Console& console) {
  OpenOptions open = options.open;
  open.tip_radius_chosen = setsTipRadius(options.settings);
  open.paint_size = paintSizeOf(options.settings, open.paint_size);
  OpenedScene opened = openScene(path, open);
  for (const std::string& warning : opened.warnings) console.warn(warning);
  layTextures(opened.scene, options.textures);
  applySettings(opened.scene, options.settings);
  warnOfNoEffect(opened.scene, options, console);
  return opened;
}

Scene openWith(const std::filesystem::path& path, const SceneOptions& options, Console& console) {
  return openedWith(path, options, console).scene;
}

std::shared_ptr<const CompiledScene> compileFor(Scene scene, Console& console, FaceLayer faces) {
  auto compiled = compile(std::move(scene), console.progress(), faces);
  for (const std::string& line : compileWarnings(*compiled)) console.warn(line);
  return compiled;
}

} // namespace patina::cli

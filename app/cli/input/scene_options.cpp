#include "app/cli/input/scene_options.h"

#include "core/error.h"
#include "core/numbers.h"
#include "session/build/compile_warnings.h"

namespace patina::cli {

namespace {

// A scene in which nothing but the key itself can be wrong.
Scene trialFor(const std::string& key) {
  Scene trial;
  if (key == "resolution") trial.field.band = 2;
  if (key == "band") trial.field.resolution = 4095;
  return trial;
}

} // namespace

void addSetting(Command& command, SceneOptions& options, const std::string& name,
                const std::string& key, const std::string& value, const std::string& help,
                const std::string& fallback) {
  command.arguments.push_back(
      {name, value, help, fallback, false, false, [&options, key](const std::string& text) {
         Scene trial = trialFor(key);
         setValue(trial, key, text);
         options.settings.emplace_back(key, text);
       }});
}

void addOpenOptions(Command& command, OpenOptions& open) {
  command.arguments.push_back({"--unit", "mm|cm|m|in|fit",
                               "Unit of a mesh file; fit scales its longest side to 100 mm. "
                               "Workspaces and fields written by patina are in metres already.",
                               "mm", false, false, [&open](const auto& text) {
                                 open.unit = parseMeshUnit(text);
                                 open.unit_chosen = true;
                               }});
  command.number("--iso", "VALUE", "Value at which a volume (.vti) from elsewhere is a surface.",
                 open.iso);
}

void addFieldOptions(Command& command, SceneOptions& options) {
  const FieldSpec usual;
  addSetting(command, options, "--resolution", "resolution", "N",
             "Cells along the longest side, with the band on both ends.",
             std::to_string(usual.resolution));
  addSetting(command, options, "--voxel", "voxel", "LENGTH",
             "Side of a cell [m]; takes the place of --resolution.", "");
  addSetting(command, options, "--band", "band", "N",
             "Voxels on each side of the surface in which the field is stored.",
             formatNumber(usual.band));
}

void addSamplerOption(Command& command, SceneOptions& options) {
  std::string names, captions;
  for (const SamplerEntry& entry : kSamplers) {
    names += (names.empty() ? "" : "|") + std::string(entry.name);
    captions +=
        (captions.empty() ? "" : ", ") + std::string(entry.name) + " " + std::string(entry.caption);
  }
  addSetting(command, options, "--sampler", "sampler", names,
             "How the field is read between nodes: " + captions + ".",
             std::string(name(Scene{}.sampler)));
}

void addHapticOptions(Command& command, SceneOptions& options) {
  const HapticProperties usual;
  addSetting(command, options, "--stiffness", "stiffness", "K", "Spring [N/m].",
             formatNumber(usual.stiffness));
  addSetting(command, options, "--damping", "damping", "B", "Damper along the normal [N s/m].", "");
  addSetting(command, options, "--friction-static", "friction.static", "MU",
             "Coefficient that holds the tip at rest.", "");
  addSetting(command, options, "--friction-dynamic", "friction.dynamic", "MU",
             "Coefficient while the tip slips; not above the static one.", "");
  addSetting(command, options, "--friction-depth", "friction.depth", "GAIN",
             "Growth of friction with depth, for each mm.", "");
  addSetting(command, options, "--friction-slip", "friction.slip", "paper|displacement",
             "Direction of slip: towards the tip, or against the contact point's own motion.",
             "paper");
  addSetting(command, options, "--damping-cutoff", "damping.cutoff", "HZ",
             "Low-pass of the velocity that the damper sees.", "");
  addSetting(command, options, "--offset", "offset", "LENGTH",
             "Offset surface [m]: contact begins this far from the model.", "");
  addSetting(command, options, "--magnet-range", "magnet.range", "LENGTH",
             "Magnetic surface: the tip is pulled from this far [m].", "");
  addSetting(command, options, "--magnet-strength", "magnet.strength", "K",
             "Pull of the magnet for each metre of distance [N/m].", "");
  addSetting(command, options, "--magnet-fades", "magnet.fades", "on|off",
             "The pull falls to zero over the last quarter of its range.", "off");
  addSetting(command, options, "--contact", "contact", "proxy|ray",
             "proxy: the nearest point that the tip's proxy reaches over the surface; ray: the "
             "paper's, from the tip alone.",
             "proxy");
  addSetting(command, options, "--tip-radius", "tip.radius", "LENGTH",
             "Radius of the tip [m]; its centre feels the surface that far out.", "");
  addSetting(command, options, "--force-limit", "force.limit", "N", "Largest force [N].",
             formatNumber(usual.force_limit));
}

void applySettings(Scene& scene, const Settings& settings) {
  setValues(scene, settings);
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

OpenedScene openedWith(const std::filesystem::path& path, const SceneOptions& options,
                       Console& console) {
  OpenOptions open = options.open;
  open.tip_radius_chosen = setsTipRadius(options.settings);
  OpenedScene opened = openScene(path, open);
  for (const std::string& warning : opened.warnings) console.warn(warning);
  applySettings(opened.scene, options.settings);
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

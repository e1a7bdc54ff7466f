#include <algorithm>
#include <optional>

#include "app/cli/commands.h"
#include "app/cli/pose_file.h"
#include "app/cli/reports.h"
#include "app/cli/scene_options.h"
#include "core/error.h"
#include "core/numbers.h"
#include "workspace/workspace.h"

namespace patina::cli {

namespace {

struct SceneCommandOptions {
  std::filesystem::path workspace;
  OpenOptions open;
  std::vector<std::string> added, moved, removed;
  Settings settings;
};

// "MESH" or "MESH@POSE.txt"; a file whose own name has an '@' wins.
SceneObject readObject(const std::string& text, const OpenOptions& open, Console& console) {
  std::string mesh = text, pose;
  if (const std::size_t at = text.rfind('@');
      at != std::string::npos && !std::filesystem::exists(text)) {
    mesh = text.substr(0, at);
    pose = text.substr(at + 1);
  }
  if (std::filesystem::is_directory(mesh))
    throw Error("--add: " + mesh + " is a folder; add a mesh or a volume");
  OpenedScene opened = openScene(mesh, open);
  for (const std::string& warning : opened.warnings) console.warn(warning);
  SceneObject object = opened.scene.objects.front();
  if (!pose.empty()) object.world_from_object = readPose(pose);
  return object;
}

std::string namesOf(const Scene& scene) {
  std::string names;
  for (const SceneObject& object : scene.objects)
    names += (names.empty() ? "" : ", ") + object.name;
  return names.empty() ? "none" : names;
}

void removeObject(Scene& scene, const std::string& name) {
  const std::string known = namesOf(scene);
  if (!std::erase_if(scene.objects, [&](const SceneObject& object) { return object.name == name; }))
    throw Error("--remove: no object '" + name + "' in the scene; there is " + known);
}

// "NAME@POSE.txt"; a name has no '@'.
void moveObject(Scene& scene, const std::string& text) {
  const std::size_t at = text.find('@');
  if (at == std::string::npos || at == 0 || at + 1 == text.size())
    throw Error("--move: '" + text + "' is not NAME@POSE.txt");
  const std::string name = text.substr(0, at);
  for (SceneObject& object : scene.objects) {
    if (object.name != name) continue;
    object.world_from_object = readPose(text.substr(at + 1));
    return;
  }
  throw Error("--move: no object '" + name + "' in the scene; there is " + namesOf(scene));
}

// The same file may be added twice: cup, cup-2, cup-3.
void addObject(Scene& scene, SceneObject object) {
  const std::string base = object.name;
  const auto taken = [&] {
    return std::any_of(scene.objects.begin(), scene.objects.end(),
                       [&](const SceneObject& other) { return other.name == object.name; });
  };
  for (int number = 2; taken(); ++number) object.name = base + "-" + std::to_string(number);
  scene.objects.push_back(std::move(object));
}

Json poseJson(const Pose& pose) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) {
    Json numbers = Json::array();
    for (int column = 0; column < 4; ++column) numbers.push(pose.matrix()(row, column));
    rows.push(std::move(numbers));
  }
  return rows;
}

int runScene(const SceneCommandOptions& options, Console& console) {
  const std::filesystem::path& folder = options.workspace;
  const bool old = std::filesystem::exists(folder) && isWorkspace(folder);
  if (!old && std::filesystem::exists(folder) &&
      !(std::filesystem::is_directory(folder) && std::filesystem::is_empty(folder)))
    throw FileError(folder.string(), 0, "exists and is not a workspace; choose another folder");
  Scene scene = old ? loadWorkspace(folder) : Scene{};
  for (const std::string& name : options.removed) removeObject(scene, name);
  for (const std::string& text : options.moved) moveObject(scene, text);
  OpenOptions open = options.open;
  open.tip_radius_chosen =
      scene.haptics.tip_radius.value_or(0.0) > 0 || setsTipRadius(options.settings);
  for (const std::string& text : options.added) addObject(scene, readObject(text, open, console));
  applySettings(scene, options.settings);
  validate(scene);
  console.progress().throwIfCancelled();
  const bool changed = !options.added.empty() || !options.moved.empty() ||
                       !options.removed.empty() || !options.settings.empty();
  if (changed || !old) saveWorkspace(scene, folder);

  Json objects = Json::array();
  TextRows rows;
  for (const SceneObject& object : scene.objects) {
    Json entry = Json::object();
    entry.set("name", object.name);
    entry.set("triangles", object.mesh->triangles.size());
    entry.set("world_from_object", poseJson(object.world_from_object));
    objects.push(entry);
    rows.emplace_back("object", object.name + ", " + formatCount(object.mesh->triangles.size()) +
                                    " triangles");
  }
  for (const auto& [key, value] : values(scene)) rows.emplace_back(key, withUnit(key, value));
  Json json = Json::object();
  json.set("workspace", folder.string());
  json.set("saved", changed || !old);
  json.set("objects", objects);
  json.set("values", valuesJson(scene));
  console.report(json, aligned(rows));
  return kDone;
}

} // namespace

Command sceneCommand() {
  auto options = std::make_shared<SceneCommandOptions>();
  Command command;
  command.name = "scene";
  command.summary = "make or change a workspace";
  command.description =
      "A workspace is a folder that holds meshes, where they are, and how they feel; several are "
      "felt "
      "as one surface, their union. Without --add, --move, --remove and --set an existing one is "
      "only listed. Removals come first, then moves, then additions, then settings; an error "
      "leaves "
      "the folder as it was. A mesh added again gets a name of its own: cup, cup-2. Where objects "
      "overlap deeply, merge.redistance=on measures depths to the union's own surface. Keys: "
      "stiffness [N/m], damping [N s/m], "
      "damping.cutoff [Hz], friction.static, friction.dynamic, friction.depth, friction.slip, "
      "offset [m], magnet.range [m], magnet.strength [N/m], magnet.fades (on or off), contact (ray "
      "or potential), history (on "
      "or off), tip.radius [m], force.limit [N], resolution, voxel [m], band [voxels], sampler, "
      "merge.redistance (on or off), stabiliser (auto, none, coupling, passivity), device.mass "
      "[kg], device.damping [N s/m], device.coulomb [N], device.encoder [m], device.rate [Hz], "
      "device.delay [samples], device. The value none makes a feature absent.\n"
      "A pose is a text file of 4 x 4 numbers, row by row: world from object, in metres.\n"
      "JSON: workspace, saved, objects (name, triangles, world_from_object), values.";
  command.examples = {"patina scene -o cup --add cup.ply --unit cm --set stiffness=800",
                      "patina scene -o cup --add spoon.ply@spoon.txt --move cup@aside.txt",
                      "patina scene -o cup --set friction.static=0.5 --set friction.dynamic=0.3"};
  command.output("WORKSPACE", "The folder.", options->workspace);
  command.arguments.push_back({"--add", "MESH[@POSE.txt]",
                               "Put a mesh into the scene, where the pose says.", "", false, true,
                               [options](const auto& text) { options->added.push_back(text); }});
  command.arguments.push_back({"--move", "NAME@POSE.txt", "Put an object elsewhere.", "", false,
                               true,
                               [options](const auto& text) { options->moved.push_back(text); }});
  command.arguments.push_back({"--remove", "NAME", "Take an object out.", "", false, true,
                               [options](const auto& text) { options->removed.push_back(text); }});
  command.arguments.push_back({"--set", "KEY=VALUE", "Change a value.", "", false, true,
                               [options](const std::string& text) {
                                 const std::size_t equals = text.find('=');
                                 if (equals == std::string::npos || equals == 0)
                                   throw Error("'" + text + "' is not KEY=VALUE");
                                 options->settings.emplace_back(text.substr(0, equals),
                                                                text.substr(equals + 1));
                               }});
  addOpenOptions(command, options->open);
  command.run = [options](Console& console) { return runScene(*options, console); };
  return command;
}

} // namespace patina::cli

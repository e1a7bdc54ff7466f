#include <optional>
#include <sstream>

#include "app/cli/commands.h"
#include "app/cli/reports.h"
#include "app/cli/scene_options.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "workspace/workspace.h"

namespace patina::cli {

namespace {

struct SceneCommandOptions {
  std::filesystem::path workspace;
  OpenOptions open;
  std::vector<std::string> added, removed;
  Settings settings;
};

// 4 x 4, row-major, '#' starts a comment.
Pose readPose(const std::filesystem::path& path) {
  std::istringstream text(readFile(path));
  std::vector<double> values;
  std::size_t line_number = 0;
  for (std::string line; std::getline(text, line);) {
    ++line_number;
    std::istringstream words(line.substr(0, line.find('#')));
    for (std::string word; words >> word;) {
      const std::optional<double> value = parseNumber(word);
      if (!value) throw FileError(path.string(), line_number, "'" + word + "' is not a number");
      values.push_back(*value);
    }
  }
  if (values.size() != 16)
    throw FileError(path.string(), 0,
                    "a pose has 4 x 4 numbers, not " + std::to_string(values.size()));
  Pose pose;
  for (int i = 0; i < 16; ++i) pose.matrix()(i / 4, i % 4) = values[static_cast<std::size_t>(i)];
  const Eigen::Matrix3d rotation = pose.linear();
  const bool rigid =
      pose.matrix().allFinite() && (rotation * rotation.transpose()).isIdentity(1e-6) &&
      rotation.determinant() > 0 && pose.matrix().row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1));
  if (!rigid) throw FileError(path.string(), 0, "not a rotation and a translation");
  return pose;
}

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

void removeObject(Scene& scene, const std::string& name) {
  std::string known;
  for (const SceneObject& object : scene.objects)
    known += (known.empty() ? "" : ", ") + object.name;
  if (!std::erase_if(scene.objects, [&](const SceneObject& object) { return object.name == name; }))
    throw Error("--remove: no object '" + name + "' in the scene; there is " +
                (known.empty() ? "none" : known));
}

int runScene(const SceneCommandOptions& options, Console& console) {
  const std::filesystem::path& folder = options.workspace;
  const bool old = std::filesystem::exists(folder) && isWorkspace(folder);
  if (!old && std::filesystem::exists(folder) &&
      !(std::filesystem::is_directory(folder) && std::filesystem::is_empty(folder)))
    throw FileError(folder.string(), 0, "exists and is not a workspace; choose another folder");
  Scene scene = old ? loadWorkspace(folder) : Scene{};
  for (const std::string& name : options.removed) removeObject(scene, name);
  for (const std::string& text : options.added) {
    if (!scene.objects.empty())
      throw Error("--add: the scene has '" + scene.objects.front().name +
                  "' already and this version feels one object; --remove it first");
    OpenOptions open = options.open;
    open.tip_radius_chosen =
        scene.haptics.tip_radius.value_or(0.0) > 0 || setsTipRadius(options.settings);
    scene.objects.push_back(readObject(text, open, console));
  }
  applySettings(scene, options.settings);
  validate(scene);
  console.progress().throwIfCancelled();
  const bool changed =
      !options.added.empty() || !options.removed.empty() || !options.settings.empty();
  if (changed || !old) saveWorkspace(scene, folder);

  Json objects = Json::array();
  TextRows rows;
  for (const SceneObject& object : scene.objects) {
    Json entry = Json::object();
    entry.set("name", object.name);
    entry.set("triangles", object.mesh->triangles.size());
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
      "A workspace is a folder that holds a mesh and how it feels. Without --add, --remove and "
      "--set an existing one is only listed. Removals come first, then additions, then settings; "
      "an error leaves the folder as it was. Keys: stiffness [N/m], damping [N s/m], "
      "friction.static, friction.dynamic, friction.depth, friction.slip, tip.radius [m], "
      "force.limit [N], resolution, voxel [m], band [voxels], sampler, device. The value none "
      "makes a feature absent.\n"
      "A pose is a text file of 4 x 4 numbers, row by row: world from object, in metres.\n"
      "JSON: workspace, saved, objects (name, triangles), values.";
  command.examples = {"patina scene -o cup --add cup.ply --unit cm --set stiffness=800",
                      "patina scene -o cup --set friction.static=0.5 --set friction.dynamic=0.3"};
  command.output("WORKSPACE", "The folder.", options->workspace);
  command.arguments.push_back(
      {"--add", "MESH[@POSE.txt]", "Put a mesh into the scene: one object in this version.", "",
       false, true, [options](const auto& text) { options->added.push_back(text); }});
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

#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_edits.h"
#include "app/cli/input/workspace_place.h"
#include "app/cli/output/reports.h"
#include "core/disk_error.h"
#include "core/numbers.h"
#include "core/output_target.h"
#include "geometry/io/pose_file.h"
#include "session/store/replay.h"
#include "session/store/workspace_link.h"
#include "workspace/workspace.h"

namespace patina::cli {

namespace {

struct SceneCommandOptions {
  std::filesystem::path workspace, recovered;
  OpenOptions open;
  SceneEdits edits;
};

const Keys kSceneKeys = {{"workspace", "", "workspace", "", Shown::never},
                         {"saved", "", "saved", "whether this command wrote it", Shown::never},
                         {"objects",
                          "",
                          "objects",
                          "",
                          Shown::never,
                          {{"name", "", ""}, {"triangles", "", ""}, {"world_from_object", "", ""}}},
                         {"scans", "", "scans", "", Shown::never, scanKeys()},
                         {"values", "", "values", "by their keys", Shown::never}};

int report(const std::filesystem::path& folder, const Scene& scene, bool saved, Console& console) {
  Report report(kSceneKeys);
  Json objects = Json::array();
  for (const SceneObject& object : scene.objects) {
    const std::size_t triangles = object.mesh->triangles.size();
    objects.push(Json::object()
                     .set("name", object.name)
                     .set("triangles", triangles)
                     .set("world_from_object", poseJson(object.world_from_object)));
    report.tell("object", object.name + ", " + formatCount(triangles) + " triangles" +
                              (object.paint ? ", painted" : ""));
  }
  report.set("workspace", folder.string()).set("saved", saved).set("objects", objects);
  tellScans(scene, report);
  tellValues(scene, report);
  return console.report(report);
}

std::pair<std::string, std::string> parseSetting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw Error("'" + text + "' is not KEY=VALUE");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

WorkspaceLink::Opened opened(const std::filesystem::path& folder, bool own, bool recover,
                             Console& console) {
  auto found = WorkspaceLink::open(folder, Replayer(), kHistoryBudget, own, recover);
  if (!own)
    for (const std::string& note : found.notes) console.warn(note);
  return found;
}

// Worked out before the journal is touched, so that what is refused leaves no trace.
Scene changed(const std::filesystem::path& folder, const SceneCommandOptions& options,
              Console& console) {
  const auto read = opened(folder, false, false, console);
  if (options.edits.empty()) return read.history->scene();
  Scene after = edited(read.history->scene(), options.edits, options.open, console);
  console.progress().throwIfCancelled();
  const auto own = opened(folder, true, false, console);
  EditHistory& history = *own.history;
  if (own.events != read.events)
    throw FileError(folder.string(), 0, "another program has just changed it; try again");
  const Edit edit = editOf(options.edits, read.history->scene(), after);
  history.append(edit, after, [&](const Edit& made, std::int64_t time) {
    own.link->recordEdit(made, history.undoable() + 1, time);
  });
  own.link->save(history);
  return after;
}

Scene created(const std::filesystem::path& folder, const SceneCommandOptions& options,
              Console& console) {
  requireWorkspacePlace(folder);
  Scene scene = edited(Scene{}, options.edits, options.open, console);
  console.progress().throwIfCancelled();
  saveWorkspace(scene, folder);
  if (scene.objects.empty())
    console.warn(folder.string() + ": made, with nothing in it; --add puts a mesh into it");
  return scene;
}

// With its history, or without where that cannot be read whole.
Scene recovered(const SceneCommandOptions& options, Console& console) {
  const std::filesystem::path from = inputPath(options.recovered), &to = options.workspace;
  if (!options.edits.empty()) throw Error("--recover: change the scene in a second call");
  if (!std::filesystem::is_directory(from)) throw FileError(from.string(), 0, "no such folder");
  if (!sameFolder(from, to) && pathExists(to) &&
      !(std::filesystem::is_directory(to) &&
        (std::filesystem::is_empty(to) || isUnfinishedWorkspace(to))))
    throw FileError(to.string(), 0, "exists; what is recovered goes into a new folder");
  const auto found = opened(from, false, true, console);
  try {
    WorkspaceLink::createOver(to, *found.history);
  } catch (const DiskError&) { // of the disk, not of what is damaged: the history is still there
    throw;
  } catch (const Error& error) {
    console.warn(std::string(error.what()) + ": recovered without its history");
    saveWorkspace(found.history->scene(), to);
  }
  return found.history->scene();
}

int runScene(const SceneCommandOptions& options, Console& console) {
  const std::filesystem::path& folder = options.workspace;
  if (!options.recovered.empty()) return report(folder, recovered(options, console), true, console);
  if (pathExists(folder) && isWorkspace(folder))
    return report(folder, changed(folder, options, console), !options.edits.empty(), console);
  return report(folder, created(folder, options, console), true, console);
}

} // namespace

Command sceneCommand() {
  auto options = std::make_shared<SceneCommandOptions>();
  SceneEdits& edits = options->edits;
  Command command{
      .name = "scene",
      .summary = "make or change a workspace",
      .description =
          "A workspace is a folder that holds meshes, where they are, what is painted on them, how "
          "they feel, and the history of all that; several meshes are felt as one surface, their "
          "union. Without --add, --move, --remove, --scan, --set and --image an existing one is "
          "only "
          "listed. Removals come first, then moves, additions, textures, settings and images; "
          "together they "
          "are one edit, which patina undo takes back, and an error leaves the folder as it was. A "
          "mesh added again gets a name of its own: cup, cup-2. Where objects overlap deeply, "
          "merge.redistance=on measures depths to the union's own surface.\n"
          "Keys: stiffness [N/m], damping [N s/m], damping.cutoff [Hz], friction.static, "
          "friction.dynamic, friction.depth, friction.slip, offset [m], magnet.range [m], "
          "magnet.strength [N/m], magnet.fades (on or off), texture.gain (Fourier textures as a "
          "layer beside the "
          "surface), contact (proxy or ray), tip.radius "
          "[m], force.limit [N], resolution, voxel [m], band [voxels], sampler, surface.sides "
          "(one, two or closed: of parts with a rim; auto or auto-two: the program decides which "
          "of them are closed), merge.redistance (on or off), relief.mode "
          "(pulled: read at the contact point; baked: moved into the field), relief.source "
          "(painted, or color: the grey value of the painted colour), relief.height [m] (of a "
          "relief of 1; below 0 engraves what was raised), relief.force and material.force "
          "(conservative: no closed path does work; literal: as in the papers), relief.smoothing "
          "[m] (deviation along the surface), paint.size (texels a side of the images that "
          "painting makes), stabiliser (auto, none, coupling, passivity), device.mass [kg], "
          "device.damping [N s/m], device.coulomb [N], device.encoder [m], device.rate [Hz], "
          "device.delay [samples], device. The value none makes a feature absent.\n"
          "A pose is a text file of 4 x 4 numbers, row by row: world from object, in metres. A "
          "picture is laid as colour unless it says relief (its grey is the relief, 0 to 1), "
          "through the mesh's own texture coordinates (mapped) or along an axis of the object, "
          "onto all of it.\n"
          "A scan is attached with its calibration, poses, path, heights and place on the mesh as "
          "they stand in its folder; its frames stay there, and the workspace knows by a digest "
          "whether they are still those. Attached again, after patina track say, it is renewed, "
          "and the history says by which step.\n"
          "--recover reads what it can of a damaged workspace, says what is lost, and writes the "
          "rest to the output, which may be the damaged folder itself only if it is named.",
      .examples = {"patina scene -o cup --add cup.ply --unit cm --set stiffness=800",
                   "patina scene -o cup --add spoon.ply@spoon.txt --move cup@aside.txt",
                   "patina scene -o cup --set friction.static=0.5 --set friction.dynamic=0.3",
                   "patina scene -o cup --image cup=weave.png,relief,z",
                   "patina scene -o cup --scan scans/rim", "patina scene -o mended --recover cup"},
      .keys = kSceneKeys,
      .arguments =
          {{"-o,--output", "WORKSPACE", "", "", "The folder.", into(options->workspace),
            Times::once, true}, // what it holds already is read
           {"--recover", "DAMAGED", "", "", "Read a damaged workspace as far as it can be read.",
            into(options->recovered)},
           {"--add", "MESH[@POSE.txt]", "", "", "Put a mesh into the scene, where the pose says.",
            into(edits.added, filesToAdd), Times::any},
           {"--move", "NAME@POSE.txt", "", "", "Put an object elsewhere.",
            into(edits.moved, fileToMoveBy), Times::any},
           {"--remove", "NAME", "", "", "Take an object out.", into(edits.removed), Times::any},
           {"--scan", "DIR[@NAME]", "", "", "Attach a scan folder, or renew the scan of its name.",
            into(edits.scans, folderOfScan), Times::any},
           {"--remove-scan", "NAME", "", "", "Take a scan out; its folder stays.",
            into(edits.unscans), Times::any},
           {"--set", "KEY=VALUE", "", "", "Change a value.",
            [&edits](const std::string& text) { edits.settings.push_back(parseSetting(text)); },
            Times::any},
           {"--image", "OBJECT=FILE[,color|relief][,mapped|x|y|z]", "", "",
            "Lay a picture onto an object.", into(edits.images, fileOfImage), Times::any}},
      .run = [options](Console& console) { return runScene(*options, console); }};
  addTextureOption(command, edits.textures);
  addOpenOptions(command, options->open);
  return command;
}

} // namespace patina::cli

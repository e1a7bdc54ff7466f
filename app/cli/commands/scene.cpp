#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "app/cli/commands/commands.h"
#include "app/cli/input/scene_options.h"
#include "app/cli/input/workspace_place.h"
#include "app/cli/output/reports.h"
#include "core/disk_error.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/output_target.h"
#include "geometry/io/pose_file.h"
#include "haptics/catalog/device_catalog.h"
#include "pictures/picture_file.h"
#include "scan/scan_files.h"
#include "scene/edit.h"
#include "session/edit/lay_picture.h"
#include "session/store/attach_scan.h"
#include "session/store/replay.h"
#include "session/store/workspace_storage.h"
#include "workspace/workspace.h"

namespace patina::cli {
namespace {

// Changes of one call of patina scene.
struct SceneEdits {
  std::vector<std::string> added;   // MESH[@POSE.txt]
  std::vector<std::string> moved;   // NAME@POSE.txt
  std::vector<std::string> removed; // NAME
  std::vector<std::string> images;  // OBJECT=FILE[,color|relief][,mapped|x|y|z]
  std::vector<std::string> scans;   // DIR[@NAME]
  std::vector<std::string> unscans; // NAME
  TextureTable textures{};
  Settings settings;

  bool empty() const {
    return added.empty() && moved.empty() && removed.empty() && images.empty() && scans.empty() &&
           unscans.empty() && textures.empty() && settings.empty();
  }
};

// "FILE" or "FILE@NAME"; a file with '@' in its name takes precedence.
struct FileAndName {
  std::string file;
  std::optional<std::string> name;
};
FileAndName fileAndName(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || std::filesystem::exists(text)) return {text, {}};
  return {text.substr(0, at), text.substr(at + 1)};
}

std::string namesOf(const Scene& scene) {
  std::string names;
  for (const SceneObject& object : scene.objects)
    names += (names.empty() ? "" : ", ") + object.name;
  return names.empty() ? "none" : names;
}

std::size_t indexOf(const Scene& scene, const std::string& name, const char* option) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (scene.objects[i].name == name) return i;
  throw Error(std::string(option) + ": no object '" + name + "' in the scene; there is " +
              namesOf(scene));
}

void removeObject(Scene& scene, const std::string& name) {
  const auto index = static_cast<std::ptrdiff_t>(indexOf(scene, name, "--remove"));
  scene.objects.erase(scene.objects.begin() + index);
}

// "NAME@POSE.txt"; a name has no '@'.
void moveObject(Scene& scene, const std::string& text) {
  const std::size_t at = text.find('@');
  if (at == std::string::npos || at == 0 || at + 1 == text.size())
    throw Error("--move: '" + text + "' is not NAME@POSE.txt");
  const std::size_t index = indexOf(scene, text.substr(0, at), "--move");
  scene.objects[index].world_from_object = readPose(text.substr(at + 1));
}

// Adds objects to a scene. A file that is added several times is read once, and its objects share
// the mesh: cup, cup-2, cup-3.
class ObjectAdder {
 public:
  ObjectAdder(Scene& scene, const OpenOptions& open, Console& console)
      : scene_(scene), open_(open), console_(console) {
    for (const SceneObject& object : scene.objects) names_.insert(object.name);
  }

  void add(const std::string& text) { // "MESH" or "MESH@POSE.txt"
    const auto [mesh, pose] = fileAndName(text);
    if (pose && pose->empty())
      throw Error("--add: '" + text + "' is not MESH@POSE.txt: no pose after the '@'");
    SceneObject object = read(mesh);
    if (pose) object.world_from_object = readPose(*pose);
    const std::string base = object.name;
    for (int& number = numbers_[base]; !names_.insert(object.name).second; ++number)
      object.name = base + "-" + std::to_string(number + 2);
    scene_.objects.push_back(std::move(object));
  }

 private:
  const SceneObject& read(const std::string& mesh) {
    if (std::filesystem::is_directory(mesh))
      throw Error("--add: " + mesh + " is a folder; add a mesh or a volume");
    const auto known = read_.find(mesh);
    if (known != read_.end()) return known->second;
    OpenedScene opened = openScene(mesh, open_);
    for (const std::string& warning : opened.warnings) console_.warn(warning);
    return read_.emplace(mesh, std::move(opened.scene.objects.front())).first->second;
  }

  Scene& scene_;
  const OpenOptions& open_;
  Console& console_;
  std::unordered_set<std::string> names_;
  std::unordered_map<std::string, int> numbers_;      // key: name of the first; numbers in use
  std::unordered_map<std::string, SceneObject> read_; // key: file
};

struct ImageEdit : PictureEdit {
  std::filesystem::path file;
};

bool setWord(ImageEdit& image, const std::string& word) {
  const std::pair<const char*, PictureTarget> targets[] = {{"color", PictureTarget::color},
                                                           {"relief", PictureTarget::relief}};
  const std::pair<const char*, Projection> projections[] = {{"mapped", Projection::mapped},
                                                            {"x", Projection::x},
                                                            {"y", Projection::y},
                                                            {"z", Projection::z}};
  for (const auto& [text, target] : targets)
    if (word == text) return image.target = target, true;
  for (const auto& [text, projection] : projections)
    if (word == text) return image.projection = projection, true;
  return false;
}

// Removes option words from the end, so that commas in the file name are kept.
std::string withoutWords(std::string file, ImageEdit& image) {
  std::vector<std::string> words;
  for (std::size_t comma = file.rfind(','); comma != std::string::npos; comma = file.rfind(',')) {
    ImageEdit trial = image;
    if (!setWord(trial, file.substr(comma + 1))) break;
    words.push_back(file.substr(comma + 1));
    file.resize(comma);
  }
  for (auto word = words.rbegin(); word != words.rend(); ++word) setWord(image, *word);
  return file;
}

ImageEdit imageOf(const Scene& scene, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw Error("--image: '" + text + "' is not OBJECT=FILE[,color|relief][,mapped|x|y|z]");
  ImageEdit image;
  image.object = indexOf(scene, text.substr(0, equals), "--image");
  image.projection = usualProjection(*scene.objects[image.object].mesh);
  image.file = withoutWords(text.substr(equals + 1), image);
  return image;
}

void layImages(Scene& scene, const std::vector<std::string>& texts, Console& console) {
  std::vector<ImageEdit> images;
  std::vector<Picture> pictures;
  for (const std::string& text : texts) {
    images.push_back(imageOf(scene, text));
    pictures.push_back(readPicture(images.back().file));
  }
  Scene bare = scene; // existing paint does not change the mapping of an image
  for (SceneObject& object : bare.objects) object.paint = nullptr;
  const auto compiled = compile(std::move(bare), console.progress());
  std::shared_ptr<const PaintSurface> surface;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const ImageEdit& image = images[i];
    console.progress().report(static_cast<double>(i) / static_cast<double>(images.size()),
                              "images");
    try {
      layPicture(scene, *compiled, image, pictures[i], surface, console.progress());
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      throw Error("--image " + texts[i] + ": " + error.what());
    }
  }
}

std::string nameOnly(const std::string& text) {
  return std::filesystem::path(text.substr(0, text.find('@'))).stem().string();
}

// "DIR" or "DIR@NAME".
SceneScan readScanOf(const std::string& text, Console& console) {
  const auto [folder, name] = fileAndName(text);
  if (name && name->empty())
    throw Error("--scan: '" + text + "' is not DIR@NAME: no name after the '@'");
  SceneScan scan = readScanFiles(folder, name ? *name : scanNameOf(folder));
  readScanFolder(folder, console.progress()); // throws for a folder that could not be opened again
  return scan;
}

// Keeps files of the scene's scan that the folder lacks but that still match its data, such as the
// pose on a mesh.
Scene withFolder(const Scene& scene, SceneScan scan, Console& console) {
  const SceneScan* known = findScan(scene, scan.name);
  if (known) {
    scan = mergedScan(*known, std::move(scan));
    if (const std::string lost = invalidatedFiles(*known, scan); !lost.empty())
      console.warn("scan " + scan.name + ": " + lost +
                   " of the workspace depended on replaced data and is removed");
  }
  return withScan(scene, std::move(scan));
}

// Files named by a text of these kinds: FilesIn of the option.
std::vector<std::filesystem::path> filesToAdd(const std::string& added) {
  const auto [mesh, pose] = fileAndName(added);
  std::vector<std::filesystem::path> files{mesh};
  if (pose) files.emplace_back(*pose);
  return files;
}

std::vector<std::filesystem::path> fileToMoveBy(const std::string& moved) {
  const std::size_t at = moved.find('@');
  if (at == std::string::npos) return {};
  return {moved.substr(at + 1)};
}

std::vector<std::filesystem::path> folderOfScan(const std::string& scan) {
  return {fileAndName(scan).file};
}

std::vector<std::filesystem::path> fileOfImage(const std::string& image) {
  ImageEdit unused;
  return {withoutWords(image.substr(image.find('=') + 1), unused)};
}

// Applies removals, then moves, additions, textures, settings, images. Throws Error; does not
// change `scene`.
Scene edited(const Scene& scene, const SceneEdits& edits, const OpenOptions& given,
             Console& console) {
  Scene after = scene;
  for (const std::string& name : edits.removed) removeObject(after, name);
  for (const std::string& text : edits.moved) moveObject(after, text);
  OpenOptions open = given;
  open.tip_radius_chosen =
      after.haptics.tip_radius.value_or(0.0) > 0 || setsTipRadius(edits.settings);
  open.paint_size = paintSizeOf(edits.settings, after.paint_size);
  ObjectAdder adder(after, open, console);
  for (const std::string& text : edits.added) adder.add(text);
  for (const std::string& name : edits.unscans) after = withoutScan(std::move(after), name);
  for (const std::string& text : edits.scans)
    after = withFolder(after, readScanOf(text, console), console);
  layTextures(after, edits.textures);
  applySettings(after, edits.settings);
  validate(after);
  (void)deviceNamed(after.device);
  if (!edits.images.empty()) layImages(after, edits.images, console);
  return after;
}

// Returns one journal edit for all changes; `after` is the result of edited() on `before`.
Edit editOf(const SceneEdits& edits, const Scene& before, const Scene& after) {
  const ValueEdit values{edits.settings};
  std::string what;
  const auto tell = [&](const std::string& text) { what += (what.empty() ? "" : ", ") + text; };
  for (const std::string& name : edits.removed) tell("remove " + name);
  for (const std::string& text : edits.moved) tell("move " + text.substr(0, text.find('@')));
  for (const std::string& text : edits.added) tell("add " + nameOnly(text));
  for (const std::string& name : edits.unscans) tell("remove scan " + name);
  for (const SceneScan& scan : after.scans)
    if (const std::string words = describeChange(findScan(before, scan.name), scan); !words.empty())
      tell(words);
  for (const auto& [number, texture] : edits.textures) tell("texture " + std::to_string(number));
  for (const std::string& text : edits.images) tell("image on " + text.substr(0, text.find('=')));
  if (what.empty()) return values;
  if (!edits.settings.empty()) tell(describe(values));
  return SceneEdit{what, std::make_shared<const Scene>(after)};
}

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

WorkspaceStorage::Opened opened(const std::filesystem::path& folder, bool own, bool recover,
                                Console& console) {
  auto found = WorkspaceStorage::open(folder, Replayer(), kHistoryBudget, own, recover);
  if (!own)
    for (const std::string& note : found.notes) console.warn(note);
  return found;
}

struct SceneResult {
  Scene scene;
  bool saved = true; // this command wrote it
  bool whole = true; // no file of a workspace was found damaged
};

// Computes the new scene before the journal is touched, so that a rejected change leaves no trace.
SceneResult changed(const std::filesystem::path& folder, const SceneCommandOptions& options,
                    Console& console) {
  const auto read = opened(folder, false, false, console);
  if (options.edits.empty() || isRepeated(folder, read.intents, console))
    return {read.history->scene(), false};
  Scene after = edited(read.history->scene(), options.edits, options.open, console);
  console.progress().throwIfCancelled();
  const auto own = opened(folder, true, false, console);
  EditHistory& history = *own.history;
  if (own.events != read.events)
    throw FileError(folder.string(), 0, "another program has just changed it; try again");
  const Edit edit = editOf(options.edits, read.history->scene(), after);
  own.storage->setIntent(console.intent);
  own.storage->hold(); // all files of the new scene come to the disk first
  history.append(edit, after, [&](const Edit& made, std::int64_t time) {
    own.storage->recordEdit(made, history.undoable() + 1, time);
  });
  console.commit([&] { own.storage->commit(); });
  saveJournaled(folder, console, [&] { own.storage->save(history); });
  return {std::move(after)};
}

SceneResult created(const std::filesystem::path& folder, const SceneCommandOptions& options,
                    Console& console) {
  requireWorkspacePlace(folder);
  Scene scene = edited(Scene{}, options.edits, options.open, console);
  console.progress().throwIfCancelled();
  saveWorkspace(scene, folder, console.intent);
  console.markCommitted();
  if (scene.objects.empty())
    console.warn(folder.string() + ": made, with nothing in it; --add puts a mesh into it");
  return {std::move(scene)};
}

// Recovers the scene with its history, or without it if the history is damaged.
SceneResult recovered(const SceneCommandOptions& options, Console& console) {
  const std::filesystem::path from = inputPath(options.recovered), &to = options.workspace;
  if (!options.edits.empty()) throw Error("--recover: change the scene in a second call");
  if (!std::filesystem::is_directory(from)) throw FileError(from.string(), 0, "no such folder");
  if (isRepeatedIn(to, console)) return {loadWorkspace(to), false};
  if (!sameFolder(from, to) && pathExists(to) &&
      !(std::filesystem::is_directory(to) &&
        (std::filesystem::is_empty(to) || isUnfinishedWorkspace(to))))
    throw FileError(to.string(), 0, "exists; choose a new folder for the recovered scene");
  const auto found = opened(from, false, true, console);
  bool whole = found.notes.empty();
  try {
    WorkspaceStorage::overwrite(to, *found.history, console.intent);
  } catch (const DiskError&) { // a disk error, not damage: the history is still there
    throw;
  } catch (const Error& error) {
    console.warn(std::string(error.what()) + ": recovered without its history");
    saveWorkspace(found.history->scene(), to, console.intent);
    whole = false;
  }
  console.markCommitted();
  return {found.history->scene(), true, whole};
}

int runScene(const SceneCommandOptions& options, Console& console) {
  const std::filesystem::path& folder = options.workspace;
  const SceneResult outcome = !options.recovered.empty() ? recovered(options, console)
                              : pathExists(folder) && isWorkspace(folder)
                                  ? changed(folder, options, console)
                                  : created(folder, options, console);
  const int code = report(folder, outcome.scene, outcome.saved, console);
  return outcome.whole ? code : 1;
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
          "only listed. Removals come first, then moves, additions, textures, settings and images; "
          "together they are one edit, which patina undo takes back, and an error leaves the "
          "folder as it was. A mesh added again gets a name of its own: cup, cup-2. Where objects "
          "overlap deeply, merge.redistance=on measures depths to the union's own surface.\n"
          "Keys: stiffness [N/m], damping [N s/m], damping.cutoff [Hz], friction.static, "
          "friction.dynamic, friction.depth, friction.slip, offset [m], magnet.range [m], "
          "magnet.strength [N/m], magnet.fades (on or off), texture.gain (Fourier textures as a "
          "layer beside the surface), contact (proxy or ray), tip.radius [m], force.limit [N], "
          "resolution, voxel [m], band [voxels], sampler, surface.sides (one, two or closed: of "
          "parts with a rim; auto or auto-two: the program decides which of them are closed), "
          "merge.redistance (on or off), relief.mode (pulled: read at the contact point; baked: "
          "moved into the field), relief.source (painted, or color: the grey value of the painted "
          "colour), relief.height [m] (of a relief of 1; below 0 engraves what was raised), "
          "relief.force and material.force (conservative: no closed path does work; literal: as in "
          "the papers), relief.smoothing [m] (deviation along the surface), paint.size (texels a "
          "side of the images that painting makes), stabiliser (auto, none, coupling, passivity), "
          "device.mass [kg], device.damping [N s/m], device.coulomb [N], device.encoder [m], "
          "device.rate [Hz], device.delay [samples], device, pins (NAME=X,Y,Z;...), slice, slice2 "
          "and slice3 (DIRECTION:POSITION), and how things are coloured, see patina render: "
          "colors." +
          joined(coloredThings(), ", colors.") +
          ". The value none makes a feature absent.\n"
          "A pose is a text file of 4 x 4 numbers, row by row: world from object, in metres. A "
          "picture is applied as colour, or with relief as height (grey, 0 to 1), through the "
          "mesh's own texture coordinates (mapped) or along an axis of the object, to the whole "
          "object.\n"
          "A scan is attached with the calibration, poses, path, heights and pose on the mesh in "
          "its folder; its frames stay there, and a digest in the workspace detects changes of "
          "them. Attached again, for example after patina track, it is updated, and the history "
          "names the step.\n"
          "--recover reads the intact parts of a damaged workspace, reports what is lost, and "
          "writes the rest to the output, which may be the damaged folder itself only if it is "
          "named; it exits with 1 if anything was damaged.",
      .examples = {"patina scene -o cup --add cup.ply --unit cm --set stiffness=800",
                   "patina scene -o cup --add spoon.ply@spoon.txt --move cup@aside.txt",
                   "patina scene -o cup --set friction.static=0.5 --set friction.dynamic=0.3",
                   "patina scene -o cup --image cup=weave.png,relief,z",
                   "patina scene -o cup --scan scans/rim",
                   "patina scene -o recovered --recover cup"},
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
            "Apply a picture to an object.", into(edits.images, fileOfImage), Times::any}},
      .run = [options](Console& console) { return runScene(*options, console); },
      .changes_workspace = true};
  addTextureOption(command, edits.textures);
  addOpenOptions(command, options->open);
  return command;
}

} // namespace patina::cli

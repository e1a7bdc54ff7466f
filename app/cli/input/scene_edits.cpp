#include "app/cli/input/scene_edits.h"

#include <algorithm>
#include <optional>

#include "authoring/images/lay_image.h"
#include "core/error.h"
#include "geometry/io/pose_file.h"
#include "haptics/devices/device_catalog.h"
#include "pictures/picture_file.h"
#include "session/store/attach_scan.h"
#include "session/store/replay.h"
#ifdef PATINA_HAS_ACQUISITION
#include "scan/scan_files.h"
#endif

namespace patina::cli {

namespace {

// "FILE" or "FILE@NAME"; a file whose own name has an '@' wins.
struct FileAndName {
  std::string file;
  std::optional<std::string> name;
};
FileAndName fileAndName(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || std::filesystem::exists(text)) return {text, {}};
  return {text.substr(0, at), text.substr(at + 1)};
}

// "MESH" or "MESH@POSE.txt".
SceneObject readObject(const std::string& text, const OpenOptions& open, Console& console) {
  const auto [mesh, pose] = fileAndName(text);
  if (pose && pose->empty())
    throw Error("--add: '" + text + "' is not MESH@POSE.txt: no pose after the '@'");
  if (std::filesystem::is_directory(mesh))
    throw Error("--add: " + mesh + " is a folder; add a mesh or a volume");
  OpenedScene opened = openScene(mesh, open);
  for (const std::string& warning : opened.warnings) console.warn(warning);
  SceneObject object = opened.scene.objects.front();
  if (pose) object.world_from_object = readPose(*pose);
  return object;
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

struct ImageEdit {
  std::size_t object = 0;
  std::filesystem::path file;
  PictureTarget target = PictureTarget::color;
  Projection projection = Projection::z;
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

// Takes off the words after the file's name, from the end, so that its own commas do no harm.
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
  const TriangleMesh& mesh = *scene.objects[image.object].mesh;
  if (mesh.corner_uvs.size() == mesh.triangles.size()) image.projection = Projection::mapped;
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
  Scene bare = scene; // what is painted already matters to what is felt, not to where an image lies
  for (SceneObject& object : bare.objects) object.paint = nullptr;
  const auto compiled = compile(std::move(bare), console.progress());
  std::shared_ptr<const PaintSurface> surface;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const ImageEdit& image = images[i];
    console.progress().report(static_cast<double>(i) / static_cast<double>(images.size()),
                              "images");
    surface = paintSurfaceOf(*compiled, scene, surface, true, console.progress());
    try {
      scene.objects[image.object].paint =
          laid(*surface, scene, image.object, pictures[i], image.projection, image.target);
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
  SceneScan scan = scanIn(folder, name ? *name : scanNameOf(folder));
#ifdef PATINA_HAS_ACQUISITION
  readScanFolder(folder, console.progress()); // refuses what could not be opened again
#else
  static_cast<void>(console);
#endif
  return scan;
}

// What the scene's scan has and the folder has not stays, where it follows from what the folder
// has: where it lies on a mesh, say.
Scene withFolder(const Scene& scene, SceneScan scan, Console& console) {
  const SceneScan* known = findScan(scene, scan.name);
  if (known) {
    scan = renewed(*known, std::move(scan));
    if (const std::string lost = filesLost(*known, scan); !lost.empty())
      console.warn("scan " + scan.name + ": " + lost +
                   " of the workspace's followed from what was replaced, and goes with it");
  }
  return withScan(scene, std::move(scan));
}

} // namespace

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

Scene edited(const Scene& scene, const SceneEdits& edits, const OpenOptions& given,
             Console& console) {
  Scene after = scene;
  for (const std::string& name : edits.removed) removeObject(after, name);
  for (const std::string& text : edits.moved) moveObject(after, text);
  OpenOptions open = given;
  open.tip_radius_chosen =
      after.haptics.tip_radius.value_or(0.0) > 0 || setsTipRadius(edits.settings);
  open.paint_size = paintSizeOf(edits.settings, after.paint_size);
  for (const std::string& text : edits.added) addObject(after, readObject(text, open, console));
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

Edit editOf(const SceneEdits& edits, const Scene& before, const Scene& after) {
  const ValueEdit values{edits.settings};
  std::string what;
  const auto tell = [&](const std::string& text) { what += (what.empty() ? "" : ", ") + text; };
  for (const std::string& name : edits.removed) tell("remove " + name);
  for (const std::string& text : edits.moved) tell("move " + text.substr(0, text.find('@')));
  for (const std::string& text : edits.added) tell("add " + nameOnly(text));
  for (const std::string& name : edits.unscans) tell("remove scan " + name);
  for (const SceneScan& scan : after.scans)
    if (const std::string words = wordsFor(findScan(before, scan.name), scan); !words.empty())
      tell(words);
  for (const auto& [number, texture] : edits.textures) tell("texture " + std::to_string(number));
  for (const std::string& text : edits.images) tell("image on " + text.substr(0, text.find('=')));
  if (what.empty()) return values;
  if (!edits.settings.empty()) tell(describe(values));
  return SceneEdit{what, std::make_shared<const Scene>(after)};
}

} // namespace patina::cli

#include "workspace/workspace.h"

#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "core/version.h"
#include "workspace/workspace_support.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

class BrokenWorkspace : public WorkspaceTest {
 protected:
  BrokenWorkspace() : json(folder / "workspace.json") {
    saveWorkspace(sceneWithObjects(0.05), folder);
  }
  std::string errorOfLoading() const {
    try {
      loadWorkspace(folder);
    } catch (const FileError& error) {
      EXPECT_TRUE(error.path().starts_with(folder.string())) << error.what();
      return error.what();
    }
    return "";
  }
  fs::path firstMesh() const { return fs::directory_iterator(folder / "meshes")->path(); }
  fs::path json;
};

TEST_F(WorkspaceTest, ReadsBackEveryValueOfAScene) {
  const Scene scene = sceneWithObjects(0.05);
  saveWorkspace(scene, folder);
  EXPECT_TRUE(isWorkspace(folder));
  EXPECT_TRUE(same(loadWorkspace(folder), scene));
}

// Old workspaces do not name it.
TEST_F(WorkspaceTest, NamesItsProgramAndOpensWithoutThatName) {
  const Scene scene = sceneWithObjects(0.05);
  saveWorkspace(scene, folder);
  const fs::path path = folder / "workspace.json";
  Json json = parseJson(readFile(path), path.string());
  EXPECT_EQ(json.at("program").dump(), programDescription().dump());
  Json older = Json::object();
  for (const auto& [key, value] : json.asObject())
    if (key != "program") older.set(key, value);
  writeFileAtomically(path, older.dump());
  EXPECT_TRUE(same(loadWorkspace(folder), scene));
}

// A program that is killed in its first save leaves an empty folder at least.
TEST_F(WorkspaceTest, EmptyFolderIsAnUnfinishedOneAndAForeignOneIsNot) {
  const auto place = folder;
  EXPECT_FALSE(isUnfinishedWorkspace(place));
  std::filesystem::create_directory(place);
  EXPECT_TRUE(isUnfinishedWorkspace(place));
  std::ofstream(place / "notes.txt") << "mine";
  EXPECT_FALSE(isUnfinishedWorkspace(place));
  EXPECT_FALSE(isUnfinishedWorkspace(place / "notes.txt"));
}

TEST_F(WorkspaceTest, ReadsBackAnEmptyScene) {
  saveWorkspace(Scene{}, folder);
  EXPECT_TRUE(same(loadWorkspace(folder), Scene{}));
}

TEST_F(WorkspaceTest, ReadsBackTextureCoordinates) {
  TriangleMesh mesh = box(Vec3(1, 1, 1));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    mesh.corner_uvs.push_back({Vec2(0.1 * double(t), 0), Vec2(1, 1.0 / 3), Vec2(0, 1)});
  Scene scene;
  scene.objects.push_back({"box", std::make_shared<const TriangleMesh>(mesh), Pose::Identity()});
  saveWorkspace(scene, folder);
  EXPECT_EQ(loadWorkspace(folder).objects[0].mesh->corner_uvs, mesh.corner_uvs);
}

TEST_F(WorkspaceTest, SecondSaveReplacesAndLeavesNoOldMesh) {
  saveWorkspace(sceneWithObjects(0.05), folder);
  saveWorkspace(sceneWithObjects(0.08), folder);
  EXPECT_TRUE(same(loadWorkspace(folder), sceneWithObjects(0.08)));
  EXPECT_EQ(filesIn("meshes"), 2u);
}

TEST_F(WorkspaceTest, KeepsAUsersFile) {
  saveWorkspace(sceneWithObjects(0.05), folder);
  writeFileAtomically(folder / "meshes" / "original.ply", "mine");
  saveWorkspace(sceneWithObjects(0.08), folder);
  EXPECT_EQ(readFile(folder / "meshes" / "original.ply"), "mine");
}

TEST_F(WorkspaceTest, SaveRewritesADamagedFile) {
  const Scene scene = paintedScene(0.05, 1, With::material);
  saveWorkspace(scene, folder);
  for (const char* part : {"meshes", "paint", "states"})
    for (const auto& item : fs::directory_iterator(folder / part)) {
      std::string bytes = readFile(item.path());
      bytes[bytes.size() / 2] ^= 1;
      writeFileAtomically(item.path(), bytes);
    }
  saveWorkspace(scene, folder);
  EXPECT_TRUE(same(openWorkspace(folder).scene, scene));
}

TEST_F(WorkspaceTest, WritesNothingThroughALink) {
  for (const char* part : {"meshes", "paint", "states"}) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    fs::create_directories(root / "theirs");
    fs::create_directory_symlink(root / "theirs", folder / part);
    EXPECT_TRUE(says(errorOf([&] { saveWorkspace(paintedScene(0.05, 1, With::material), folder); }),
                     "leaves the workspace's folder"));
    EXPECT_TRUE(fs::is_empty(root / "theirs")) << part;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << part;
  }
}

TEST_F(WorkspaceTest, MovesWithItsFolder) {
  saveWorkspace(sceneWithObjects(0.05), folder);
  fs::rename(folder, root / "elsewhere");
  EXPECT_TRUE(same(loadWorkspace(root / "elsewhere"), sceneWithObjects(0.05)));
}

TEST_F(WorkspaceTest, RefusesToSaveAnInvalidScene) {
  saveWorkspace(sceneWithObjects(0.05), folder);
  Scene broken = sceneWithObjects(0.08);
  broken.haptics.stiffness = -1;
  EXPECT_THROW(saveWorkspace(broken, folder), Error);
  EXPECT_TRUE(same(loadWorkspace(folder), sceneWithObjects(0.05)));
}

TEST_F(WorkspaceTest, RefusesOtherFoldersAndFiles) {
  EXPECT_FALSE(isWorkspace(root));
  EXPECT_FALSE(isWorkspace(root / "missing"));
  writeFileAtomically(root / "file", "x");
  EXPECT_FALSE(isWorkspace(root / "file"));
  EXPECT_THROW(saveWorkspace(Scene{}, root / "file"), FileError);
  EXPECT_THROW(loadWorkspace(root), FileError);
}

TEST_F(BrokenWorkspace, NamesAChangedMesh) {
  const fs::path mesh = firstMesh();
  std::string bytes = readFile(mesh);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  writeFileAtomically(mesh, bytes);
  EXPECT_NE(errorOfLoading().find(mesh.filename().string() + ": is not the file that was saved"),
            std::string::npos);
}

TEST_F(BrokenWorkspace, NamesAMissingMesh) {
  const fs::path mesh = firstMesh();
  fs::remove(mesh);
  EXPECT_NE(errorOfLoading().find(mesh.filename().string()), std::string::npos);
}

TEST_F(BrokenWorkspace, RefusesAnUnknownVersionWithoutOverwriting) {
  replaceIn(json, "\"version\": 3", "\"version\": 5");
  const std::string before = readFile(json);
  EXPECT_NE(errorOfLoading().find("version 5 is unknown"), std::string::npos);
  EXPECT_THROW(saveWorkspace(sceneWithObjects(0.08), folder), FileError);
  EXPECT_EQ(readFile(json), before);
}

TEST_F(BrokenWorkspace, RefusesPathsOutsideTheFolder) {
  const std::string good = readFile(json);
  writeFileAtomically(root / "outside.ply", readFile(firstMesh()));
  const std::string mesh = "meshes/" + firstMesh().filename().string();
  for (const std::string& path : {std::string("../outside.ply"), root.string() + "/outside.ply",
                                  std::string("meshes/../../outside.ply"), std::string()}) {
    writeFileAtomically(json, good);
    replaceIn(json, "\"" + mesh + "\"", "\"" + path + "\"");
    EXPECT_NE(errorOfLoading().find("leaves the workspace's folder"), std::string::npos) << path;
  }
}

TEST_F(BrokenWorkspace, RefusesALinkOutOfTheFolder) {
  const fs::path mesh = firstMesh();
  fs::rename(mesh, root / "outside.ply");
  fs::create_symlink(root / "outside.ply", mesh);
  EXPECT_NE(errorOfLoading().find("leaves the workspace's folder"), std::string::npos);
}

TEST_F(BrokenWorkspace, EveryTruncationIsAnError) {
  const std::string text = readFile(json);
  // No prefix without the last newline and brace is a whole file.
  for (std::size_t size = 0; size + 2 < text.size(); size += 7) {
    std::ofstream(json) << text.substr(0, size);
    EXPECT_NE(errorOfLoading(), "") << size;
  }
}

TEST_F(BrokenWorkspace, BadValuesAreNamed) {
  const std::string good = readFile(json);
  for (const auto& [from, to, says] : std::vector<std::array<std::string, 3>>{
           {"\"stiffness\": 50", "\"stiffness\": -5", "stiffness = -5"},
           {"\"stiffness\": 50", "\"stiffness\": [1]", "expected number, found array"},
           {"\"sampler\": \"high\"", "\"sampler\": \"best\"", "best"},
           {"\"name\": \"crate-1\"", "\"name\": \"ball\"", "used twice"},
           {"\"name\": \"crate-1\"", "\"name\": \"../x\"", "object name"},
           {"\"values\"", "\"value\"", "'values' is missing"},
           {"[0.0, 0.0, 0.0, 1.0]", "[0.0, 0.0, 1.0]", "4 numbers"},
           {"[0.0, 0.0, 0.0, 1.0]", "[0.0, 0.0, 0.5, 1.0]", "0 0 0 1"}}) {
    writeFileAtomically(json, good);
    replaceIn(json, from, to);
    EXPECT_NE(errorOfLoading().find(says), std::string::npos) << to << ": " << errorOfLoading();
  }
}

TEST_F(BrokenWorkspace, NamesTheRemedyOfACutManifest) {
  const std::string whole = readFile(json);
  writeFileAtomically(json, whole.substr(0, whole.size() / 2));
  const std::string said = errorOfLoading();
  EXPECT_TRUE(says(said, "workspace.json:")) << said;
  EXPECT_TRUE(says(said, ": JSON ends too early; restore it from a backup, or recover")) << said;
}

TEST_F(BrokenWorkspace, IsRepairedByASave) {
  writeFileAtomically(json, "{");
  saveWorkspace(sceneWithObjects(0.08), folder);
  EXPECT_TRUE(same(loadWorkspace(folder), sceneWithObjects(0.08)));
}

TEST_F(WorkspaceTest, NamesTheLineOfANulInAName) {
  saveWorkspace(sceneWithObjects(0.05), folder);
  const std::filesystem::path json = folder / "workspace.json";
  const std::string good = readFile(json);
  const std::size_t at = good.find("\"name\": \"") + 9;
  for (const char* nul : {"\\u0000", "a\\\\\\u0000b"}) {
    writeFileAtomically(json, good.substr(0, at) + nul + good.substr(at));
    const std::string line = std::to_string(std::count(good.begin(), good.begin() + at, '\n') + 1);
    EXPECT_TRUE(says(errorOf([&] { openWorkspace(folder); }), "workspace.json:" + line)) << nul;
    EXPECT_TRUE(says(errorOf([&] { openWorkspace(folder); }), "NUL")) << nul;
  }
  writeFileAtomically(json, good.substr(0, at) + "\\\\u0000" + good.substr(at));
  EXPECT_FALSE(says(errorOf([&] { openWorkspace(folder); }), "NUL"));
}

} // namespace
} // namespace patina

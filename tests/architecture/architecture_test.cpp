// Checks the architecture's rules on every source.
#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <sstream>

#include "architecture/include_rules.h"

namespace patina::architecture {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxLines = 700;

std::vector<std::string> forbidden(const std::string& path, const std::string& line) {
  return includeViolations({path, "// first\n" + line + "\n"});
}

TEST(Architecture, EveryIncludeFollowsThePlan) {
  const std::vector<SourceFile> files = filesUnder({"modules", "app"}, isCode);
  ASSERT_GT(files.size(), 50u);
  for (const SourceFile& file : files)
    for (const std::string& violation : includeViolations(file)) ADD_FAILURE() << violation;
}

// The code that judges contact must not share a mistake with the code under test.
TEST(Architecture, ContactOracleIncludesNoFieldAndNoStage) {
  int files = 0;
  for (const SourceFile& file : filesUnder({"app/studies/contact"}, isCode)) {
    if (file.path.find("/oracle.") == std::string::npos) continue;
    ++files;
    for (const char* room : {"field/", "haptics/"})
      EXPECT_EQ(file.text.find(std::string("#include \"") + room), std::string::npos)
          << file.path << " includes " << room;
  }
  EXPECT_EQ(files, 2);
}

// Tests the checker itself: each made-up edge must be found, each allowed one must pass.
TEST(Architecture, CheckerFindsForbiddenEdges) {
  for (const auto& [path, line] : std::vector<std::pair<std::string, std::string>>{
           {"modules/core/a.cpp", "#include \"geometry/mesh/triangle_mesh.h\""},
           {"modules/geometry/a.cpp", "#include \"field/surface/models.h\""},
           {"modules/field/a.h", "#include \"scene/scene.h\""},
           {"modules/scene/a.cpp", "#include \"haptics/law/snapshot.h\""},
           {"modules/haptics/a.cpp", "#include \"visualization/files/field_io.h\""},
           {"modules/visualization/a.cpp", "#include \"haptics/law/snapshot.h\""},
           {"modules/workspace/a.cpp", "#include \"visualization/files/field_io.h\""},
           {"modules/workspace/a.cpp", "#include \"usb/usb_bus.h\""},
           {"modules/haptics/a.cpp", "  #  include  \"session/open/session.h\""},
           {"modules/kitchen/a.cpp", "#include \"core/json.h\""},
           {"modules/field/a.cpp", "#include \"models.h\""},
           {"app/studies/a.cpp", "#include \"app/gui/window/main_window.h\""},
           {"modules/session/a.cpp", "#include \"app/gui/window/main_window.h\""},
           {"modules/scene/a.cpp", "#include \"session/open/session.h\""},
           {"app/studies/a.cpp", "#include \"app/cli/framework/command.h\""},
           {"app/gui/a.cpp", "#include \"app/cli/framework/command.h\""},
           {"modules/core/csv.cpp", "#include <nlohmann/json.hpp>"},
           {"modules/core/json.h", "#include <nlohmann/json.hpp>"},
           {"modules/geometry/mesh/adjacency.h",
            "#include <OpenMesh/Core/Mesh/TriConnectivity.hh>"},
           {"modules/field/a.cpp", "#include <OpenMesh/Core/Mesh/TriConnectivity.hh>"},
           {"modules/field/a.h", "#include <tbb/parallel_for.h>"},
           {"modules/acquisition/registration/a.cpp", "#include <ceres/ceres.h>"},
           {"modules/acquisition/solver/a.h", "#include <ceres/ceres.h>"},
           {"modules/haptics/a.cpp", "#include <tbb/parallel_for.h>"},
           {"modules/haptics/a.cpp", "#include <vtkPolyData.h>"},
           {"modules/visualization/a.cpp", "#include <QWidget>"},
           {"modules/visualization/a.cpp", "#include <QVTKOpenGLNativeWidget.h>"},
           {"modules/session/a.cpp", "#include <QString>"},
           {"app/gui/a.cpp", "#include <nlohmann/json.hpp>"},
           {"app/gui/a.cpp", "#include \"acquisition/registration/joint_fit.h\""},
           {"app/cli/a.cpp", "#include \"acquisition/calibration/pivot.h\""},
           {"app/gui/a.cpp", "#include \"acquisition/recording/recorder.h\""},
           {"app/cli/a.cpp", "#include \"acquisition/simulation/simulated_scan.h\""},
           {"app/cli/a.h", "#include <libusb.h>"},
           {"modules/core/sha256.h", "#include <openssl/evp.h>"},
           {"modules/haptics/a.cpp", "#include <libusb.h>"},
           {"modules/field/a.cpp", "#include <openvdb/openvdb.h>"},
           {"modules/core/a.cpp", "#include <gtest/gtest.h>"}}) {
    ASSERT_EQ(forbidden(path, line).size(), 1u) << path << " " << line;
    EXPECT_TRUE(forbidden(path, line)[0].starts_with(path + ":2: ")) << forbidden(path, line)[0];
  }
}

TEST(Architecture, CheckerAllowsPlannedEdges) {
  for (const auto& [path, line] : std::vector<std::pair<std::string, std::string>>{
           {"modules/scene/a.h", "#include \"field/store/field_grid.h\""},
           {"modules/haptics/a.cpp", "#include \"usb/usb_bus.h\""},
           {"modules/core/json.cpp", "#include <nlohmann/json.hpp>"},
           {"modules/geometry/a.cpp", "#include <OpenMesh/Core/Mesh/TriConnectivity.hh>"},
           {"modules/field/a.cpp", "#include <tbb/parallel_for.h>"},
           {"modules/acquisition/solver/a.cpp", "#include <ceres/ceres.h>"},
           {"modules/visualization/a.h", "#include <vtkSmartPointer.h>"},
           {"modules/haptics/a.cpp", "#include <sys/mman.h>"},
           {"modules/core/a.h", "#include <vector>"},
           {"modules/core/a.h", "#include <Eigen/Core>"},
           {"app/gui/a.h", "#include <QWidget>"},
           {"app/studies/a.cpp", "#include \"acquisition/registration/joint_fit.h\""},
           {"app/cli/a.cpp", "#include \"acquisition/files/scan_tables.h\""},
           {"app/gui/a.h", "#include \"acquisition/values/scan_samples.h\""},
           {"app/cli/a.cpp", "#include \"session/open/session.h\""}})
    EXPECT_TRUE(forbidden(path, line).empty()) << forbidden(path, line)[0];
}

TEST(Architecture, NoFileIsTooLongToRead) {
  for (const SourceFile& file : filesUnder({"app", "modules", "tests"}, isCode)) {
    const auto lines =
        static_cast<std::size_t>(std::count(file.text.begin(), file.text.end(), '\n'));
    EXPECT_LE(lines, kMaxLines) << file.path;
  }
}

// The linker merges two types of one name, member functions included, without a warning.
TEST(Architecture, HeadersDefineEachTypeNameOnce) {
  std::map<std::string, std::string> first;
  for (const SourceFile& file : filesUnder({"modules", "app"}, isCode)) {
    if (!file.path.ends_with(".h")) continue;
    std::istringstream lines(file.text);
    std::string space;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string kind, name;
      words >> kind >> name;
      if (kind == "namespace") space = name;
      if (name == "class" || name.starts_with("alignas")) words >> name;
      const bool defines = (kind == "struct" || kind == "class" || kind == "enum") &&
                           line[0] != ' ' && std::isalpha(name[0]) &&
                           line.find('{') != std::string::npos &&
                           name.find("::") == std::string::npos;
      if (!defines) continue;
      const auto [known, is_new] = first.emplace(space + "::" + name, file.path);
      EXPECT_TRUE(is_new || known->second == file.path)
          << known->first << " is in " << known->second << " and in " << file.path;
    }
  }
  EXPECT_GT(first.size(), 300u);
}

TEST(Architecture, EveryModuleHeaderBeginsWithItsIdea) {
  for (const SourceFile& file : filesUnder({"modules"}, isCode)) {
    if (file.path.ends_with(".h")) {
      EXPECT_TRUE(file.text.starts_with("// ")) << file.path;
      EXPECT_NE(file.text.find("#pragma once"), std::string::npos) << file.path;
    }
  }
}

// Each Eigen decomposition is compiled again in every file that uses it.
TEST(Architecture, MatricesAreDecomposedInOnePlace) {
  for (const SourceFile& file : filesUnder({"app", "modules"}, isCode)) {
    if (file.path.starts_with("modules/core/decompose.")) continue;
    for (const char* name :
         {"EigenSolver", "LDLT<", "LLT<", "SVD<", "QR<", ".ldlt(", ".llt(", ".jacobiSvd(",
          ".bdcSvd(", "PivLu(", "ouseholderQr(", ".eigenvalues(", "FromTwoVectors"})
      EXPECT_EQ(file.text.find(name), std::string::npos)
          << file.path << " names " << name << ": use core/decompose.h";
  }
}

TEST(Architecture, TopLevelHasOnlyListedEntries) {
  const std::set<std::string> allowed{"CMakeLists.txt",
                                      "README.md",
                                      "LICENSE",
                                      "CITATION.cff",
                                      "CHANGELOG.md",
                                      "SECURITY.md",
                                      "app",
                                      "modules",
                                      "data",
                                      "tests",
                                      "docs",
                                      ".ci",
                                      ".reuse",
                                      ".clang-format",
                                      ".clang-tidy",
                                      ".gitignore",
                                      ".gitattributes",
                                      ".git_archival.txt"};
  // Entries that git ignores: see .gitignore.
  const std::set<std::string> ignored{".git", "out", ".cache", "compile_commands.json"};
  std::set<std::string> found;
  for (const fs::directory_entry& item : fs::directory_iterator(kRoot)) {
    const std::string name = item.path().filename();
    if (!ignored.contains(name) && !name.starts_with("build")) found.insert(name);
  }
  EXPECT_EQ(found, allowed);
}

TEST(Architecture, FilesDoNotNameTheDevelopmentMachine) {
  // The words are split, so that this file passes too.
  const std::vector<std::string> places{std::string("/ho") + "me/", std::string("/wo") + "rk/",
                                        std::string("/fa") + "rm", std::string("/Us") + "ers/",
                                        std::string("/tmp/") + "b-"};
  const auto any = [](const fs::path& path) {
    return isCode(path) || path.extension() == ".md" || path.extension() == ".json";
  };
  for (const SourceFile& file : filesUnder({"app", "modules", "tests", "docs", "data"}, any))
    for (const std::string& place : places)
      EXPECT_EQ(file.text.find(place), std::string::npos) << file.path << " names " << place;
}

} // namespace
} // namespace patina::architecture

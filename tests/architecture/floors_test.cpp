#include "architecture/floors.h"

#include <stdexcept>

namespace patina::architecture {
namespace {

const char* const kTable = "# rooms\nmodules/a: low < mid other < high < .\n";

std::vector<std::string> judged(const std::string& path, const std::string& included) {
  return floorViolations(floorsIn(kTable), {path, "// idea\n#include \"" + included + "\"\n"});
}

TEST(Floors, EveryFolderIncludesOnlyFloorsBelowIt) {
  const Floors floors =
      floorsIn(filesUnder({"modules/floors.txt"}, [](const auto&) { return true; }).at(0).text);
  const std::vector<SourceFile> files = filesUnder({"modules", "app"}, isCode);
  ASSERT_GT(files.size(), 500u);
  for (const SourceFile& file : files)
    for (const std::string& violation : floorViolations(floors, file)) ADD_FAILURE() << violation;
}

TEST(Floors, TableNamesEveryFolderAndNoOther) {
  const Floors floors =
      floorsIn(filesUnder({"modules/floors.txt"}, [](const auto&) { return true; }).at(0).text);
  for (const auto& [room, folders] : floors)
    for (const auto& [folder, floor] : folders)
      EXPECT_TRUE(std::filesystem::is_directory(kRoot / room / folder)) << room << " " << folder;
  for (const SourceFile& file : filesUnder({"modules", "app"}, isCode)) {
    const std::filesystem::path folder = std::filesystem::path(file.path).parent_path();
    const std::string room = folder.parent_path().generic_string();
    if (!room.starts_with("modules/") && !room.starts_with("app/")) continue;
    EXPECT_TRUE(floors.contains(room) && floors.at(room).contains(folder.filename()))
        << file.path << ": modules/floors.txt does not name its folder";
  }
}

TEST(Floors, CheckerSeesIncludesOfTheSameFloorAndAbove) {
  EXPECT_EQ(judged("modules/a/low/x.cpp", "a/mid/y.h").size(), 1u);
  EXPECT_EQ(judged("modules/a/mid/x.cpp", "a/other/y.h").size(), 1u);
  EXPECT_EQ(judged("modules/a/high/x.cpp", "a/z.h").size(), 1u);
  EXPECT_EQ(judged("modules/a/unknown/x.cpp", "a/low/y.h").size(), 1u);
  EXPECT_EQ(judged("modules/b/one/x.cpp", "b/two/y.h").size(), 1u);
}

TEST(Floors, CheckerAllowsTheSameFolderFloorsBelowAndOtherRooms) {
  EXPECT_TRUE(judged("modules/a/mid/x.cpp", "a/mid/y.h").empty());
  EXPECT_TRUE(judged("modules/a/high/x.cpp", "a/low/y.h").empty());
  EXPECT_TRUE(judged("modules/a/x.cpp", "a/high/y.h").empty());
  EXPECT_TRUE(judged("modules/a/low/x.cpp", "core/y.h").empty());
}

TEST(Floors, TableRejectsAFolderThatStandsTwice) {
  EXPECT_THROW(floorsIn("modules/a: low < low\n"), std::runtime_error);
  EXPECT_THROW(floorsIn("no room\n"), std::runtime_error);
}

} // namespace
} // namespace patina::architecture

#include "architecture/plan_picture.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "architecture/project_files.h"

namespace patina::architecture {
namespace {

// PATINA_DRAW_PLAN=1 writes the picture in place of comparing it.
TEST(PlanPicture, InTheDocumentsIsDrawnFromTheCode) {
  const std::filesystem::path place = kRoot / "docs/images/plan.svg";
  if (std::getenv("PATINA_DRAW_PLAN")) std::ofstream(place) << planPicture();
  std::ostringstream found;
  found << std::ifstream(place).rdbuf();
  EXPECT_EQ(found.str(), planPicture())
      << "PATINA_DRAW_PLAN=1 architecture_tests --gtest_filter=PlanPicture.* draws it";
}

} // namespace
} // namespace patina::architecture

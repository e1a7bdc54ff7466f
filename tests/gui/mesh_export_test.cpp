// A mesh for other programs, from the window alone.
#include <QMenuBar>

#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"

namespace patina {
namespace {

using MeshExportTest = DrivenWindow;

TEST_F(MeshExportTest, IsWrittenInMillimetresByTwoClicks) {
  if (IsSkipped()) return;
  const TriangleMesh ball = icosphere(0.03, 6);
  ASSERT_TRUE(open(saved(ball, "ball.obj")));
  const auto path = folder_ / "out.stl";
  answerWithPath(path);
  chooseInMenu(QStringLiteral("&File"), QStringLiteral("Export &mesh…"));
  ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(path); }, 5000));
  const TriangleMesh read = readMesh(path);
  EXPECT_EQ(read.triangles.size(), ball.triangles.size());
  EXPECT_NEAR(bounds(read).sizes().x(), 1000 * bounds(ball).sizes().x(), 1e-3);
  EXPECT_FALSE(find<QAction>("export_relief")->isEnabled()) << "there is no relief";
}

} // namespace
} // namespace patina

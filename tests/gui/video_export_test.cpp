// The video of a recording, from the window alone.
#include <QMenuBar>

#include "core/file.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "visualization/export/export_files.h"

namespace patina {
namespace {

using VideoExportTest = DrivenWindow;

TEST_F(VideoExportTest, ReplaysARecordingByTwoClicks) {
  if (IsSkipped()) return;
  ASSERT_TRUE(open(saved(icosphere(0.03, 6), "ball.obj")));
  std::vector<ToolSample> samples(301);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].t = 1e-3 * static_cast<double>(i);
    samples[i].tip = samples[i].vcp = Vec3(0, -0.031 - 1e-5 * static_cast<double>(i), 0);
  }
  const auto recording = folder_ / "touch.csv", video = folder_ / "touch.ogv";
  writeToolSamplesCsv(recording, samples);
  answerWithPath(recording);
  chooseInMenu(QStringLiteral("&File"), QStringLiteral("Export &video…"));
  const auto asksForVideo = [] {
    const auto* dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
    return dialog != nullptr && dialog->acceptMode() == QFileDialog::AcceptSave;
  };
  ASSERT_TRUE(waitUntil(asksForVideo, 5000));
  answerWithPath(video);
  ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(video); }, 15000));
  EXPECT_EQ(readFile(video).substr(0, 4), "OggS");
  ASSERT_TRUE(waitUntil([&] { return view().frames().settled(); }, 5000));
  EXPECT_GT(surfaceShare(), 0.1) << "the window shows the scene as before";
  EXPECT_TRUE(find<QToolButton>("open_saved")->isVisible());
}

} // namespace
} // namespace patina

// Loading: the preview, the questions, and the state after a failure.
#include <fstream>

#include <QAbstractButton>
#include <QAction>
#include <QDialog>
#include <QMessageBox>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataWriter.h>

#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"
#include "workspace/workspace.h"

#include <sys/stat.h>

namespace patina {
namespace {

using Loading = WindowTest;

TEST_F(Loading, ShowsTheMeshBeforeTheFieldIsReady) {
  const auto path = saved(icosphere(0.03, 60), "sphere.obj");
  bool ready = false;
  double seen = -1;
  QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
  QObject::connect(find<SceneLoader>(), &SceneLoader::meshReady, window_.get(), [&] {
    EXPECT_FALSE(ready);
    seen = surfaceShare();
  });
  documents().open(requestFor(path));
  ASSERT_TRUE(waitUntil([&] { return ready; }));
  EXPECT_GT(seen, 0.1);
  EXPECT_GT(surfaceShare(), 0.1);
}

TEST_F(Loading, ShowsNoPanelsWithoutAScene) {
  EXPECT_FALSE(find<HapticsPanel>()->isVisible());
  EXPECT_FALSE(find<DisplayPanel>()->isVisible());
  EXPECT_FALSE(feel().servo().running());
  EXPECT_EQ(surfaceShare(), 0);
}

TEST_F(Loading, KeepsTheSceneIfALoadFails) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "sphere.obj")));
  const auto before = edits().scene();
  std::ofstream(folder_ / "bad.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999\n";
  QString message;
  QObject::connect(&documents(), &DocumentController::failed,
                   [&](const QString& m) { message = m; });
  documents().open(requestFor(folder_ / "bad.obj"));
  ASSERT_TRUE(waitUntil([&] { return !message.isEmpty(); }));
  wait(80);
  EXPECT_TRUE(message.contains(QStringLiteral("bad.obj:4"))) << message.toStdString();
  EXPECT_EQ(edits().scene(), before);
  EXPECT_TRUE(feel().servo().running());
  EXPECT_GT(surfaceShare(), 0.1);
  auto* box = find<QMessageBox>("problem");
  ASSERT_NE(box, nullptr);
  EXPECT_FALSE(box->informativeText().isEmpty());
  box->accept();
}

TEST_F(Loading, AsksAboutUnsavedEditsOnlyIfTheFileIsReadable) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "sphere.obj")));
  setRow("stiffness", 700);
  ASSERT_TRUE(waitUntil([&] { return edits().unsaved() && edits().status().done == 1; }));
  const auto before = edits().scene();
  const auto asked = [&] {
    auto* box = find<QMessageBox>("unsaved_edits");
    return box != nullptr && box->isVisible() ? box : nullptr;
  };
  std::ofstream(folder_ / "bad.obj") << "v 0 0 0\nv 1 0 x\n";
  saveWorkspace(Scene{}, folder_ / "empty");
  for (const char* bad : {"bad.obj", "empty"}) {
    const auto problem = [&]() -> QMessageBox* {
      for (auto* box : window_->findChildren<QMessageBox*>(QStringLiteral("problem")))
        if (box->isVisible()) return box;
      return nullptr;
    };
    documents().openFile(QString::fromStdString((folder_ / bad).string()));
    ASSERT_TRUE(waitUntil([&] { return problem() != nullptr || asked(); })) << bad;
    EXPECT_FALSE(asked()) << bad;
    ASSERT_NE(problem(), nullptr) << bad;
    problem()->accept();
    EXPECT_EQ(edits().scene(), before) << bad;
  }
  // A readable file brings up a question first, and Cancel keeps the scene.
  const auto good = QString::fromStdString(saved(icosphere(30, 12), "other.obj").string());
  for (const auto button : {QMessageBox::Cancel, QMessageBox::Discard}) {
    bool answered = false;
    QTimer answer;
    QObject::connect(&answer, &QTimer::timeout, [&] {
      if (QMessageBox* box = asked()) answered = true, box->button(button)->click();
    });
    answer.start(50);
    documents().openFile(good);
    ASSERT_TRUE(waitUntil([&] { return answered; }));
    if (button == QMessageBox::Cancel) {
      wait(500);
      EXPECT_EQ(edits().scene(), before);
    } else {
      EXPECT_TRUE(waitUntil([&] { return edits().scene() != before; }));
    }
    EXPECT_GT(surfaceShare(), 0.1);
  }
  EXPECT_TRUE(waitUntil([&] { return edits().scene()->scene.objects[0].name == "other"; }));
}

TEST_F(Loading, AsksForAMeshIfTheSceneHasNoObject) {
  Scene empty;
  saveWorkspace(empty, folder_ / "empty");
  QString message;
  QObject::connect(&documents(), &DocumentController::failed,
                   [&](const QString& m) { message = m; });
  documents().open(requestFor(folder_ / "empty"));
  ASSERT_TRUE(waitUntil([&] { return !message.isEmpty(); }));
  auto* box = find<QMessageBox>("problem");
  ASSERT_NE(box, nullptr);
  EXPECT_TRUE(box->informativeText().contains(QStringLiteral("File → Add object")))
      << message.toStdString() << '\n'
      << box->informativeText().toStdString();
  box->accept();
  // The advised action is enabled.
  for (const QAction* action : window_->findChildren<QAction*>())
    if (action->shortcut() == QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_O)) {
      EXPECT_TRUE(action->isEnabled());
      return;
    }
  FAIL() << "no action adds an object";
}

TEST_F(Loading, KeepsTheSceneOnCancel) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "sphere.obj")));
  const auto before = edits().scene();
  const auto path = saved(torus(0.035, 0.015, 500, 250), "torus.obj");
  bool cancelled = false;
  QObject::connect(&documents(), &DocumentController::cancelled, [&] { cancelled = true; });
  QObject::connect(find<SceneLoader>(), &SceneLoader::meshReady, window_.get(),
                   [&] { find<QAbstractButton>("cancel_load")->click(); });
  documents().open(requestFor(path));
  ASSERT_TRUE(waitUntil([&] { return cancelled; }));
  wait(80);
  EXPECT_EQ(edits().scene(), before);
  EXPECT_TRUE(feel().servo().running());
  EXPECT_FALSE(find<LoadBar>()->isVisible());
  EXPECT_GT(surfaceShare(), 0.1);
}

TEST_F(Loading, AsksForTheUnitIfTheSizeIsImplausible) {
  LoadRequest request;
  request.path = saved(icosphere(0.03, 12), "small.obj"); // 0.06 mm if read as millimetres
  documents().open(request);
  QDialog* dialog = nullptr;
  ASSERT_TRUE(waitUntil([&] {
    dialog = find<QDialog>("unit_dialog");
    return dialog != nullptr;
  }));
  EXPECT_EQ(edits().scene(), nullptr);
  bool ready = false;
  QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
  dialog->accept(); // metres: the size is then 60 mm
  ASSERT_TRUE(waitUntil([&] { return ready; }));
  EXPECT_NEAR(bounds(*edits().scene()->mesh).sizes().maxCoeff(), 0.06, 1e-4);
}

TEST_F(Loading, AsksForTheIsoValueOfAForeignVolume) {
  const vtkNew<vtkImageData> image;
  image->SetDimensions(40, 40, 40);
  image->SetOrigin(-20, -20, -20);
  const vtkNew<vtkFloatArray> values;
  values->SetName("density");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i) {
    double p[3];
    image->GetPoint(i, p);
    values->InsertNextValue(static_cast<float>(Vec3(p).norm() - 15));
  }
  image->GetPointData()->SetScalars(values);
  const vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName((folder_ / "v.vti").c_str());
  writer->Write();

  LoadRequest request;
  request.path = folder_ / "v.vti";
  documents().open(request);
  QDialog* dialog = nullptr;
  ASSERT_TRUE(waitUntil([&] {
    dialog = find<QDialog>("iso_dialog");
    return dialog != nullptr;
  }));
  bool ready = false;
  QObject::connect(window_.get(), &MainWindow::sceneReady, [&] { ready = true; });
  dialog->accept(); // a distance: the dialog offers 0
  ASSERT_TRUE(waitUntil([&] { return ready; }));
  EXPECT_NEAR(bounds(*edits().scene()->mesh).sizes().maxCoeff(), 0.030, 1e-4);
}

TEST_F(Loading, ReopensASavedWorkspaceWithItsValues) {
  ASSERT_TRUE(open(saved(icosphere(0.03, 12), "sphere.obj")));
  setRow("stiffness", 321);
  addProperty("Damping");
  setRow("damping", 2.5);
  wait(100);
  saving().saveTo(QString::fromStdString((folder_ / "ws").string()));
  ASSERT_TRUE(open(folder_ / "ws"));
  EXPECT_EQ(edits().scene()->scene.haptics.stiffness, 321);
  EXPECT_EQ(edits().scene()->scene.haptics.damping, 2.5);
  EXPECT_NE(find<QWidget>("damping"), nullptr);
}

TEST_F(Loading, RemembersOpenedFiles) {
  const auto path = saved(icosphere(0.03, 8), "remember.obj");
  ASSERT_TRUE(open(path));
  EXPECT_TRUE(find<RecentFiles>()->paths().contains(QString::fromStdString(path.string())));
}

TEST_F(Loading, CancelAndANewLoadDoNotWaitForAReader) {
  // A pipe without a writer: its reader cannot notice that it was cancelled.
  const auto pipe = folder_ / "endless.obj";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  bool cancelled = false;
  QObject::connect(&documents(), &DocumentController::cancelled, [&] { cancelled = true; });
  documents().open(requestFor(pipe));
  wait(100);
  find<SceneLoader>()->cancel();
  ASSERT_TRUE(waitUntil([&] { return cancelled; }, 5000));
  ASSERT_TRUE(open(saved(icosphere(0.03, 8), "sphere.obj")));
  EXPECT_FALSE(find<SceneLoader>()->isIdle());
  documents().open(requestFor(saved(torus(0.035, 0.015, 400, 200), "torus.obj")));
  // Closing opens no question and does not wait for the reader.
  EXPECT_TRUE(window_->close());
  EXPECT_FALSE(window_->isVisible());
  EXPECT_TRUE(window_->isReading());
  EXPECT_FALSE(feel().servo().running());
  { std::ofstream end(pipe); }
  EXPECT_TRUE(waitUntil([&] { return !window_->isReading(); }, 10000));
}

TEST_F(Loading, NewLoadReplacesARunningOne) {
  const auto slow = saved(torus(0.035, 0.015, 400, 200), "torus.obj");
  const auto quick = saved(icosphere(0.03, 8), "sphere.obj");
  documents().open(requestFor(slow));
  wait(20);
  ASSERT_TRUE(open(quick));
  EXPECT_EQ(edits().scene()->mesh->triangles.size(), 20U * 64U);
}

} // namespace
} // namespace patina

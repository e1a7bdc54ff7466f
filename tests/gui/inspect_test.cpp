// A person reads, colours and measures fields by pointer and keys, each job within six clicks.
#include <QAbstractItemView>
#include <QRegularExpression>
#include <QSpinBox>

#include <vtkCamera.h>
#include <vtkPropCollection.h>
#include <vtkRenderWindow.h>
#include <vtkRendererCollection.h>
#include <vtkTextActor.h>

#include "app/gui/panels/measure_panel.h"
#include "app/gui/toolkit/value_row.h"
#include "core/file.h"
#include "geometry/mesh/shapes.h"
#include "gui/driven_window.h"
#include "visualization/values/camera.h"

namespace patina {
namespace {

constexpr double kRadius = 0.03;

class Inspecting : public DrivenWindow {
 protected:
  void begin(const TriangleMesh& mesh) {
    ASSERT_TRUE(open(saved(mesh, "body.obj")));
    clickAction("desk_analyse");
    wait(100);
  }
  void keepPicture(const char* name) {
    const char* folder = std::getenv("PATINA_PICTURES");
    if (folder != nullptr)
      window_->grab().save(QString::fromUtf8(folder) + "/" + QString::fromUtf8(name) + ".png");
  }
  QPoint onScreen(const Vec3& point) {
    double x = point.x(), y = point.y(), z = point.z();
    view().view().renderer().WorldToView(x, y, z);
    return view().mapToGlobal(
        QPoint(qRound((x + 1) / 2 * view().width()), qRound((1 - y) / 2 * view().height())));
  }
  QString picked() { return find<QLabel>("picked")->text(); }
  // Numbers of the status line after a word: "distance" -> {1.5}.
  std::vector<double> numbersAfter(const QString& word) {
    const QRegularExpression pattern(word + QStringLiteral(R"(((?:,? ?-?\d+\.\d+)+))"));
    std::vector<double> numbers;
    for (const QString& text : pattern.match(picked()).captured(1).split(','))
      numbers.push_back(text.toDouble());
    return numbers;
  }
  // Chooses an entry of a combo box by two clicks: one opens it, one takes the entry.
  void chooseIn(const QString& name, int row) {
    auto* combo = find<QComboBox>(name);
    ASSERT_NE(combo, nullptr);
    click(*combo);
    QAbstractItemView* list = combo->view();
    ASSERT_TRUE(waitUntil([&] { return list->isVisible(); }, 2000));
    wait(200);
    pointAt(
        list->viewport()->mapToGlobal(list->visualRect(combo->model()->index(row, 0)).center()));
    press(), release();
    wait(100);
  }
};

TEST_F(Inspecting, ReadsTheValuesUnderThePointerOfBodySliceAndIsoSurface) {
  if (IsSkipped()) return;
  begin(icosphere(kRadius, 24));
  type('1'); // from +x
  wait(300);
  pointAt(inView({20, 10}));
  ASSERT_TRUE(waitUntil([&] { return picked().startsWith("Mesh"); }, 3000)) << "0 clicks";
  const auto at = numbersAfter("Mesh · "), way = numbersAfter("gradient ");
  ASSERT_EQ(at.size(), 3U) << picked().toStdString();
  ASSERT_EQ(way.size(), 3U);
  const Vec3 place(at[0], at[1], at[2]), gradient(way[0], way[1], way[2]);
  EXPECT_NEAR(place.norm(), 1e3 * kRadius, 0.05);
  EXPECT_GT(gradient.dot(place.normalized()), 0.995) << "radial";
  EXPECT_NEAR(numbersAfter("distance ").front(), 0, 0.05);
  EXPECT_TRUE(picked().contains("body")) << picked().toStdString();
  EXPECT_TRUE(picked().contains("500 N/m"));
  keepPicture("probe_mesh");

  view().setFocus();
  type('i');
  find<ValueRow>("iso_value")->findChild<QDoubleSpinBox*>()->setValue(1);
  pointAt(inView({20, 11}));
  ASSERT_TRUE(waitUntil([&] { return picked().startsWith("Iso-surface"); }, 3000))
      << picked().toStdString();
  EXPECT_NEAR(numbersAfter("distance ").front(), 1, 0.05);

  type('i');
  type('3'); // from +y, along which the slice lies
  type('s');
  wait(300);
  pointAt(onScreen(Vec3(0.0295, 0, 0)));
  ASSERT_TRUE(waitUntil([&] { return picked().startsWith("Slice"); }, 3000))
      << picked().toStdString();
  const auto cut = numbersAfter("Slice · ");
  const Vec3 on_slice(cut[0], cut[1], cut[2]);
  EXPECT_NEAR(numbersAfter("distance ").front(), on_slice.norm() - 1e3 * kRadius, 0.05);
  keepPicture("probe_slice");
  pointAt(inView({-400, -280}));
  EXPECT_TRUE(waitUntil([&] { return picked().isEmpty(); }, 3000));
}

TEST_F(Inspecting, SelectsTheRowOfWhatIsClickedAndShowsItsValuesAndColours) {
  if (IsSkipped()) return;
  begin(icosphere(kRadius, 24));
  const auto selected = [&] { return find<QListWidget>("layers")->currentItem(); };
  const auto title = [&] { return find<ColorPanel>()->title().toStdString(); };
  EXPECT_EQ(title(), "Colours: mesh");
  clickRow("slice"); // one click shows it, with its values
  EXPECT_EQ(selected(), rowOf("slice"));
  EXPECT_TRUE(find<ValueRow>("slice_position")->isVisible());
  EXPECT_EQ(title(), "Colours: slice");
  keepPicture("things_slice");
  clickRow("mesh", true);
  EXPECT_TRUE(isShown("mesh")) << "its name only selects it";
  EXPECT_FALSE(find<ValueRow>("slice_position")->isVisible());
  EXPECT_EQ(title(), "Colours: mesh");
  clickRow("clip", true);
  EXPECT_TRUE(find<QToolButton>("clip_x")->isVisible());
  EXPECT_FALSE(find<QToolButton>("clip_x")->isEnabled()) << "there is no clip plane yet";
  EXPECT_FALSE(find<ColorPanel>()->isVisible()) << "it has no colours";
  view().setFocus();
  type('a'); // navigate
  type('3'); // from +y
  wait(300);
  pointAt(onScreen(Vec3(0.0295, 0, 0)));
  press(), release();
  EXPECT_EQ(selected(), rowOf("slice"));
  type('s');
  wait(200);
  pointAt(inView({10, 10}));
  press(), release();
  EXPECT_EQ(selected(), rowOf("mesh"));
  drag(inView({0, 0}), inView({60, 20}));
  clickRow("scale", true);
  drag(inView({0, 0}), inView({-60, -20}));
  EXPECT_EQ(selected(), rowOf("scale")) << "a drag turns the camera and selects nothing";
}

TEST_F(Inspecting, SetsRangeAndMapOfTheSlice) {
  if (IsSkipped()) return;
  begin(icosphere(kRadius, 24));
  view().setFocus();
  type('s');
  wait(200);
  keepPicture("colors_standard");
  chooseIn("color_map", 1); // two clicks
  const auto scale = [&] { return scaleOf(edits().scene()->scene.colors, "slice"); };
  ASSERT_TRUE(waitUntil([&] { return edits().status().done == 1; }, 3000));
  ASSERT_EQ(scale().map, ColorMap::viridis);
  keepPicture("colors_viridis");
  // Yellow of viridis is nowhere in the standard map.
  const auto yellow = [](int r, int g, int b) { return r > 200 && g > 190 && b < 90; };
  EXPECT_GT(share(yellow), 4e-4);
  auto* low = find<QDoubleSpinBox>("range_low");
  click(*low); // one click, then keys
  type('a', kControl);
  type("-0.5");
  type(kEnter);
  ASSERT_TRUE(waitUntil([&] { return scale().range.has_value(); }, 3000));
  EXPECT_NEAR(scale().range->low, -5e-4, 1e-12);
  EXPECT_EQ(find<QComboBox>("color_range")->currentIndex(), 1) << "locked";
  EXPECT_TRUE(waitUntil(
      [&] { return std::abs(view().view().shownRange("slice")->low + 5e-4) < 1e-12; }, 3000));
  keepPicture("colors_range");
  ASSERT_TRUE(
      waitUntil([&] { return edits().status().done == 2; }, 3000)); // it is an edit once it rests
  view().setFocus();
  type('z', kControl);
  ASSERT_TRUE(waitUntil([&] { return !scale().range; }, 3000)) << "undone";
  EXPECT_TRUE(waitUntil([&] { return find<QDoubleSpinBox>("range_low")->value() < -3; }, 3000));
}

TEST_F(Inspecting, KeepsColoursThatAreEditedBeforeOlderEditsAreDone) {
  if (IsSkipped()) return;
  begin(icosphere(kRadius, 24));
  view().setFocus();
  type('s');
  auto* bands = find<QSpinBox>("color_bands");
  std::vector<int> seen;
  QTimer look;
  QObject::connect(&look, &QTimer::timeout, [&] { seen.push_back(bands->value()); });
  for (int count = 2; count <= 30; ++count) bands->setValue(count); // they outrun the edits
  look.start(0);
  ASSERT_TRUE(waitUntil([&] { return edits().status().done == 1; }, 5000));
  wait(200);
  for (const int count : seen) ASSERT_EQ(count, 30);
  EXPECT_EQ(scaleOf(edits().scene()->scene.colors, "slice").bands, 30);
}

TEST_F(Inspecting, DrawsTheGapOfTheFreeTipAndItsLength) {
  if (IsSkipped()) return;
  begin(icosphere(kRadius, 24));
  clickAction("desk_feel");
  clickAction("tool_feel"); // the free tip
  show(Layer::scale, false);
  // Length on the gap's label [mm]; absent: no label.
  const auto gap = [&]() -> std::optional<double> {
    vtkRendererCollection* renderers = view().renderWindow()->GetRenderers();
    for (int r = 0; r < renderers->GetNumberOfItems(); ++r) {
      auto* renderer = static_cast<vtkRenderer*>(renderers->GetItemAsObject(r));
      vtkPropCollection* props = renderer->GetViewProps();
      for (int i = 0; i < props->GetNumberOfItems(); ++i) {
        auto* text = vtkTextActor::SafeDownCast(props->GetItemAsObject(i));
        if (text == nullptr || !text->GetVisibility() || text->GetInput() == nullptr) continue;
        const QString words = QString::fromUtf8(text->GetInput()).trimmed();
        if (words.endsWith(" mm")) return words.chopped(3).toDouble();
      }
    }
    return std::nullopt;
  };
  const auto height = [&] { return 1e3 * (feel().sample().tip.norm() - kRadius); };
  ASSERT_GT(height(), 2);
  ASSERT_TRUE(waitUntil([&] { return gap().has_value(); }, 5000)) << "beyond the band";
  EXPECT_NEAR(*gap(), height(), 0.06);
  keepPicture("gap");
  while (height() > 1.2) wheelAt(inView({0, 0}), 1), wait(60);
  wait(150);
  ASSERT_TRUE(gap().has_value()) << "within the band";
  EXPECT_NEAR(*gap(), height(), 0.06);
  show(Layer::tip, false);
  wait(100);
  EXPECT_FALSE(gap()) << "it belongs to the tool";
  show(Layer::tip, true);
  for (int i = 0; i < 20 && !feel().sample().contact; ++i) wheelAt(inView({0, 0}), 1), wait(60);
  ASSERT_TRUE(feel().sample().contact);
  EXPECT_TRUE(waitUntil([&] { return !gap(); }, 3000));
  clickAction("tool_press");
  wait(300);
  EXPECT_FALSE(gap()) << "this tool places the tip itself";
}

TEST_F(Inspecting, MeasuresTheSideOfABoxByThreeClicks) {
  if (IsSkipped()) return;
  begin(box(Vec3::Constant(0.1)));
  clickAction("tool_measure"); // one click
  // Not quite at the corners: a click near a vertex means the vertex.
  for (const Vec3& corner : {Vec3(0.05, -0.05, 0.05), Vec3(0.05, 0.05, 0.05)}) {
    pointAt(onScreen(corner) + QPoint(2, 3));
    press(), release(); // two more
    wait(50);
  }
  auto* list = find<QListWidget>("measurements");
  ASSERT_TRUE(waitUntil([&] { return list->count() == 2; }, 3000));
  const QString words = list->item(0)->text() + "," + list->item(1)->text();
  const QRegularExpression pattern(
      QStringLiteral("^(\\d+\\.\\d+).mm straight, +(\\d+\\.\\d+).mm along the surface$"));
  const auto match = pattern.match(words);
  ASSERT_TRUE(match.hasMatch()) << words.toStdString();
  EXPECT_NEAR(match.captured(1).toDouble(), 100, 0.01);
  EXPECT_NEAR(match.captured(2).toDouble(), 100, 0.01);
  wait(200);
  keepPicture("measure_box");
  // A drag turns the camera and sets no point.
  const Vec3 eye(view().view().renderer().GetActiveCamera()->GetPosition());
  drag(inView({0, 0}), inView({60, 20}));
  EXPECT_GT((Vec3(view().view().renderer().GetActiveCamera()->GetPosition()) - eye).norm(), 1e-3);
  EXPECT_EQ(list->count(), 2);
}

TEST_F(Inspecting, MeasuresTheRadiusOfABall) {
  if (IsSkipped()) return;
  begin(icosphere(kRadius, 24));
  clickAction("tool_measure");
  chooseIn("measure_kind", static_cast<int>(MeasureKind::sphere));
  pointAt(inView({10, 10}));
  press(), release(); // the fourth click
  auto* list = find<QListWidget>("measurements");
  ASSERT_TRUE(waitUntil([&] { return list->count() > 0; }, 3000));
  const QRegularExpression pattern(QStringLiteral("radius (\\d+\\.\\d+).mm"));
  EXPECT_NEAR(pattern.match(list->item(0)->text()).captured(1).toDouble(), 1e3 * kRadius,
              1e-3 * 1e3 * kRadius)
      << list->item(0)->text().toStdString();
  wait(200);
  keepPicture("measure_ball");
}

TEST_F(Inspecting, PinsAPointThatStaysAndIsExported) {
  if (IsSkipped()) return;
  begin(icosphere(kRadius, 16));
  clickAction("tool_pin");
  const auto pins = [&] { return edits().scene()->scene.pins; };
  for (const QPoint& at : {QPoint(10, 10), QPoint(-30, 20)}) {
    const std::size_t before = pins().size();
    pointAt(inView(at));
    press(), release();
    ASSERT_TRUE(waitUntil([&] { return pins().size() == before + 1; }, 3000));
  }
  EXPECT_EQ(pins()[0].name, "A");
  EXPECT_EQ(pins()[1].name, "B");
  EXPECT_NEAR(pins()[0].position.norm(), kRadius, 5e-5);
  EXPECT_EQ(find<QListWidget>("pins")->count(), 2);
  wait(200);
  keepPicture("pins");
  // Clicks that outrun the edits lose none.
  for (const QPoint& at : {QPoint(0, -20), QPoint(20, -10), QPoint(-10, 30)}) {
    pointAt(inView(at));
    press(), release();
  }
  ASSERT_TRUE(waitUntil([&] { return pins().size() == 5; }, 5000)) << pins().size();
  EXPECT_EQ(pins()[4].name, "E");
  ASSERT_TRUE(waitUntil([&] { return find<QListWidget>("pins")->count() == 5; }, 3000));
  EXPECT_FALSE(find<QPushButton>("pin_remove")->isEnabled()) << "none is selected";
  wait(200); // the list has grown, and the buttons below it move
  find<QListWidget>("pins")->setCurrentRow(2);
  clickOn("pin_remove");
  ASSERT_TRUE(waitUntil([&] { return pins().size() == 4; }, 3000));
  EXPECT_EQ(pins()[2].name, "D") << "C is gone";
  EXPECT_FALSE(find<QPushButton>("pin_remove")->isEnabled()) << "nor is another selected";
  const std::filesystem::path table = folder_ / "pins.csv";
  wait(200); // the list has shrunk, and the buttons below it move
  answerWithPath(table);
  clickOn("pins_export");
  ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(table); }, 10000));
  EXPECT_EQ(readFile(table).substr(0, 6), "pin,x ");
  view().setFocus();
  type('z', kControl);
  EXPECT_TRUE(waitUntil([&] { return pins().size() == 5; }, 3000)) << "one step a pin";
}

} // namespace
} // namespace patina

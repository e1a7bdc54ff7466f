#include "app/gui/panels/object_list.h"

#include <algorithm>

#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/gui/toolkit/value_row.h"
#include "app/gui/toolkit/words.h"
#include "geometry/mesh/pose_values.h"

namespace patina {

ObjectList::ObjectList(QWidget* parent)
    : QGroupBox(tr("Objects"), parent), pose_(new QWidget(this)) {
  auto* column = layoutIn<QVBoxLayout>(this);
  list_ = addList(column, "objects",
                  tr("Objects are rendered as one surface. The selected one is moved below."));
  addPoseRows(layoutIn<QGridLayout>(pose_, 3));
  column->addWidget(pose_);
  redistance_ = addButton<QCheckBox>(column, "redistance", tr("Depth to the union"),
                                     tr("Where objects overlap, depth is measured to their common "
                                        "surface, not to the nearest part inside"));
  problem_ = addNote(column, "object_problem", "bad");
  auto* buttons = new QHBoxLayout;
  column->addLayout(buttons);
  addButton<QToolButton>(buttons, "add_object", tr("+ Add…"),
                         tr("Adds a mesh or volume to the open scene"), this,
                         &ObjectList::addRequested);
  buttons->addStretch(1);
  remove_ = addButton<QToolButton>(buttons, "remove_object", tr("Remove"), {}, this,
                                   &ObjectList::removeChosen);
  auto* changes = new QHBoxLayout;
  column->addLayout(changes);
  const auto addChange = [&](const char* name, const QString& words, const QString& tip,
                             void (ObjectList::*request)(std::size_t)) {
    addButton<QToolButton>(changes, name, words, tip, this, [this, request] {
      if (chosen() >= 0) emit(this->*request)(static_cast<std::size_t>(chosen()));
    });
  };
  addChange("lay_picture", tr("Picture…"),
            tr("Lays a picture on the selected object, as colour or as relief"),
            &ObjectList::pictureRequested);
  addChange("object_unit", tr("Unit…"),
            tr("Corrects the unit or the upper axis of the selected object's file"),
            &ObjectList::unitRequested);
  changes->addStretch(1);

  connect(list_, &QListWidget::currentRowChanged, this, [this] { showPose(); });
  connect(redistance_, &QCheckBox::toggled, this, [this](bool on) {
    choice_.redistance = on;
    emit edited();
  });
}

void ObjectList::addPoseRows(QGridLayout* grid) {
  const QString axes[] = {QStringLiteral("x"), QStringLiteral("y"), QStringLiteral("z")};
  const QString names[] = {tr("Place [mm]"), tr("Turn [°]")};
  for (int column = 0; column < 2; ++column) {
    grid->addWidget(quietLabel(names[column]), 0, column);
    grid->setColumnStretch(column, 1);
    for (int axis = 0; axis < 3; ++axis) {
      auto* number =
          numberBox(names[column] + QStringLiteral(" ") + axes[axis], {},
                    column == 0 ? RowRange{-1e5, 1e5, 1, 2} : RowRange{-180, 180, 5, 1}, pose_);
      number->setObjectName((column == 0 ? QStringLiteral("place_") : QStringLiteral("turn_")) +
                            axes[axis]);
      number->setPrefix(axes[axis] + QStringLiteral(" "));
      grid->addWidget(number, axis + 1, column);
      numbers_[static_cast<std::size_t>(3 * column + axis)] = number;
      connect(number, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
              [this, index = static_cast<std::size_t>(3 * column + axis)] { readPose(index); });
    }
  }
  pose_->setToolTip(tr("Rotation about the object's own origin: first about x, then y, then z"));
}

void ObjectList::setValues(const Scene& scene) {
  const QString before = list_->currentItem() != nullptr ? list_->currentItem()->text() : QString();
  choice_ = {scene.objects, scene.redistance};
  const QSignalBlocker quiet(list_), quiet_too(redistance_);
  QStringList names;
  for (const SceneObject& object : scene.objects) names << shownText(object.name);
  fillList(list_, names);
  list_->setCurrentRow(std::max(0, names.lastIndexOf(before)));
  remove_->setEnabled(list_->count() > 1);
  remove_->setToolTip(list_->count() > 1 ? tr("Remove the chosen object from the scene")
                                         : tr("The last object stays"));
  redistance_->setVisible(list_->count() > 1);
  redistance_->setChecked(scene.redistance);
  showPose();
}

void ObjectList::showPose() {
  pose_->setVisible(chosen() >= 0);
  if (chosen() < 0) return;
  const PoseValues values =
      valuesOf(choice_.objects[static_cast<std::size_t>(chosen())].world_from_object);
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const QSignalBlocker quiet(numbers_[i]);
    const auto axis = static_cast<int>(i % 3);
    numbers_[i]->setValue(i < 3 ? values.position_mm[axis] : values.angles_deg[axis]);
  }
}

void ObjectList::readPose(std::size_t number) {
  if (chosen() < 0) return;
  Pose& pose = choice_.objects[static_cast<std::size_t>(chosen())].world_from_object;
  PoseValues values = valuesOf(pose);
  (number < 3 ? values.position_mm : values.angles_deg)[static_cast<int>(number % 3)] =
      numbers_[number]->value();
  pose = poseOf(values);
  emit edited();
}

void ObjectList::removeChosen() {
  if (chosen() < 0 || choice_.objects.size() < 2) return;
  choice_.objects.erase(choice_.objects.begin() + chosen());
  Scene scene;
  scene.objects = choice_.objects;
  scene.redistance = choice_.redistance;
  setValues(scene);
  emit edited();
}

} // namespace patina

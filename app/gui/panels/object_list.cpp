#include "app/gui/panels/object_list.h"

#include <algorithm>

#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/gui/window/theme.h"
#include "geometry/mesh/pose_values.h"

namespace patina {

ObjectList::ObjectList(QWidget* parent)
    : QGroupBox(tr("Objects"), parent), list_(new QListWidget(this)), pose_(new QWidget(this)),
      remove_(new QToolButton(this)), redistance_(new QCheckBox(tr("Depth to the union"), this)),
      problem_(new QLabel(this)) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  list_->setObjectName(QStringLiteral("objects"));
  list_->setToolTip(tr("What is felt as one surface; the chosen one is moved below"));
  dress(*list_, QStringLiteral("QListWidget { border: 1px solid @line; }"));
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  column->addWidget(list_);

  auto* grid = new QGridLayout(pose_);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setHorizontalSpacing(4);
  grid->setVerticalSpacing(2);
  addPoseRows(grid);
  column->addWidget(pose_);

  redistance_->setObjectName(QStringLiteral("redistance"));
  redistance_->setToolTip(tr("Where objects overlap, depth is measured to the surface of all of "
                             "them together, not to the nearest part inside"));
  column->addWidget(redistance_);
  problem_->setProperty("bad", true);
  problem_->setWordWrap(true);
  problem_->hide();
  column->addWidget(problem_);

  auto* buttons = new QHBoxLayout;
  auto* add = new QToolButton(this);
  add->setObjectName(QStringLiteral("add_object"));
  add->setText(tr("+ Add object…"));
  add->setToolTip(tr("A mesh or volume that is felt together with what is open"));
  remove_->setObjectName(QStringLiteral("remove_object"));
  remove_->setText(tr("Remove"));
  buttons->addWidget(add);
  buttons->addStretch(1);
  buttons->addWidget(remove_);
  column->addLayout(buttons);

  connect(add, &QToolButton::clicked, this, &ObjectList::addAsked);
  connect(remove_, &QToolButton::clicked, this, &ObjectList::removeChosen);
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
    auto* label = new QLabel(names[column], pose_);
    label->setProperty("quiet", true);
    grid->addWidget(label, 0, column);
    grid->setColumnStretch(column, 1);
    for (int axis = 0; axis < 3; ++axis) {
      auto* number = new QDoubleSpinBox(pose_);
      number->setObjectName((column == 0 ? QStringLiteral("place_") : QStringLiteral("turn_")) +
                            axes[axis]);
      number->setAccessibleName(names[column] + QStringLiteral(" ") + axes[axis]);
      number->setPrefix(axes[axis] + QStringLiteral(" "));
      number->setDecimals(column == 0 ? 2 : 1);
      number->setRange(column == 0 ? -1e5 : -180, column == 0 ? 1e5 : 180);
      number->setSingleStep(column == 0 ? 1 : 5);
      number->setKeyboardTracking(false);
      grid->addWidget(number, axis + 1, column);
      numbers_[static_cast<std::size_t>(3 * column + axis)] = number;
      connect(number, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
              [this, index = static_cast<std::size_t>(3 * column + axis)] { readPose(index); });
    }
  }
  pose_->setToolTip(tr("Turned about the object's own origin, first about x, then y, then z"));
}

int ObjectList::chosen() const {
  return list_->currentRow();
}

void ObjectList::setValues(const Scene& scene) {
  const QString before = list_->currentItem() != nullptr ? list_->currentItem()->text() : QString();
  choice_ = {scene.objects, scene.redistance};
  const QSignalBlocker quiet(list_), quiet_too(redistance_);
  list_->clear();
  int row = 0;
  for (const SceneObject& object : scene.objects) {
    list_->addItem(QString::fromStdString(object.name));
    list_->item(list_->count() - 1)->setToolTip(list_->item(list_->count() - 1)->text());
    if (list_->item(list_->count() - 1)->text() == before) row = list_->count() - 1;
  }
  list_->setCurrentRow(row);
  const int lines = std::clamp(list_->count(), 1, 5);
  list_->setFixedHeight(lines * std::max(18, list_->sizeHintForRow(0)) + 4);
  remove_->setEnabled(list_->count() > 1);
  remove_->setToolTip(list_->count() > 1 ? tr("Remove the chosen object from the scene")
                                         : tr("The last object stays"));
  redistance_->setVisible(list_->count() > 1);
  redistance_->setChecked(scene.redistance);
  showPose();
}

void ObjectList::setProblem(const QString& line) {
  problem_->setText(line);
  problem_->setVisible(!line.isEmpty());
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

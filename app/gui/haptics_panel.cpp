#include "app/gui/haptics_panel.h"

#include <algorithm>

#include <QToolButton>

#include "app/gui/value_row.h"

namespace patina {

HapticsPanel::HapticsPanel(QWidget* parent)
    : QGroupBox(tr("Touch"), parent), layout_(new QVBoxLayout(this)), problem_(new QLabel(this)) {
  layout_->setContentsMargins(0, 0, 0, 0);
  problem_->setProperty("bad", true);
  problem_->setWordWrap(true);
  problem_->hide();
  layout_->addWidget(problem_);
  rebuild();
}

void HapticsPanel::setValues(const HapticProperties& haptics) {
  haptics_ = haptics;
  rebuild();
}

void HapticsPanel::setProblem(const QString& line) {
  problem_->setText(line);
  problem_->setVisible(!line.isEmpty());
}

void HapticsPanel::change() {
  emit edited(haptics_);
}

void HapticsPanel::rebuild() {
  // The old rows may be the senders of the signal that brought us here.
  if (rows_ != nullptr) {
    rows_->hide();
    rows_->setParent(nullptr);
    rows_->deleteLater();
  }
  rows_ = new QWidget(this);
  auto* column = new QVBoxLayout(rows_);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  addRows();
  addMenu();
  layout_->insertWidget(0, rows_);
}

void HapticsPanel::addRows() {
  auto* stiffness =
      new ValueRow(tr("Stiffness"), QStringLiteral("N/m"), {10, 3000, 10, 0, true}, rows_);
  stiffness->setObjectName(QStringLiteral("stiffness"));
  stiffness->setValue(haptics_.stiffness);
  connect(stiffness, &ValueRow::edited, this, [this](double value) {
    haptics_.stiffness = value;
    change();
  });
  rows_->layout()->addWidget(stiffness);

  if (haptics_.friction) addFrictionRows();
  if (haptics_.damping) {
    auto* damping = new ValueRow(tr("Damping"), QStringLiteral("N s/m"), {0, 20, 0.1, 2}, rows_);
    damping->setObjectName(QStringLiteral("damping"));
    damping->setValue(*haptics_.damping);
    damping->setRemovable(tr("Remove damping from the scene"));
    connect(damping, &ValueRow::edited, this, [this](double value) {
      haptics_.damping = value;
      change();
    });
    connect(damping, &ValueRow::removed, this, [this] {
      haptics_.damping.reset();
      rebuild();
      change();
    });
    rows_->layout()->addWidget(damping);
  }
  if (haptics_.tip_radius) {
    auto* radius = new ValueRow(tr("Tip radius"), QStringLiteral("mm"), {0.05, 10, 0.1, 2}, rows_);
    radius->setObjectName(QStringLiteral("tip_radius"));
    radius->setValue(1000 * *haptics_.tip_radius);
    radius->setRemovable(tr("Feel with a point again"));
    connect(radius, &ValueRow::edited, this, [this](double value) {
      haptics_.tip_radius = value / 1000;
      change();
    });
    connect(radius, &ValueRow::removed, this, [this] {
      haptics_.tip_radius.reset();
      rebuild();
      change();
    });
    rows_->layout()->addWidget(radius);
  }
  auto* limit = new ValueRow(tr("Force limit"), QStringLiteral("N"), {0.1, 20, 0.1, 1}, rows_);
  limit->setObjectName(QStringLiteral("force_limit"));
  limit->setValue(haptics_.force_limit);
  connect(limit, &ValueRow::edited, this, [this](double value) {
    haptics_.force_limit = value;
    change();
  });
  rows_->layout()->addWidget(limit);
}

void HapticsPanel::addFrictionRows() {
  auto* holds = new ValueRow(tr("Friction, static"), {}, {0, 2, 0.05, 2}, rows_);
  auto* slides = new ValueRow(tr("Friction, dynamic"), {}, {0, 2, 0.05, 2}, rows_);
  holds->setObjectName(QStringLiteral("friction_static"));
  slides->setObjectName(QStringLiteral("friction_dynamic"));
  holds->setValue(haptics_.friction->static_coefficient);
  slides->setValue(haptics_.friction->dynamic_coefficient);
  holds->setRemovable(tr("Remove friction from the scene"));
  // Static friction is never below dynamic: each slider takes the other along.
  connect(holds, &ValueRow::edited, this, [this, slides](double value) {
    haptics_.friction->static_coefficient = value;
    if (haptics_.friction->dynamic_coefficient > value) {
      haptics_.friction->dynamic_coefficient = value;
      slides->setValue(value);
    }
    change();
  });
  connect(slides, &ValueRow::edited, this, [this, holds](double value) {
    haptics_.friction->dynamic_coefficient = value;
    if (haptics_.friction->static_coefficient < value) {
      haptics_.friction->static_coefficient = value;
      holds->setValue(value);
    }
    change();
  });
  connect(holds, &ValueRow::removed, this, [this] {
    haptics_.friction.reset();
    rebuild();
    change();
  });
  rows_->layout()->addWidget(holds);
  rows_->layout()->addWidget(slides);
}

void HapticsPanel::addMenu() {
  auto* button = new QToolButton(rows_);
  button->setObjectName(QStringLiteral("add_property"));
  button->setText(tr("+ Add property"));
  button->setPopupMode(QToolButton::InstantPopup);
  button->setToolTip(tr("What a scene does not have costs nothing: no stage, no memory, no row."));
  auto* menu = new QMenu(button);
  const auto offer = [&](const QString& words, auto add) {
    connect(menu->addAction(words), &QAction::triggered, this, [this, add] {
      add(haptics_);
      rebuild();
      change();
    });
  };
  if (!haptics_.friction)
    offer(tr("Friction"), [](HapticProperties& h) { h.friction = Friction{0.5, 0.3, 0, {}}; });
  if (!haptics_.damping) offer(tr("Damping"), [](HapticProperties& h) { h.damping = 1.0; });
  if (!haptics_.tip_radius)
    offer(tr("Tip radius"), [](HapticProperties& h) { h.tip_radius = 1e-3; });
  button->setMenu(menu);
  button->setVisible(!menu->isEmpty());
  rows_->layout()->addWidget(button);
}

} // namespace patina

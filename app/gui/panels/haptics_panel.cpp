#include "app/gui/panels/haptics_panel.h"

#include <algorithm>
#include <cmath>

#include <QCheckBox>
#include <QToolButton>

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

void HapticsPanel::setReach(double reach) {
  if (reach == reach_) return;
  reach_ = reach;
  rebuild();
}

void HapticsPanel::setProblem(const QString& line) {
  problem_->setText(line);
  problem_->setVisible(!line.isEmpty());
}

void HapticsPanel::change() {
  emit edited(haptics_);
}

double HapticsPanel::mostMillimetres() const {
  return std::max(0.1, std::floor(1e5 * reach_) / 100);
}

void HapticsPanel::rebuild() {
  takeAway(rows_);
  rows_ = new QWidget(this);
  auto* column = new QVBoxLayout(rows_);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  addModeRows();
  ValueRow* stiffness = addRow("stiffness", tr("Stiffness"), QStringLiteral("N/m"),
                               {10, 10000, 10, 0, true}, haptics_.stiffness);
  connect(stiffness, &ValueRow::edited, this, [this](double value) {
    haptics_.stiffness = value;
    change();
  });
  if (haptics_.friction) addFrictionRows();
  if (haptics_.damping) addDampingRows();
  if (haptics_.tip_radius) addTipRow();
  ValueRow* limit = addRow("force_limit", tr("Force limit"), QStringLiteral("N"), {0.1, 20, 0.1, 1},
                           haptics_.force_limit);
  connect(limit, &ValueRow::edited, this, [this](double value) {
    haptics_.force_limit = value;
    change();
  });
  addContactRow();
  addMenu();
  layout_->insertWidget(0, rows_);
}

ValueRow* HapticsPanel::addRow(const char* name, const QString& caption, const QString& unit,
                               const RowRange& range, double value, const QString& tip) {
  auto* row = new ValueRow(caption, unit, range, rows_);
  row->setObjectName(QString::fromUtf8(name));
  row->setValue(value);
  row->setToolTip(tip);
  rows_->layout()->addWidget(row);
  return row;
}

template <typename Remove>
void HapticsPanel::makeRemovable(ValueRow* row, const QString& tip, Remove remove) {
  row->setRemovable(tip);
  connect(row, &ValueRow::removed, this, [this, remove] {
    remove(haptics_);
    rebuild();
    change();
  });
}

void HapticsPanel::setMode(TouchMode mode) {
  if (haptics_.offset) last_offset_ = haptics_.offset;
  if (haptics_.magnet) last_magnet_ = haptics_.magnet;
  haptics_.offset.reset();
  haptics_.magnet.reset();
  // Half of what the field allows, and no more than fingers like.
  const double usual = std::min(1.5e-3, 0.5 * mostMillimetres() / 1000);
  const double most = mostMillimetres() / 1000;
  if (mode == TouchMode::offset) haptics_.offset = std::min(most, last_offset_.value_or(usual));
  if (mode == TouchMode::magnetic) {
    haptics_.magnet = last_magnet_.value_or(Magnet{usual, 300, true});
    haptics_.magnet->range = std::min(most, haptics_.magnet->range);
  }
  rebuild();
  change();
}

void HapticsPanel::addModeRows() {
  auto* modes = new ModeSwitch(rows_);
  modes->setMode(touchMode(haptics_));
  connect(modes, &ModeSwitch::chosen, this, &HapticsPanel::setMode);
  rows_->layout()->addWidget(modes);
  const RowRange lengths{0.05, mostMillimetres(), 0.05, 2};
  const QString limited = tr("Up to what the field's band holds; a wider band: "
                             "patina scene WORKSPACE --set band=N");
  if (haptics_.offset) {
    ValueRow* offset = addRow("offset", tr("Offset"), QStringLiteral("mm"), lengths,
                              1000 * *haptics_.offset, limited);
    connect(offset, &ValueRow::edited, this, [this](double value) {
      haptics_.offset = value / 1000;
      change();
    });
  }
  if (!haptics_.magnet) return;
  ValueRow* range = addRow("magnet_range", tr("Magnet range"), QStringLiteral("mm"), lengths,
                           1000 * haptics_.magnet->range, limited);
  connect(range, &ValueRow::edited, this, [this](double value) {
    haptics_.magnet->range = value / 1000;
    change();
  });
  ValueRow* strength = addRow("magnet_strength", tr("Magnet strength"), QStringLiteral("N/m"),
                              {10, 3000, 10, 0, true}, haptics_.magnet->strength);
  connect(strength, &ValueRow::edited, this, [this](double value) {
    haptics_.magnet->strength = value;
    change();
  });
  auto* fades = new QCheckBox(tr("Pull fades at the edge"), rows_);
  fades->setObjectName(QStringLiteral("magnet_fades"));
  fades->setToolTip(tr("Over the last quarter of the range the pull falls to zero; without this "
                       "it steps there by strength × range"));
  fades->setChecked(haptics_.magnet->fades);
  connect(fades, &QCheckBox::toggled, this, [this](bool on) {
    haptics_.magnet->fades = on;
    change();
  });
  rows_->layout()->addWidget(fades);
}

void HapticsPanel::addFrictionRows() {
  const RowRange range{0, 2, 0.05, 2};
  ValueRow* holds = addRow("friction_static", tr("Friction, static"), {}, range,
                           haptics_.friction->static_coefficient);
  ValueRow* slides = addRow("friction_dynamic", tr("Friction, dynamic"), {}, range,
                            haptics_.friction->dynamic_coefficient);
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
  makeRemovable(holds, tr("Remove friction from the scene"),
                [](HapticProperties& h) { h.friction.reset(); });
}

void HapticsPanel::addDampingRows() {
  ValueRow* damping =
      addRow("damping", tr("Damping"), QStringLiteral("N s/m"), {0, 20, 0.1, 2}, *haptics_.damping);
  connect(damping, &ValueRow::edited, this, [this](double value) {
    haptics_.damping = value;
    change();
  });
  makeRemovable(damping, tr("Remove damping from the scene"), [](HapticProperties& h) {
    h.damping.reset();
    h.damping_cutoff.reset();
  });
  if (!haptics_.damping_cutoff) return;
  ValueRow* cutoff = addRow("damping_cutoff", tr("Damping cut-off"), QStringLiteral("Hz"),
                            {5, 500, 5, 0, true}, *haptics_.damping_cutoff,
                            tr("Of the velocity that damping sees: lower is smoother, and later"));
  connect(cutoff, &ValueRow::edited, this, [this](double value) {
    haptics_.damping_cutoff = value;
    change();
  });
  makeRemovable(cutoff, tr("Damp the velocity as it is measured"),
                [](HapticProperties& h) { h.damping_cutoff.reset(); });
}

void HapticsPanel::addTipRow() {
  ValueRow* radius =
      addRow("tip_radius", tr("Tip radius"), QStringLiteral("mm"),
             {0.05, std::min(10.0, mostMillimetres()), 0.1, 2}, 1000 * *haptics_.tip_radius);
  connect(radius, &ValueRow::edited, this, [this](double value) {
    haptics_.tip_radius = value / 1000;
    change();
  });
  makeRemovable(radius, tr("Feel with a point again"),
                [](HapticProperties& h) { h.tip_radius.reset(); });
}

void HapticsPanel::addContactRow() {
  using Contact = HapticProperties::Contact;
  auto* proxy = new QCheckBox(tr("Stays on the side it entered"), rows_);
  proxy->setObjectName(QStringLiteral("contact_proxy"));
  proxy->setToolTip(tr("The contact point is followed over the surface, round corners and edges, "
                       "and stays on the side where the tip came in. Without, it is found from the "
                       "tip alone, as in the paper: past the middle of a part the force turns "
                       "round."));
  proxy->setChecked(haptics_.contact == Contact::proxy);
  connect(proxy, &QCheckBox::toggled, this, [this](bool on) {
    haptics_.contact = on ? Contact::proxy : Contact::ray;
    change();
  });
  rows_->layout()->addWidget(proxy);
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
  if (haptics_.damping && !haptics_.damping_cutoff)
    offer(tr("Damping cut-off"), [](HapticProperties& h) { h.damping_cutoff = 100; });
  if (!haptics_.tip_radius)
    offer(tr("Tip radius"), [](HapticProperties& h) { h.tip_radius = 1e-3; });
  button->setMenu(menu);
  button->setVisible(!menu->isEmpty());
  rows_->layout()->addWidget(button);
}

} // namespace patina

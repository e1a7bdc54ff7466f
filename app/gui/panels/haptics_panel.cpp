#include "app/gui/panels/haptics_panel.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

double HapticsPanel::mostMillimetres() const {
  return std::max(0.1, std::floor(1e5 * reach_) / 100);
}

void HapticsPanel::rebuild() {
  takeAway(form_);
  form_ = new Form(this);
  connect(form_, &Form::edited, this, [this] { emit edited(haptics_); });
  addModeRows();
  form_->addRow({"stiffness",
                 tr("Stiffness"),
                 QStringLiteral("N/m"),
                 {10, 10000, 10, 0, true},
                 1,
                 tr("Force for each metre of depth")},
                haptics_.stiffness);
  if (haptics_.friction) addFrictionRows();
  if (haptics_.damping) addDampingRows();
  if (haptics_.tip_radius) {
    const RowRange range{0.05, std::min(10.0, mostMillimetres()), 0.1, 2};
    makeRemovable(form_->addRow({"tip_radius", tr("Tip radius"), QStringLiteral("mm"), range, 1000,
                                 tr("The tip is a ball; without one it is a point")},
                                *haptics_.tip_radius),
                  tr("Feel with a point again"), [this] { haptics_.tip_radius.reset(); });
  }
  form_->addRow({"force_limit",
                 tr("Force limit"),
                 QStringLiteral("N"),
                 {0.1, 20, 0.1, 1},
                 1,
                 tr("No force is larger, whatever is pressed")},
                haptics_.force_limit);
  using Method = HapticProperties::Contact;
  form_->addCheck("contact_proxy", tr("Follow the surface (proxy)"),
                  tr("The contact point is followed over the surface, round corners and edges, "
                     "and stays on the side where the tip came in. Without, it is found from the "
                     "tip alone, along a ray, as in the paper: past the middle of a part the "
                     "force turns round."),
                  haptics_.contact == Method::proxy,
                  [this](bool on) { haptics_.contact = on ? Method::proxy : Method::ray; });
  addMenu();
  layout_->insertWidget(0, form_);
}

void HapticsPanel::makeRemovable(ValueRow* row, const QString& tip, std::function<void()> remove) {
  row->setRemovable(tip);
  connect(row, &ValueRow::removed, this, [this, remove = std::move(remove)] { change(remove); });
}

void HapticsPanel::change(const std::function<void()>& rows) {
  rows();
  rebuild();
  emit edited(haptics_);
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
}

void HapticsPanel::addModeRows() {
  auto* modes = new ModeSwitch(form_);
  modes->setMode(touchMode(haptics_));
  connect(modes, &ModeSwitch::chosen, this,
          [this](TouchMode mode) { change([this, mode] { setMode(mode); }); });
  form_->addWidget(modes);
  const RowRange lengths{0.05, mostMillimetres(), 0.05, 2};
  const QString limited = tr("Up to what the field's band holds; a wider band: "
                             "patina scene WORKSPACE --set band=N");
  if (haptics_.offset)
    form_->addRow({"offset", tr("Offset"), QStringLiteral("mm"), lengths, 1000, limited},
                  *haptics_.offset);
  if (!haptics_.magnet) return;
  form_->addRow({"magnet_range", tr("Magnet range"), QStringLiteral("mm"), lengths, 1000, limited},
                haptics_.magnet->range);
  form_->addRow({"magnet_strength",
                 tr("Magnet strength"),
                 QStringLiteral("N/m"),
                 {10, 3000, 10, 0, true},
                 1,
                 tr("The pull for each metre from the surface")},
                haptics_.magnet->strength);
  form_->addCheck("magnet_fades", tr("Pull fades at the edge"),
                  tr("Over the last quarter of the range the pull falls to zero; without this "
                     "it steps there by strength × range"),
                  haptics_.magnet->fades, [this](bool on) { haptics_.magnet->fades = on; });
}

void HapticsPanel::addFrictionRows() {
  // Static friction is never below dynamic: each slider takes the other along.
  const auto addRow = [this](const char* name, const QString& caption, double& value,
                             const char* other_name, double& other, bool upwards) {
    return form_->addRow(
        {name,
         caption,
         {},
         {0, 2, 0.05, 2},
         1,
         upwards ? tr("Coulomb's coefficient that holds; never below the dynamic one")
                 : tr("Coulomb's coefficient that slides; never above the static one")},
        value, [this, &value, &other, other_name, upwards](double now) {
          value = now;
          if (upwards ? other <= now : other >= now) return;
          other = now;
          form_->findChild<ValueRow*>(QString::fromUtf8(other_name))->setValue(now);
        });
  };
  double& holds = haptics_.friction->static_coefficient;
  double& slides = haptics_.friction->dynamic_coefficient;
  ValueRow* row =
      addRow("friction_static", tr("Friction, static"), holds, "friction_dynamic", slides, true);
  addRow("friction_dynamic", tr("Friction, dynamic"), slides, "friction_static", holds, false);
  makeRemovable(row, tr("Remove friction from the scene"), [this] { haptics_.friction.reset(); });
}

void HapticsPanel::addDampingRows() {
  const RowSpec damping{"damping",
                        tr("Damping"),
                        QStringLiteral("N s/m"),
                        {0, 20, 0.1, 2},
                        1,
                        tr("Against the speed along the normal; it never pulls")};
  makeRemovable(form_->addRow(damping, *haptics_.damping), tr("Remove damping from the scene"),
                [this] {
                  haptics_.damping.reset();
                  haptics_.damping_cutoff.reset();
                });
  if (!haptics_.damping_cutoff) return;
  const RowSpec cutoff{"damping_cutoff",
                       tr("Damping cut-off"),
                       QStringLiteral("Hz"),
                       {5, 500, 5, 0, true},
                       1,
                       tr("Of the velocity that damping sees: lower is smoother, and later")};
  makeRemovable(form_->addRow(cutoff, *haptics_.damping_cutoff),
                tr("Damp the velocity as it is measured"),
                [this] { haptics_.damping_cutoff.reset(); });
}

void HapticsPanel::addMenu() {
  auto* button = new QToolButton(form_);
  button->setObjectName(QStringLiteral("add_property"));
  button->setText(tr("+ Add property"));
  button->setToolTip(tr("What a scene does not have costs nothing: no stage, no memory, no row."));
  auto* menu = new QMenu(button);
  menu->setObjectName(QStringLiteral("properties"));
  const auto offer = [&](const QString& words, auto add) {
    connect(menu->addAction(words), &QAction::triggered, this,
            [this, add] { change([this, add] { add(haptics_); }); });
  };
  if (!haptics_.friction)
    offer(tr("Friction"), [](HapticProperties& h) { h.friction = Friction{0.5, 0.3, 0, {}}; });
  if (!haptics_.damping) offer(tr("Damping"), [](HapticProperties& h) { h.damping = 1.0; });
  if (haptics_.damping && !haptics_.damping_cutoff)
    offer(tr("Damping cut-off"), [](HapticProperties& h) { h.damping_cutoff = 100; });
  if (!haptics_.tip_radius)
    offer(tr("Tip radius"), [](HapticProperties& h) { h.tip_radius = 1e-3; });
  // Not the button's own: that would wait for the menu, whose choice takes both away.
  connect(button, &QToolButton::clicked, menu,
          [=] { menu->popup(button->mapToGlobal(button->rect().bottomLeft())); });
  button->setVisible(!menu->isEmpty());
  form_->addWidget(button);
}

} // namespace patina

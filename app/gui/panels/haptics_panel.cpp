#include "app/gui/panels/haptics_panel.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QButtonGroup>
#include <QHBoxLayout>
#include <QToolButton>

#include "app/gui/toolkit/theme.h"

namespace patina {

HapticsPanel::HapticsPanel(QWidget* parent)
    : QGroupBox(tr("Touch"), parent), layout_(layoutIn<QVBoxLayout>(this)),
      problem_(addNote(layout_, "touch_problem", "bad")) {
  rebuild();
}

void HapticsPanel::setReach(double reach) {
  if (reach == reach_) return;
  reach_ = reach;
  rebuild();
}

double HapticsPanel::maxMillimetres() const {
  return std::max(0.1, std::floor(1e5 * reach_) / 100);
}

void HapticsPanel::rebuild() {
  takeAway(form_);
  form_ = new Form(this);
  connect(form_, &Form::edited, this, [this] { emit edited(haptics_); });
  addModeRows();
  form_->addRow(RowSpec("stiffness", tr("Stiffness"), QStringLiteral("N/m"),
                        {10, 10000, 10, 0, true}, tr("Force per metre of depth")),
                haptics_.stiffness);
  if (haptics_.friction) addFrictionRows();
  if (haptics_.damping) addDampingRows();
  if (haptics_.tip_radius) {
    const RowRange range{0.05, std::min(10.0, maxMillimetres()), 0.1, 2};
    makeRemovable(form_->addRow(RowSpec("tip_radius", tr("Tip radius"), QStringLiteral("mm"), range,
                                        tr("The tip is a sphere; at zero it is a point"), 1000),
                                *haptics_.tip_radius),
                  tr("Makes the tip a point again"), [this] { haptics_.tip_radius.reset(); });
  }
  form_->addRow(RowSpec("force_limit", tr("Force limit"), QStringLiteral("N"), {0.1, 20, 0.1, 1},
                        tr("Upper limit of the force")),
                haptics_.force_limit);
  using Method = HapticProperties::Contact;
  form_->addCheck(
      "contact_proxy", tr("Follow the surface (proxy)"),
      tr("The contact point follows the surface around corners and edges, and stays on the side "
         "where the tip came in. Otherwise it is found from the tip alone, along a ray, as in the "
         "paper: beyond the middle of a part, the force reverses."),
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
  // Half of the limit of the field, at most 1.5 mm.
  const double usual = std::min(1.5e-3, 0.5 * maxMillimetres() / 1000);
  const double max = maxMillimetres() / 1000;
  if (mode == TouchMode::offset) haptics_.offset = std::min(max, last_offset_.value_or(usual));
  if (mode == TouchMode::magnetic) {
    haptics_.magnet = last_magnet_.value_or(Magnet{usual, 300, true});
    haptics_.magnet->range = std::min(max, haptics_.magnet->range);
  }
}

void HapticsPanel::addModeRows() {
  auto* modes = new QWidget(form_);
  auto* buttons = new QButtonGroup(modes); // Makes them exclusive.
  auto* row = layoutIn<QHBoxLayout>(modes, 0);
  const struct {
    TouchMode mode;
    const char* name;
    QString words, tip;
    bool on;
  } choices[] = {
      {TouchMode::contact, "mode_contact", tr("Contact"), tr("Contact is at the surface"),
       !haptics_.offset && !haptics_.magnet},
      {TouchMode::offset, "mode_offset", tr("Offset"),
       tr("Contact is at a distance outside the surface: thin parts become thick enough to hold"),
       haptics_.offset.has_value()},
      {TouchMode::magnetic, "mode_magnetic", tr("Magnetic"),
       tr("Near the surface the tip is pulled to it: shapes can be traced without looking"),
       haptics_.magnet && !haptics_.offset}};
  for (const auto& choice : choices) {
    auto* button = addButton<QToolButton>(
        row, choice.name, choice.words, choice.tip, this,
        [this, mode = choice.mode] { change([this, mode] { setMode(mode); }); });
    button->setCheckable(true);
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    buttons->addButton(button);
    button->setChecked(choice.on);
  }
  applyStyleSheet(
      *modes,
      QStringLiteral(
          "QToolButton { border: 1px solid @grip; padding: 3px; background: @soft; }"
          "QToolButton:hover { background: @hover; }"
          "QToolButton:checked { background: @strong; color: white; border-color: @strong; }"));
  form_->addWidget(modes);
  const RowRange lengths{0.05, maxMillimetres(), 0.05, 2};
  const QString limited = tr("Limited by the band of the field, a value of the workspace (band)");
  if (haptics_.offset)
    form_->addRow(RowSpec("offset", tr("Offset"), QStringLiteral("mm"), lengths, limited, 1000),
                  *haptics_.offset);
  if (!haptics_.magnet) return;
  form_->addRow(
      RowSpec("magnet_range", tr("Magnet range"), QStringLiteral("mm"), lengths, limited, 1000),
      haptics_.magnet->range);
  form_->addRow(RowSpec("magnet_strength", tr("Magnet strength"), QStringLiteral("N/m"),
                        {10, 3000, 10, 0, true}, tr("Attraction per metre from the surface")),
                haptics_.magnet->strength);
  form_->addCheck("magnet_fades", tr("Pull fades at the edge"),
                  tr("The attraction falls to zero over the last quarter of the range; otherwise "
                     "it jumps by strength × range there"),
                  haptics_.magnet->fades, [this](bool on) { haptics_.magnet->fades = on; });
}

void HapticsPanel::addFrictionRows() {
  // Static friction is never below dynamic friction: each slider moves the other.
  const auto addRow = [this](const char* name, const QString& caption, double& value,
                             const char* other_name, double& other, bool upwards) {
    return form_->addRow(
        RowSpec(name, caption, QString(), {0, 2, 0.05, 2},
                upwards ? tr("Coulomb coefficient while sticking; never below the dynamic one")
                        : tr("Coulomb coefficient while sliding; never above the static one")),
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
  const RowSpec damping("damping", tr("Damping"), QStringLiteral("N s/m"), {0, 20, 0.1, 2},
                        tr("Opposes the velocity along the normal; never attracts"));
  makeRemovable(form_->addRow(damping, *haptics_.damping), tr("Remove damping from the scene"),
                [this] {
                  haptics_.damping.reset();
                  haptics_.damping_cutoff.reset();
                });
  if (!haptics_.damping_cutoff) return;
  const RowSpec cutoff(
      "damping_cutoff", tr("Damping cut-off"), QStringLiteral("Hz"), {5, 500, 5, 0, true},
      tr("Low-pass filter of the velocity for damping: lower is smoother, but adds delay"));
  makeRemovable(form_->addRow(cutoff, *haptics_.damping_cutoff),
                tr("Removes the filter of the velocity"),
                [this] { haptics_.damping_cutoff.reset(); });
}

void HapticsPanel::addMenu() {
  auto* button =
      named(new QToolButton(form_), "add_property",
            tr("Adds a property to the scene. Absent properties cost neither time nor memory."));
  button->setText(tr("+ Add property"));
  auto* menu = named(new QMenu(button), "properties");
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
  // The button must not own the menu, because the choice deletes the button.
  connect(button, &QToolButton::clicked, menu,
          [=] { menu->popup(button->mapToGlobal(button->rect().bottomLeft())); });
  button->setVisible(!menu->isEmpty());
  form_->addWidget(button);
}

} // namespace patina

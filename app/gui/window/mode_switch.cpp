#include "app/gui/window/mode_switch.h"

#include <QHBoxLayout>
#include <QToolButton>

#include "app/gui/window/theme.h"

namespace patina {

TouchMode touchMode(const HapticProperties& haptics) {
  return haptics.offset   ? TouchMode::offset
         : haptics.magnet ? TouchMode::magnetic
                          : TouchMode::contact;
}

ModeSwitch::ModeSwitch(QWidget* parent) : QWidget(parent), buttons_(new QButtonGroup(this)) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  const struct {
    TouchMode mode;
    const char* name;
    QString words, tip;
  } choices[] = {
      {TouchMode::contact, "mode_contact", tr("Contact"), tr("Felt where the surface is")},
      {TouchMode::offset, "mode_offset", tr("Offset"),
       tr("Felt at a distance outside the surface: thin parts become thick enough to hold")},
      {TouchMode::magnetic, "mode_magnetic", tr("Magnetic"),
       tr("Near the surface the tip is pulled to it: shapes can be traced without looking")}};
  for (const auto& choice : choices) {
    auto* button = new QToolButton(this);
    button->setObjectName(QString::fromUtf8(choice.name));
    button->setText(choice.words);
    button->setToolTip(choice.tip);
    button->setCheckable(true);
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    buttons_->addButton(button, static_cast<int>(choice.mode));
    row->addWidget(button);
  }
  dress(*this,
        QStringLiteral(
            "QToolButton { border: 1px solid @grip; padding: 3px; background: @soft; }"
            "QToolButton:hover { background: @hover; }"
            "QToolButton:checked { background: @strong; color: white; border-color: @strong; }"));
  setMode(TouchMode::contact);
  connect(buttons_, &QButtonGroup::idClicked, this,
          [this](int id) { emit chosen(static_cast<TouchMode>(id)); });
}

void ModeSwitch::setMode(TouchMode mode) {
  buttons_->button(static_cast<int>(mode))->setChecked(true);
}

} // namespace patina

#include "app/gui/panels/tool_panel.h"

#include <algorithm>

#include <QVBoxLayout>

namespace patina {
namespace {

using Lines = std::vector<std::pair<QString, QString>>;

Lines linesOf(Handling handling) {
  const auto tr = [](const char* words) { return ToolPanel::tr(words); };
  switch (handling) {
  case Handling::feel:
    return {{tr("Left drag"), tr("moves the tip in the plane you look at")},
            {tr("Wheel"), tr("moves it away from you, and back")},
            {tr("Double click"), tr("sets it onto the surface")},
            {tr("Shift + left drag"), tr("turns the camera")}};
  case Handling::press:
    return {{tr("Left drag"), tr("presses on the surface under the pointer")},
            {tr("Wheel"), tr("sets the force")},
            {tr("Shift + left drag"), tr("turns the camera")},
            {tr("Ctrl + wheel"), tr("zooms")}};
  case Handling::pick:
    return {{tr("Click"), tr("takes what is painted there into the brush")}};
  default:
    return {{tr("Left drag"), tr("turns the camera")},
            {tr("Wheel"), tr("zooms")},
            {tr("Middle drag"), tr("shifts the camera")}};
  }
}

} // namespace

ToolPanel::ToolPanel(QWidget* parent)
    : QGroupBox(parent), words_(new QLabel(this)),
      force_(new ValueRow(tr("Pressing force"), QStringLiteral("N"), {0.1, 3, 0.1, 1}, this)) {
  words_->setObjectName(QStringLiteral("tool_words"));
  words_->setProperty("quiet", true);
  words_->setWordWrap(true);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(words_);
  column->addWidget(force_);
  force_->setObjectName(QStringLiteral("press_force"));
  force_->setToolTip(tr("How hard the tool is pressed onto the surface"));
  connect(force_, &ValueRow::edited, this, &ToolPanel::forceEdited);
  setTool({});
}

void ToolPanel::setTool(const ToolChoice& choice) {
  const auto& cards = toolCards();
  const auto card = std::find_if(cards.begin(), cards.end(),
                                 [&](const ToolCard& c) { return c.choice == choice; });
  if (card != cards.end()) setTitle(card->words);
  force_->setVisible(choice.handling == Handling::press);
  QString words;
  for (const auto& [what, does] : linesOf(choice.handling))
    words += QStringLiteral("<p style='margin:2px 0'><b>%1</b> %2</p>").arg(what, does);
  words_->setText(words);
}

void ToolPanel::setForce(double newtons) {
  force_->setValue(newtons);
}

} // namespace patina

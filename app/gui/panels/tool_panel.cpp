#include "app/gui/panels/tool_panel.h"

#include <algorithm>

#include <QVBoxLayout>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

using Lines = std::vector<std::pair<QString, QString>>;

Lines linesOf(InteractionMode handling) {
  switch (handling) {
  case InteractionMode::feel:
    return {{tr("Left drag"), tr("moves the tip in the plane you look at")},
            {tr("Wheel"), tr("moves it away from you, and back")},
            {tr("Double click"), tr("sets it onto the surface")},
            {tr("Shift + left drag"), tr("turns the camera")}};
  case InteractionMode::press:
    return {{tr("Left drag"), tr("presses on the surface under the pointer")},
            {tr("Wheel"), tr("sets the force")},
            {tr("Shift + left drag"), tr("turns the camera")},
            {tr("Ctrl + wheel"), tr("zooms")}};
  case InteractionMode::measure:
    return {{tr("Click"), tr("sets a point; near a vertex the vertex")},
            {tr("Left drag"), tr("turns the camera")},
            {tr("Wheel"), tr("zooms")}};
  case InteractionMode::pin:
    return {{tr("Click"), tr("pins the values of what is in front")},
            {tr("Left drag"), tr("turns the camera")},
            {tr("Wheel"), tr("zooms")}};
  case InteractionMode::pick:
    return {{tr("Click"), tr("copies the paint at that point to the brush")}};
  default:
    return {{tr("Left drag"), tr("turns the camera")},
            {tr("Wheel"), tr("zooms")},
            {tr("Middle drag"), tr("shifts the camera")}};
  }
}

} // namespace

ToolPanel::ToolPanel(QWidget* parent)
    : QGroupBox(parent),
      force_(new ValueRow(tr("Pressing force"), QStringLiteral("N"), {0.1, 3, 0.1, 1}, this)) {
  auto* column = layoutIn<QVBoxLayout>(this);
  words_ = addNote(column, "tool_words");
  column->addWidget(named(force_, "press_force", tr("Pressing force of the tool")));
  connect(force_, &ValueRow::edited, this, &ToolPanel::forceEdited);
  setTool({});
}

void ToolPanel::setTool(const ToolChoice& choice) {
  const auto& cards = toolCards();
  const auto card = std::find_if(cards.begin(), cards.end(),
                                 [&](const ToolCard& c) { return c.choice == choice; });
  if (card != cards.end()) setTitle(card->words);
  force_->setVisible(choice.handling == InteractionMode::press);
  QString words;
  for (const auto& [what, does] : linesOf(choice.handling))
    words += QStringLiteral("<p style='margin:2px 0'><b>%1</b> %2</p>").arg(what, does);
  say(words_, words);
}

} // namespace patina

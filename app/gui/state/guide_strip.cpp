#include "app/gui/state/guide_strip.h"

#include <QHBoxLayout>
#include <QSettings>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"
#include "core/numbers.h"

namespace patina {
namespace {

const QString kClosed = QStringLiteral("guide/closed");

QString counted(std::size_t count, const QString& words) {
  return count == 0 ? QString() : shownText(formatCount(count)) + ' ' + words;
}

} // namespace

std::vector<GuideStep> guideSteps(const GuideFacts& facts) {
  return {
      {Desk::scan, tr("Scan"), tr("Open a scan, or record one"),
       facts.frames > 0 ? counted(facts.frames, tr("frames")) : counted(facts.poses, tr("poses")),
       facts.frames + facts.poses > 0},
      {Desk::scan, tr("Path"), tr("The frames are tracked, and the poses are filtered to a path"),
       counted(facts.samples, tr("samples")), facts.samples > 0},
      {Desk::align, tr("Place"),
       facts.off && !facts.doubt.isEmpty()
           ? facts.doubt
           : tr("Align the path with the mesh, and fit it. Figure: rms distance of the inliers"),
       facts.off
           ? tr("%1 off%2")
                 .arg(inWords(*facts.off), facts.doubt.isEmpty() ? QString() : tr(", uncertain"))
           : QString(),
       facts.off && facts.doubt.isEmpty()},
      {Desk::texture, tr("Texture"),
       tr("Make a texture from the scan, or map one along a path that you draw"),
       counted(facts.faces, tr("faces")), facts.faces > 0},
      {Desk::feel, tr("Feel"), tr("Touch it"),
       facts.force > 0 ? QStringLiteral("%1 N").arg(facts.force, 0, 'f', 2) : QString(),
       facts.faces > 0 && facts.force > 0}};
}

GuideStrip::GuideStrip(QWidget* parent)
    : QWidget(parent), open_(!QSettings().value(kClosed).toBool()) {
  setObjectName(QStringLiteral("guide_strip"));
  auto* line = new QHBoxLayout(this);
  line->setContentsMargins(6, 2, 4, 2);
  line->setSpacing(2);
  for (const GuideStep& step : guideSteps({})) {
    if (!steps_.empty()) line->addWidget(new QLabel(QStringLiteral("›")));
    auto* button = new QToolButton;
    button->setObjectName(QStringLiteral("guide_%1").arg(steps_.size()));
    button->setAutoRaise(true);
    line->addWidget(button);
    steps_.push_back(button);
    connect(button, &QToolButton::clicked, this, [this, desk = step.desk] { emit chosen(desk); });
  }
  line->addStretch(1);
  auto* cross = addButton<QToolButton>(line, "guide_close", QStringLiteral("✕"),
                                       tr("Hides the guide; the menu View shows it again"), this,
                                       [this] { setOpen(false); });
  cross->setAutoRaise(true);
  show({}, false);
}

void GuideStrip::show(const GuideFacts& facts, bool here) {
  here_ = here;
  if (isHidden() == (open_ && here_)) setVisible(open_ && here_);
  if (shown_ == facts) return;
  shown_ = facts;
  const std::vector<GuideStep> steps = guideSteps(facts);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const GuideStep& step = steps[i];
    const QString mark = step.done ? QStringLiteral("✓") : QStringLiteral("○");
    steps_[i]->setText(step.figure.isEmpty()
                           ? mark + ' ' + step.words
                           : QStringLiteral("%1 %2: %3").arg(mark, step.words, step.figure));
    steps_[i]->setToolTip(step.tip);
  }
}

void GuideStrip::setOpen(bool open) {
  if (open == open_) return;
  open_ = open;
  QSettings().setValue(kClosed, !open);
  setVisible(open_ && here_);
  emit openChanged(open_);
}

} // namespace patina

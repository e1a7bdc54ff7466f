#include "app/gui/loading/notice_bar.h"

#include <QHBoxLayout>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"

namespace patina {

NoticeBar::NoticeBar(const char* name, int margin, const std::vector<Button>& buttons) {
  setAttribute(Qt::WA_StyledBackground);
  setObjectName(QString::fromUtf8(name));
  applyStyleSheet(*this, QStringLiteral("#%1 { background: @notice; }").arg(objectName()));
  auto* line = new QHBoxLayout(this);
  line->setContentsMargins(6, margin, 4, margin);
  line->addWidget(words_, 1);
  for (const Button& button : buttons) addButton(line, button.name, button.words, button.tip);
}

} // namespace patina

#include "app/gui/loading/recover_bar.h"

#include <QDateTime>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLocale>
#include <QPushButton>

#include "app/gui/window/theme.h"

namespace patina {

RecoverBar::RecoverBar(QWidget* parent) : QWidget(parent), words_(new ElidedLabel(this)) {
  setAttribute(Qt::WA_StyledBackground);
  setObjectName(QStringLiteral("recover_bar"));
  dress(*this, QStringLiteral("#recover_bar { background: @notice; }"));
  auto* line = new QHBoxLayout(this);
  line->setContentsMargins(6, 0, 4, 0);
  line->addWidget(words_, 1);
  const auto button = [&](const char* name, const QString& words, const QString& tip, auto asked) {
    auto* made = new QPushButton(words, this);
    made->setObjectName(QString::fromUtf8(name));
    made->setToolTip(tip);
    line->addWidget(made);
    connect(made, &QPushButton::clicked, this, asked);
  };
  button("recover", tr("Recover"), tr("Open it; save it where you like"),
         &RecoverBar::recoverAsked);
  button("forget", tr("Delete"), tr("Remove it for good"), &RecoverBar::forgetAsked);
  button("later", tr("Not now"), tr("It is offered again at the next start"),
         &RecoverBar::laterAsked);
}

void RecoverBar::setPlace(const std::filesystem::path& place) {
  const QFileInfo info(QString::fromStdString((place / "scene.patina").string()));
  words_->setText(tr("Patina ended unexpectedly. A scene that was in no folder is still there, "
                     "from %1.")
                      .arg(QLocale().toString(info.lastModified(), QLocale::ShortFormat)));
}

} // namespace patina

#include "app/gui/loading/recover_bar.h"

#include <QDateTime>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLocale>
#include <QPushButton>

#include "core/error.h"
#include "session/store/autosave.h"

namespace patina {

RecoverBar::RecoverBar(QWidget* parent) : QWidget(parent), words_(new QLabel(this)) {
  setAttribute(Qt::WA_StyledBackground);
  setObjectName(QStringLiteral("recover_bar"));
  setStyleSheet(QStringLiteral("#recover_bar { background: #e3eefa; }"));
  auto* line = new QHBoxLayout(this);
  line->setContentsMargins(10, 5, 10, 5);
  words_->setWordWrap(true);
  line->addWidget(words_, 1);
  const auto button = [&](const char* name, const QString& words, const QString& tip, auto act) {
    auto* made = new QPushButton(words, this);
    made->setObjectName(QString::fromUtf8(name));
    made->setToolTip(tip);
    line->addWidget(made);
    connect(made, &QPushButton::clicked, this, act);
  };
  button("recover", tr("Recover"), tr("Open it; save it where you like"), [this] {
    const std::filesystem::path place = places_.front();
    next();
    emit recoverAsked(place);
  });
  button("forget", tr("Delete"), tr("Remove it for good"), [this] {
    try {
      Autosave::adopt(places_.front())->own(); // and let it go
    } catch (const Error&) {                   // another program has taken it meanwhile
    }
    next();
  });
  button("later", tr("Not now"), tr("It is offered again at the next start"), [this] { next(); });
  hide();
}

void RecoverBar::offer(std::vector<std::filesystem::path> places) {
  places_ = std::move(places);
  showFirst();
}

void RecoverBar::next() {
  places_.erase(places_.begin());
  showFirst();
}

void RecoverBar::showFirst() {
  setVisible(!places_.empty());
  if (places_.empty()) return;
  const QFileInfo info(QString::fromStdString((places_.front() / "scene.patina").string()));
  words_->setText(tr("Patina ended unexpectedly. A scene that was in no folder is still there, "
                     "from %1.")
                      .arg(QLocale().toString(info.lastModified(), QLocale::ShortFormat)));
}

} // namespace patina

#include "app/gui/loading/load_bar.h"

#include <cmath>

#include <QHBoxLayout>

#include "app/gui/toolkit/card.h"

namespace patina {

LoadBar::LoadBar(QWidget* parent)
    : QWidget(parent), words_(new ElidedLabel(this)), bar_(new QProgressBar(this)),
      cancel_(new QPushButton(tr("Cancel"), this)) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(6, 0, 4, 0);
  layout->addWidget(words_, 2);
  layout->addWidget(bar_, 1);
  layout->addWidget(cancel_);
  named(cancel_, "cancel_load", tr("Cancel; what was open stays open"));
  connect(cancel_, &QPushButton::clicked, this, [this] {
    words_->setText(tr("Cancelling…"));
    cancel_->setEnabled(false);
    emit cancelled();
  });
  delay_.setSingleShot(true);
  delay_.setInterval(500);
  connect(&delay_, &QTimer::timeout, this, &QWidget::show);
  hide();
}

void LoadBar::setWork(const std::optional<TaskProgress>& work) {
  if (!work) {
    title_.clear();
    delay_.stop();
    return hide();
  }
  if (work->title != title_) {
    title_ = work->title;
    cancel_->setEnabled(work->fraction >= 0);
    words_->setText(work->words);
    setVisible(!work->delayed);
    work->delayed ? delay_.start() : delay_.stop();
  }
  if (cancel_->isEnabled()) words_->setText(work->words);
  bar_->setRange(0, work->fraction < 0 ? 0 : 1000);
  bar_->setValue(static_cast<int>(std::lround(1000 * work->fraction)));
}

} // namespace patina

#include "app/gui/loading/load_bar.h"

#include <cmath>

#include <QHBoxLayout>

namespace patina {

LoadBar::LoadBar(QWidget* parent)
    : QWidget(parent), words_(new QLabel(this)), bar_(new QProgressBar(this)),
      cancel_(new QPushButton(tr("Cancel"), this)) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(10, 5, 10, 5);
  layout->addWidget(words_);
  layout->addWidget(bar_, 1);
  layout->addWidget(cancel_);
  bar_->setRange(0, 1000);
  cancel_->setObjectName(QStringLiteral("cancel_load"));
  connect(cancel_, &QPushButton::clicked, this, [this] {
    words_->setText(tr("Cancelling…"));
    cancel_->setEnabled(false);
    emit cancelled();
  });
  patience_.setSingleShot(true);
  patience_.setInterval(500);
  connect(&patience_, &QTimer::timeout, this, &QWidget::show);
  hide();
}

void LoadBar::begin(const QString& words, const QString& name, bool later) {
  name_ = name;
  on_ = true;
  hide();
  words_->setText(words);
  bar_->setValue(0);
  bar_->setRange(0, 1000);
  cancel_->setEnabled(true);
  if (later)
    patience_.start();
  else
    show();
}

void LoadBar::report(double fraction, const QString& what) {
  if (cancel_->isEnabled()) words_->setText(QStringLiteral("%1: %2").arg(name_, what));
  bar_->setValue(static_cast<int>(std::lround(1000 * fraction)));
}

void LoadBar::showClosing() {
  words_->setText(tr("Closing when the file that is being read is done…"));
  bar_->setRange(0, 0);
  cancel_->setEnabled(false);
  show();
}

void LoadBar::end() {
  on_ = false;
  patience_.stop();
  hide();
}

} // namespace patina

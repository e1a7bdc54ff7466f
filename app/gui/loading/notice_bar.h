// A line on a coloured ground that says what has happened, with buttons. It blocks nothing.
#pragma once

#include <vector>

#include <QPushButton>

#include "app/gui/toolkit/elided_label.h"

namespace patina {

class NoticeBar : public QWidget {
 public:
  struct Button {
    const char* name;
    QString words, tip;
  };
  NoticeBar(const char* name, int margin, const std::vector<Button>& buttons);

  void setWords(const QString& words) { words_->setText(words); }
  QPushButton* button(const char* name) const {
    return findChild<QPushButton*>(QString::fromUtf8(name));
  }

 private:
  ElidedLabel* words_ = new ElidedLabel;
};

} // namespace patina

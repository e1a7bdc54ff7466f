// A strip of tab buttons with a body, which a second click on the active button folds.
#pragma once

#include <QBoxLayout>
#include <QButtonGroup>
#include <QToolButton>
#include <QWidget>

namespace patina {

class FoldingTabs : public QWidget {
  Q_OBJECT
 public:
  // Down: the strip is a line above. Aside: it becomes a column of icons when folded.
  enum class Folds { down, aside };
  FoldingTabs(Folds folds, QWidget* body, QWidget* parent = nullptr);

  void add(int id, const QString& name, const QIcon& icon, const QString& words,
           const QString& tip);
  // Takes the space after the buttons.
  void addToStrip(QWidget* widget) { row_->addWidget(widget, 1000); }
  void setThere(int id, bool there) { buttons_->button(id)->setVisible(there); }
  void setInFront(int id) {
    in_front_ = id;
    arrange();
  }
  void setFolded(bool folded) {
    folded_ = folded;
    arrange();
  }
  bool folded() const { return folded_; }

 signals: // Sent for the user's clicks only.
  void chosen(int id);
  void foldRequested(bool folded);

 private:
  void click(int id);
  void arrange();

  Folds folds_;
  QWidget* strip_;
  QBoxLayout* row_;
  QButtonGroup* buttons_;
  QWidget* body_;
  int in_front_ = -1;
  bool folded_ = false;
};

} // namespace patina

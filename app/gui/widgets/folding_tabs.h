// A body behind a strip of buttons, one of which is on: a second click on it folds the body away
// and leaves the strip. Who owns it shows in the body what belongs to the button.
#pragma once

#include <map>

#include <QBoxLayout>
#include <QButtonGroup>
#include <QToolButton>
#include <QWidget>

namespace patina {

class FoldingTabs : public QWidget {
  Q_OBJECT
 public:
  // The strip is a line on top; aside, it folds to a column of icons.
  enum class Folds { down, aside };
  FoldingTabs(Folds folds, QWidget* body, QWidget* parent = nullptr);

  void add(int id, const QString& name, const QIcon& icon, const QString& words,
           const QString& tip);
  void addToStrip(QWidget* widget); // takes the room behind the buttons
  void setThere(int id, bool there);
  void setInFront(int id);
  void setFolded(bool folded);
  bool folded() const { return folded_; }

 signals: // by a person
  void chosen(int id);
  void foldAsked(bool folded);

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

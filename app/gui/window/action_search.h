// Searches the actions of the menus and the settings of the side panel by their words.
#pragma once

#include <functional>
#include <vector>

#include <QDialog>
#include <QLineEdit>
#include <QListWidget>
#include <QMainWindow>

#include "app/gui/state/desk.h"

namespace patina {

QString withoutMarks(QString words); // Words of a menu without '&' and '…'.

// Lists what contains all typed words, with its key; what is not there now is grey. Return or a
// click triggers an action, or shows a setting and gives it the focus; Esc closes.
class ActionSearch final : public QDialog {
 public:
  struct Settings {
    Panel panel;
    QWidget* widget;
    bool is_there; // on some desk
  };
  // show: brings a panel of the side panel in front.
  ActionSearch(QMainWindow& window, const std::vector<Settings>& panels,
               const std::function<void(Panel)>& show);

 protected:
  bool eventFilter(QObject*, QEvent* event) override;

 private:
  struct Found {
    QString words, key;
    bool enabled;
    std::function<void()> act;
  };
  void collect(const QMenu& menu, const QString& above);
  void collect(const Settings& settings, const std::function<void(Panel)>& show);
  void find(const QString& typed);
  void act();

  std::vector<Found> all_;
  QLineEdit* line_;
  QListWidget* list_;
};

} // namespace patina

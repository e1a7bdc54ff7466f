// Saves what is open, with the questions that belong to that.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <utility>

#include <QObject>

#include "app/gui/control/edit_controller.h"
#include "app/gui/panels/message_panel.h"
#include "app/gui/window/background.h"

namespace patina {

class SaveController : public QObject {
  Q_OBJECT
 public:
  SaveController(QWidget& window, EditController& edits, QObject* parent);

  QString name() const;                               // of what is open; empty: nothing is
  void setName(const QString& name) { name_ = name; } // until it is in a folder
  bool save();                                        // false: nothing was saved
  bool saveDialog();                                  // the same, into a folder that is asked for
  void exportDialog();                  // for ParaView, into a folder that is asked for
  void exportTo(const QString& folder); // after those that are under way
  void saveTo(const QString& folder);   // events go on until it is there; throws Error
  // What else is lost with the scene, settled before its edits.
  struct Beside {
    std::function<bool()> is_kept = [] { return true; };
    std::function<bool()> settle = [] { return true; }; // false: the person goes on
  };
  void setBeside(Beside beside) { beside_ = std::move(beside); }
  bool hasUnsaved() const;
  bool settleEdits(); // saved or dropped; false: the person goes on

 signals:
  void said(const patina::Message& message);
  void saved(const QString& folder); // a new one

 private:
  void discard(); // what was edited since it was saved
  bool trySaving(const std::function<void()>& save, const QString& where, const QString& advice);

  QWidget& window_; // which questions are asked over
  EditController& edits_;
  QString name_;
  Beside beside_;
  void exportNext();

  Background exports_;
  std::deque<std::pair<QString, std::shared_ptr<const CompiledScene>>> waiting_; // to be exported
};

} // namespace patina

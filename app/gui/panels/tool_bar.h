// The tools at the left edge; one is checked.
#pragma once

#include <QActionGroup>
#include <QMenu>
#include <QToolBar>
#include <QToolButton>

#include "app/gui/state/desk.h"

namespace patina {

class ToolBar : public QToolBar {
  Q_OBJECT
 public:
  explicit ToolBar(QWidget* parent = nullptr);

  const ToolChoice& choice() const { return choice_; }
  void choose(const ToolChoice& choice); // Sends chosen() if it changes.
  void toggleNavigation();               // Switches between the camera and the last tool.
  void setDesk(Desk desk);               // Shows the desk's tools; keys choose the others, too.
  void setPaints(bool can);              // Painting needs a scene.
  QList<QAction*> actionsOfTools() const { return group_->actions(); }

 signals:
  void chosen(const patina::ToolChoice& choice);

 private:
  QAction* actionOf(const ToolChoice& choice) const;

  QActionGroup* group_;
  QToolButton* more_; // Shows the tool of its menu that was used last.
  QAction* more_action_;
  ToolChoice choice_, before_navigating_;
};

} // namespace patina

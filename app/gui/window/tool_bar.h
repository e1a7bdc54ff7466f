// The tools at the left edge: one is on.
#pragma once

#include <QActionGroup>
#include <QMenu>
#include <QToolBar>
#include <QToolButton>

#include "app/gui/window/desk.h"

namespace patina {

class ToolBar : public QToolBar {
  Q_OBJECT
 public:
  explicit ToolBar(QWidget* parent = nullptr);

  const ToolChoice& choice() const { return choice_; }
  void choose(const ToolChoice& choice); // sends chosen() if it changes
  void toggleNavigation();               // to the camera, and back to the tool
  void setDesk(Desk desk);               // whose tools are seen; keys choose the others, too
  void setPaints(bool can);              // without a scene there is nothing to paint on
  QList<QAction*> actionsOfTools() const { return group_->actions(); }

 signals:
  void chosen(const patina::ToolChoice& choice);

 private:
  QAction* actionOf(const ToolChoice& choice) const;

  QActionGroup* group_;
  QToolButton* more_; // shows the tool of its menu that was used last
  QAction* more_action_;
  ToolChoice choice_, before_navigating_;
};

} // namespace patina

// The desk that is up: which it is, its tool, and how a person has arranged it.
#pragma once

#include <map>
#include <set>

#include <QActionGroup>
#include <QObject>
#include <QSplitter>

#include "app/gui/widgets/folding_tabs.h"
#include "app/gui/window/desk_layout.h"
#include "app/gui/window/tool_bar.h"

namespace patina {

class DeskController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    ToolBar& tools;
    QSplitter& across; // the picture with its drawer, and the column
    QSplitter& down;   // the picture and its drawer
    FoldingTabs& column;
    FoldingTabs& drawer;
  };
  DeskController(const Parts& parts, QObject* parent);

  Desk desk() const { return desk_; }
  Tab tab() const { return layouts_.at(desk_).tab; }
  Panel page() const { return layouts_.at(desk_).page; }
  QList<QAction*> actions() const { return group_->actions(); }

  void choose(Desk desk);
  void open(Panel panel); // brings it to the front, wherever it is
  void foldColumn(bool folded);
  void foldDrawer(bool folded);
  void setNarrow(bool narrow); // there is no room for the column unless it is asked for
  void arrange();              // as the layout says

  // From here on what a person arranges is kept for the next session, as was done in the last one.
  void restore();
  void remember(const QWidget& window) const;

 signals:
  void changed();

 private:
  void takeTool(const ToolChoice& tool);
  void takeSizes();

  Parts at_;
  QActionGroup* group_;
  Desk desk_ = Desk::feel;
  std::map<Desk, DeskLayout> layouts_;
  std::map<Desk, ToolChoice> tools_; // that were last in hand there
  bool narrow_ = false;
  std::set<Desk> opened_; // whose column is, though there is no room
  bool keeps_ = false;
};

} // namespace patina

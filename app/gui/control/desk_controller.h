// The desk in front, the tool of each desk, and the layout that the user has given it.
#pragma once

#include <map>
#include <set>

#include <QActionGroup>
#include <QObject>
#include <QSize>
#include <QSplitter>

#include "app/gui/panels/tool_bar.h"
#include "app/gui/state/desk.h"
#include "app/gui/toolkit/folding_tabs.h"

namespace patina {

// The layout that the user has given each desk, stored between sessions.
struct DeskLayout {
  Tab tab;
  Panel page;
  int side_panel, bottom_panel; // Width and height when unfolded [px].
  bool side_panel_folded, bottom_panel_folded;
};

DeskLayout usualLayout(Desk desk);
DeskLayout rememberedLayout(Desk desk); // Returns the usual layout if none is stored.
void remember(Desk desk, const DeskLayout& layout);

struct WindowGeometry {
  QSize size{1280, 800};
  bool maximized = false;
  Desk desk = Desk::feel;
};
WindowGeometry rememberedPlace();
void remember(const WindowGeometry& place);

class DeskController : public QObject {
  Q_OBJECT
 public:
  struct Parts {
    ToolBar& tools;
    QSplitter& across; // The picture with the bottom panel, and the side panel.
    QSplitter& down;   // The picture and the bottom panel.
    FoldingTabs& side_panel;
    FoldingTabs& bottom_panel;
  };
  DeskController(const Parts& parts, QObject* parent);

  Desk desk() const { return desk_; }
  Tab tab() const { return layouts_.at(desk_).tab; }
  Panel page() const { return layouts_.at(desk_).page; }
  QList<QAction*> actions() const { return group_->actions(); }

  void choose(Desk desk);
  void open(Panel panel); // Brings it to the front, in either panel.
  void show(Panel panel); // The same, on another desk if this one lacks it.
  void foldSidePanel(bool folded);
  void foldBottomPanel(bool folded);
  void setNarrow(bool narrow); // Folds the side panel unless it is opened by hand.
  void arrange();              // Applies the layout.

  // Restores the layout of the last session. Later changes are stored for the next one.
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
  std::map<Desk, Tab> tab_before_;   // Before measuring or pinning began there.
  std::map<Desk, ToolChoice> tools_; // The last tool of each desk.
  bool narrow_ = false;
  std::set<Desk> opened_; // Desks whose side panel is open though the window is narrow.
  bool keeps_ = false;
};

} // namespace patina

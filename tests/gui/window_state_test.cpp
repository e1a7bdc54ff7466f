// Visible and enabled parts follow from the window's state alone.
#include "app/gui/state/window_state.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace patina {
namespace {

const std::vector<Panel> kPanels{
    Panel::recovery, Panel::tool,     Panel::measure, Panel::brush,    Panel::relief,
    Panel::touch,    Panel::objects,  Panel::mesh,    Panel::device,   Panel::display,
    Panel::colors,   Panel::forces,   Panel::energy,  Panel::history,  Panel::messages,
    Panel::timeline, Panel::findings, Panel::scan,    Panel::recorder, Panel::calibration};
const std::vector<Command> kCommands{Command::save, Command::save_as, Command::record,
                                     Command::undo, Command::redo,    Command::paint};

std::vector<Panel> thereIn(const WindowState& state) {
  std::vector<Panel> there;
  for (const Panel panel : kPanels)
    if (isThere(panel, state)) there.push_back(panel);
  return there;
}

std::vector<Panel> shownIn(const WindowState& state) {
  std::vector<Panel> shown;
  for (const Panel panel : kPanels)
    if (isShown(panel, state)) shown.push_back(panel);
  return shown;
}

std::vector<Command> enabledIn(const WindowState& state) {
  std::vector<Command> enabled;
  for (const Command command : kCommands)
    if (isEnabled(command, state)) enabled.push_back(command);
  return enabled;
}

WindowState withScene() {
  WindowState state;
  state.content = Content::scene;
  state.open = state.colored = true;
  return state;
}

TEST(WindowState, EmptyWindowShowsAndAllowsNothing) {
  EXPECT_EQ(thereIn({}), std::vector{Panel::messages});
  EXPECT_TRUE(enabledIn({}).empty());
  EXPECT_EQ(titleOf({}), QStringLiteral("Patina[*]"));
}

TEST(WindowState, PreviewShowsTheMeshAlone) {
  WindowState state;
  state.content = Content::preview;
  state.tool = {InteractionMode::paint, Tool::relief};
  state.relief = true;
  EXPECT_EQ(thereIn(state), (std::vector{Panel::mesh, Panel::display, Panel::messages}));
  EXPECT_EQ(tabsThere(state), (std::vector{Tab::object, Tab::show}));
  EXPECT_TRUE(enabledIn(state).empty());
}

TEST(WindowState, SceneBehindAPreviewCanBeSavedButNotPainted) {
  WindowState state = withScene();
  state.content = Content::preview;
  state.undoable = 1;
  EXPECT_EQ(enabledIn(state),
            (std::vector{Command::save, Command::save_as, Command::record, Command::undo}));
  EXPECT_FALSE(isThere(Panel::history, state));
}

TEST(WindowState, SceneShowsThePanelsOfEveryScene) {
  EXPECT_EQ(
      thereIn(withScene()),
      (std::vector{Panel::tool, Panel::touch, Panel::objects, Panel::mesh, Panel::device,
                   Panel::display, Panel::colors, Panel::forces, Panel::energy, Panel::messages}));
  EXPECT_EQ(shownIn(withScene()), (std::vector{Panel::touch, Panel::forces}));
  EXPECT_EQ(enabledIn(withScene()),
            (std::vector{Command::save, Command::save_as, Command::record, Command::paint}));
}

TEST(WindowState, BrushIsShownForPaintingTools) {
  WindowState state = withScene();
  state.desk = Desk::paint;
  for (const InteractionMode handling :
       {InteractionMode::navigate, InteractionMode::feel, InteractionMode::pick}) {
    state.tool = {handling, Tool::relief};
    EXPECT_FALSE(isThere(Panel::brush, state));
    EXPECT_FALSE(isThere(Panel::relief, state));
  }
  state.tool = {InteractionMode::paint, Tool::color};
  EXPECT_TRUE(isThere(Panel::brush, state));
  EXPECT_FALSE(isThere(Panel::relief, state));
  state.tool.tool = Tool::relief;
  EXPECT_TRUE(isThere(Panel::relief, state));
}

TEST(WindowState, MeasurementsAreShownForTheirToolsAndTheErrorMapsColoursForItsPath) {
  WindowState state = withScene();
  for (const InteractionMode handling : {InteractionMode::measure, InteractionMode::pin}) {
    state.tool = {handling, {}};
    for (const Desk desk : {Desk::feel, Desk::paint, Desk::analyse}) {
      state.desk = desk;
      EXPECT_TRUE(isThere(Panel::measure, state));
    }
  }
  state.tool = {InteractionMode::press, {}};
  EXPECT_FALSE(isThere(Panel::measure, state));
  state.desk = Desk::align;
  state.colored = true;
  EXPECT_FALSE(isThere(Panel::colors, state));
  state.path = true;
  EXPECT_TRUE(isThere(Panel::colors, state));
}

TEST(WindowState, ScenePropertiesAreShownForEveryTool) {
  WindowState state = withScene();
  state.relief = state.colored = true;
  EXPECT_TRUE(isThere(Panel::relief, state));
  EXPECT_TRUE(isThere(Panel::colors, state));
}

TEST(WindowState, HistoryIsShownWithItsFirstEditUndoneOrNot) {
  WindowState state = withScene();
  state.undoable = 1;
  EXPECT_TRUE(isThere(Panel::history, state));
  EXPECT_TRUE(isEnabled(Command::undo, state));
  EXPECT_FALSE(isEnabled(Command::redo, state));
  std::swap(state.undoable, state.redoable);
  EXPECT_TRUE(isThere(Panel::history, state));
  EXPECT_FALSE(isEnabled(Command::undo, state));
  EXPECT_TRUE(isEnabled(Command::redo, state));
}

TEST(WindowState, RecoveryIsOfferedOnEveryDesk) {
  WindowState state;
  for (const DeskRow& row : deskRows()) {
    state.desk = row.desk;
    state.recoverable_scenes.reset();
    EXPECT_FALSE(isShown(Panel::recovery, state));
    state.recoverable_scenes = "/some/where";
    EXPECT_TRUE(isShown(Panel::recovery, state));
  }
}

TEST(WindowState, StorageProblemOfTheSceneIsShownOnEveryDesk) {
  WindowState state = withScene();
  state.open = true;
  for (const DeskRow& row : deskRows()) {
    state.desk = row.desk;
    state.storage_problem.clear();
    EXPECT_FALSE(isShown(Panel::storage, state));
    state.storage_problem = QStringLiteral("the disk is full");
    EXPECT_TRUE(isShown(Panel::storage, state));
  }
  state.open = false;
  EXPECT_FALSE(isShown(Panel::storage, state));
}

TEST(WindowState, ScanHasItsPagesOnceOpen) {
  WindowState state;
  state.desk = Desk::scan;
  EXPECT_EQ(thereIn(state),
            (std::vector{Panel::messages, Panel::scan, Panel::recorder, Panel::calibration}));
  state.scan = true;
  EXPECT_EQ(pagesThere(state), (std::vector{Panel::timeline, Panel::findings, Panel::messages}));
  state.desk = Desk::feel;
  EXPECT_FALSE(isThere(Panel::timeline, state));
}

TEST(WindowState, ProfileShowsTheScanInFront) {
  WindowState state = withScene();
  state.desk = Desk::texture;
  state.tab = Tab::library;
  state.texture = true;
  EXPECT_FALSE(isThere(Panel::profile, state));
  state.tab = Tab::steps;
  EXPECT_TRUE(isThere(Panel::profile, state));
  state.texture = false;
  state.chosen_texture = true;
  EXPECT_FALSE(isThere(Panel::profile, state));
  state.tab = Tab::library;
  EXPECT_TRUE(isThere(Panel::profile, state));
}

TEST(WindowState, EmptyTabGivesWayToTheFirst) {
  WindowState state = withScene();
  state.desk = Desk::paint;
  state.tool = {InteractionMode::paint, Tool::color};
  state.tab = Tab::device; // Paint does not have it
  EXPECT_EQ(tabInFront(state), Tab::tool);
  EXPECT_TRUE(isShown(Panel::brush, state));
  state.page = Panel::history;
  EXPECT_EQ(pageInFront(state), Panel::forces);
  state.undoable = 1;
  EXPECT_EQ(pageInFront(state), Panel::history);
}

TEST(WindowState, EveryToolIsOnADeskAndIsKeptIfPossible) {
  const ToolChoice feel{InteractionMode::feel, {}}, color{InteractionMode::paint, Tool::color};
  for (const DeskRow& row : deskRows()) {
    EXPECT_TRUE(hasTool(row.desk, row.tool));
    const bool no_tool =
        row.desk == Desk::scan || row.desk == Desk::align || row.desk == Desk::texture;
    EXPECT_EQ(deskFor(feel, row.desk), no_tool ? Desk::feel : row.desk);
    EXPECT_EQ(deskFor(color, row.desk), Desk::paint);
  }
}

TEST(WindowState, EveryDeskShowsOnlyPanelsOfItsRow) {
  WindowState state = withScene();
  state.relief = state.colored = true;
  state.undoable = 1;
  for (const DeskRow& row : deskRows()) {
    state.desk = row.desk;
    for (const Tab tab : tabsThere(state)) {
      state.tab = tab;
      for (const Panel panel : shownIn(state)) {
        EXPECT_NE(std::find(row.panels.begin(), row.panels.end(), panel), row.panels.end());
        EXPECT_TRUE(inBottomPanel(panel) || tabOf(panel) == tab);
      }
    }
  }
}

TEST(WindowState, TitleBeginsWithTheOpenName) {
  WindowState state = withScene();
  state.name = QStringLiteral("cup");
  EXPECT_EQ(titleOf(state), QStringLiteral("cup[*] – Patina"));
  state.unsaved = true;
  EXPECT_EQ(titleOf(state), QStringLiteral("cup (never saved)[*] – Patina"));
  state.in_folder = true;
  EXPECT_EQ(titleOf(state), QStringLiteral("cup[*] – Patina"));
}

} // namespace
} // namespace patina

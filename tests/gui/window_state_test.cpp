// What is seen and allowed follows from the window's state alone.
#include "app/gui/window/window_state.h"

#include <vector>

#include <gtest/gtest.h>

namespace patina {
namespace {

const std::vector<Panel> kPanels{Panel::recovery, Panel::warnings, Panel::brush,  Panel::relief,
                                 Panel::touch,    Panel::display,  Panel::paint,  Panel::device,
                                 Panel::objects,  Panel::mesh,     Panel::history};
const std::vector<Command> kCommands{Command::save, Command::save_as, Command::record,
                                     Command::undo, Command::redo,    Command::paint};

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
  state.open = true;
  return state;
}

TEST(WindowState, AnEmptyWindowShowsAndAllowsNothing) {
  EXPECT_TRUE(shownIn({}).empty());
  EXPECT_TRUE(enabledIn({}).empty());
  EXPECT_EQ(titleOf({}), QStringLiteral("Patina[*]"));
}

TEST(WindowState, APreviewShowsTheMeshAlone) {
  WindowState state;
  state.content = Content::preview;
  state.tool = {Handling::paint, Tool::relief};
  state.relief = true;
  EXPECT_EQ(shownIn(state), (std::vector{Panel::display, Panel::mesh}));
  EXPECT_TRUE(enabledIn(state).empty());
}

TEST(WindowState, WhatStandsBehindAPreviewCanBeSavedAndIsNotPaintedOn) {
  WindowState state = withScene();
  state.content = Content::preview;
  state.undoable = 1;
  EXPECT_EQ(enabledIn(state),
            (std::vector{Command::save, Command::save_as, Command::record, Command::undo}));
  EXPECT_FALSE(isShown(Panel::history, state));
}

TEST(WindowState, ASceneShowsWhatEveryOneHas) {
  EXPECT_EQ(shownIn(withScene()), (std::vector{Panel::touch, Panel::display, Panel::device,
                                               Panel::objects, Panel::mesh}));
  EXPECT_EQ(enabledIn(withScene()),
            (std::vector{Command::save, Command::save_as, Command::record, Command::paint}));
}

TEST(WindowState, TheBrushIsThereForToolsThatPaint) {
  WindowState state = withScene();
  for (const Handling handling : {Handling::navigate, Handling::feel, Handling::pick}) {
    state.tool = {handling, Tool::relief};
    EXPECT_FALSE(isShown(Panel::brush, state));
    EXPECT_FALSE(isShown(Panel::relief, state));
  }
  state.tool = {Handling::paint, Tool::color};
  EXPECT_TRUE(isShown(Panel::brush, state));
  EXPECT_FALSE(isShown(Panel::relief, state));
  state.tool.tool = Tool::relief;
  EXPECT_TRUE(isShown(Panel::relief, state));
}

TEST(WindowState, WhatTheSceneHasIsShownWhateverTheTool) {
  WindowState state = withScene();
  state.relief = state.paint = true;
  EXPECT_TRUE(isShown(Panel::relief, state));
  EXPECT_TRUE(isShown(Panel::paint, state));
}

TEST(WindowState, AHistoryIsThereWithItsFirstEditUndoneOrNot) {
  WindowState state = withScene();
  state.undoable = 1;
  EXPECT_TRUE(isShown(Panel::history, state));
  EXPECT_TRUE(isEnabled(Command::undo, state));
  EXPECT_FALSE(isEnabled(Command::redo, state));
  std::swap(state.undoable, state.redoable);
  EXPECT_TRUE(isShown(Panel::history, state));
  EXPECT_FALSE(isEnabled(Command::undo, state));
  EXPECT_TRUE(isEnabled(Command::redo, state));
}

TEST(WindowState, BarsAboveThePictureAreThereWhileTheyHaveSomethingToSay) {
  WindowState state;
  state.warnings << QStringLiteral("the mesh is open");
  EXPECT_EQ(shownIn(state), std::vector{Panel::warnings});
  state.warnings.clear();
  state.left_behind = "/some/where";
  EXPECT_EQ(shownIn(state), std::vector{Panel::recovery});
}

TEST(WindowState, TheTitleBeginsWithWhatIsOpen) {
  WindowState state = withScene();
  state.name = QStringLiteral("cup");
  EXPECT_EQ(titleOf(state), QStringLiteral("cup[*] – Patina"));
}

} // namespace
} // namespace patina

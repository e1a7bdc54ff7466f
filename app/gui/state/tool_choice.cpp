#include "app/gui/state/tool_choice.h"

#include <vector>

#include "app/gui/toolkit/drawn_icon.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

// Icons, see drawnIcon().
constexpr const char* kNavigate =
    "ellipse 10 10 6 3; ellipse 10 10 3 6; fill text; ellipse 10 10 1.4 1.4";
constexpr const char* kFeel = "curve 2 15 6 15 7 17.5 10 17.5 13 17.5 14 15 18 15; round warm 1.8;"
                              "line 10 13 10 3.5; line 10 3 7.2 6.2; line 10 3 12.8 6.2";
constexpr const char* kPress = "curve 2 14 6 14 7 17.5 10 17.5 13 17.5 14 14 18 14;"
                               "round accent 1.8; line 10 3 10 13; line 10 14 7.2 10.8;"
                               "line 10 14 12.8 10.8";
constexpr const char* kBrush = "line 17 3 10 10; fill warm; square warm/130 1;"
                               "blob 10.8 9.2 7 8.6 6.2 12 3 16.6 8 17 12 15 12.2 10.8";
constexpr const char* kRelief = "fill #462b6cb0; curve 1.5 15 6 15 6 5 10 5 14 5 14 15 18.5 15;"
                                "round accent 1.6; line 10 12.5 10 8.5; line 10 8 8.3 9.9;"
                                "line 10 8 11.7 9.9";
constexpr const char* kSpring = "soft accent 1.7;"
                                "line 10 2 10 4.5 14.5 5.8 5.5 8.4 14.5 11 5.5 13.6 10 15.5 10 18;"
                                "square text 1.6; line 4 18 16 18";
constexpr const char* kBlockOnRoughGround =
    "fill #462b6cb0; box 5 5 9 7;"
    "line 2 16.4 4 13.4 6 16.4 8 13.4 10 16.4 12 13.4 14 16.4 16 13.4 18 16.4;"
    "round warm 1.6; line 7.5 8.5 12 8.5";
constexpr const char* kDashpot = "line 10 2 10 8; line 6.5 9 13.5 9;"
                                 "line 4.5 6 4.5 15 15.5 15 15.5 6; line 10 15 10 18";
constexpr const char* kRoughness =
    "line 2 12 4 9 6 13 8 7 10 12 12 10 14 14 16 8 18 12; line 2 16.5 18 16.5";
constexpr const char* kErase = "turn -40; fill #f0b8b0; box -7 -3.6 6 7.2 1;"
                               "fill card; box -1 -3.6 8 7.2 1; back; line 4 17.5 16 17.5";
constexpr const char* kPipette = "round text 3.6; line 13.5 6.5 16 4;"
                                 "round text 1.5; line 10.5 5.5 14.5 9.5; fill #5a2b6cb0;"
                                 "polygon 11.2 6.8 13.2 8.8 6 16 3.6 16.4 4 14";

constexpr const char* kRuler = "turn -35; fill #462b6cb0; box -9 -3.5 18 7 1; line -6 -3.5 -6 0;"
                               "line -3 -3.5 -3 -1.5; line 0 -3.5 0 0; line 3 -3.5 3 -1.5;"
                               "line 6 -3.5 6 0; back";
constexpr const char* kPin = "fill #46c8102e; ellipse 10 6.5 4 4; line 10 10.5 10 17.5;"
                             "ellipse 10 17.5 2.5 0.8";

// Icon and key of a channel's button, if it has its own.
struct Button {
  std::string_view tool;
  const char* icon;
  int key;
  bool in_overflow; // In the overflow menu.
};
constexpr Button kButtons[] = {{"stiffness", kSpring, Qt::Key_D, false},
                               {"friction", kBlockOnRoughGround, Qt::Key_G, false},
                               {"damping", kDashpot, Qt::Key_J, true},
                               {"roughness", kRoughness, Qt::Key_U, true}};

Button buttonOf(MaterialChannel channel) {
  const std::string_view tool = rowOf(channel).tool;
  for (const Button& button : kButtons)
    if (button.tool == tool) return button;
  return {tool, kBrush, 0, true};
}

const char* stepsOf(const ToolChoice& choice) {
  switch (choice.handling) {
  case InteractionMode::navigate:
    return kNavigate;
  case InteractionMode::feel:
    return kFeel;
  case InteractionMode::press:
    return kPress;
  case InteractionMode::pick:
    return kPipette;
  case InteractionMode::measure:
    return kRuler;
  case InteractionMode::pin:
    return kPin;
  case InteractionMode::paint:
    break;
  }
  if (const auto channel = channelOf(choice.tool)) return buttonOf(*channel).icon;
  if (choice.tool == Tool::color) return kBrush;
  return choice.tool == Tool::relief ? kRelief : kErase;
}

QString capitalized(std::string_view word) {
  QString text = shownText(word);
  return text.isEmpty() ? text : text.left(1).toUpper() + text.mid(1);
}

std::vector<ToolCard> makeCards() {
  const auto with = [](InteractionMode mode) { return ToolChoice{mode, {}}; };
  const auto paint = [](Tool tool) { return ToolChoice{InteractionMode::paint, tool}; };
  std::vector<ToolCard> cards = {
      {with(InteractionMode::navigate), "tool_navigate", tr("Navigate"),
       tr("Left drag turns the camera, the wheel zooms"), Qt::Key_A},
      {with(InteractionMode::press), "tool_press", tr("Press"),
       tr("Press on the surface under the pointer with constant force, which the wheel sets"),
       Qt::Key_Q},
      {with(InteractionMode::feel), "tool_feel", tr("Free tip"),
       tr("Left drag moves the tip, the wheel moves it in depth"), Qt::Key_V},
      {with(InteractionMode::measure), "tool_measure", tr("Measure"),
       tr("Click points: distance, angle, radius or painted area; a drag turns the camera"),
       Qt::Key_Y},
      {with(InteractionMode::pin), "tool_pin", tr("Pin"),
       tr("A click pins the values under the pointer; a drag turns the camera"), Qt::Key_Z},
      {paint(Tool::color), "tool_color", tr("Paint"), tr("Paint colour onto the surface"),
       Qt::Key_P},
      {paint(Tool::relief), "tool_relief", tr("Relief"),
       tr("Raise or engrave the surface; the relief is felt at once"), Qt::Key_H}};
  for (const Channel& row : kChannels) {
    if (firstOfTool(row.channel) != row.channel) continue;
    const Button button = buttonOf(row.channel);
    cards.push_back({paint(Tool::material(row.channel)), "tool_" + std::string(row.tool),
                     capitalized(row.tool), tr(row.tip), button.key, button.in_overflow});
  }
  cards.push_back({paint(Tool::erase), "tool_erase", tr("Erase"),
                   tr("Erase paint, all of it or one kind"), Qt::Key_X});
  cards.push_back({with(InteractionMode::pick), "tool_pick", tr("Eyedropper"),
                   tr("Copy the paint at a point to the brush; with Alt, any tool does this"),
                   Qt::Key_C});
  return cards;
}

} // namespace

const std::vector<ToolCard>& toolCards() {
  static const std::vector<ToolCard> kCards = makeCards();
  return kCards;
}

QIcon iconOf(const ToolChoice& choice) {
  return drawnIcon(stepsOf(choice));
}

QString captionOf(const Tool& tool) {
  if (const auto channel = channelOf(tool)) return tr(rowOf(*channel).caption);
  return tool == Tool::color    ? tr("colour")
         : tool == Tool::relief ? tr("relief")
                                : tr("everything");
}

std::optional<PaintQuantity> quantityOf(const ToolChoice& choice) {
  if (choice.handling != InteractionMode::paint || choice.tool == Tool::erase) return std::nullopt;
  if (choice.tool == Tool::color) return PaintQuantity::color;
  if (choice.tool == Tool::relief) return PaintQuantity::relief;
  return quantityOf(*channelOf(choice.tool));
}

} // namespace patina

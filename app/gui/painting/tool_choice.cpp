#include "app/gui/painting/tool_choice.h"

#include <cmath>
#include <vector>

#include <QCoreApplication>
#include <QPainter>
#include <QPainterPath>

#include "app/gui/widgets/drawn_icon.h"
#include "app/gui/widgets/words.h"
#include "app/gui/window/theme.h"

namespace patina {
namespace {

// Every picture is drawn in a square of 20 units.
void drawNavigate(QPainter& p) {
  p.drawEllipse(QRectF(4, 7, 12, 6));
  p.drawEllipse(QRectF(7, 4, 6, 12));
  p.setBrush(ink("text"));
  p.drawEllipse(QPointF(10, 10), 1.4, 1.4);
}

void drawFeel(QPainter& p) {
  QPainterPath ground(QPointF(2, 15));
  ground.cubicTo(6, 15, 7, 17.5, 10, 17.5);
  ground.cubicTo(13, 17.5, 14, 15, 18, 15);
  p.drawPath(ground);
  p.setPen(QPen(ink("warm"), 1.8, Qt::SolidLine, Qt::RoundCap));
  p.drawLine(QPointF(10, 13), QPointF(10, 3.5));
  p.drawLine(QPointF(10, 3), QPointF(7.2, 6.2));
  p.drawLine(QPointF(10, 3), QPointF(12.8, 6.2));
}

void drawPress(QPainter& p) {
  QPainterPath ground(QPointF(2, 14));
  ground.cubicTo(6, 14, 7, 17.5, 10, 17.5);
  ground.cubicTo(13, 17.5, 14, 14, 18, 14);
  p.drawPath(ground);
  p.setPen(QPen(ink("accent"), 1.8, Qt::SolidLine, Qt::RoundCap));
  p.drawLine(QPointF(10, 3), QPointF(10, 13));
  p.drawLine(QPointF(10, 14), QPointF(7.2, 10.8));
  p.drawLine(QPointF(10, 14), QPointF(12.8, 10.8));
}

void drawBrush(QPainter& p) {
  p.drawLine(QPointF(17, 3), QPointF(10, 10));
  QPainterPath tip(QPointF(10.8, 9.2));
  tip.cubicTo(7, 8.6, 6.2, 12, 3, 16.6);
  tip.cubicTo(8, 17, 12, 15, 12.2, 10.8);
  tip.closeSubpath();
  p.setBrush(ink("warm"));
  p.setPen(QPen(ink("warm").darker(130), 1));
  p.drawPath(tip);
}

void drawRelief(QPainter& p) {
  QPainterPath hill(QPointF(1.5, 15));
  hill.cubicTo(6, 15, 6, 5, 10, 5);
  hill.cubicTo(14, 5, 14, 15, 18.5, 15);
  p.setBrush(QColor(0x2b, 0x6c, 0xb0, 70));
  p.drawPath(hill);
  p.setPen(QPen(ink("accent"), 1.6, Qt::SolidLine, Qt::RoundCap));
  p.drawLine(QPointF(10, 12.5), QPointF(10, 8.5));
  p.drawLine(QPointF(10, 8), QPointF(8.3, 9.9));
  p.drawLine(QPointF(10, 8), QPointF(11.7, 9.9));
}

void drawStiffness(QPainter& p) { // a spring
  QPolygonF line;
  line << QPointF(10, 2) << QPointF(10, 4.5);
  for (int i = 0; i < 4; ++i) line << QPointF(i % 2 ? 5.5 : 14.5, 5.8 + 2.6 * i);
  line << QPointF(10, 15.5) << QPointF(10, 18);
  p.setPen(QPen(ink("accent"), 1.7, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  p.drawPolyline(line);
  p.setPen(QPen(ink("text"), 1.6));
  p.drawLine(QPointF(4, 18), QPointF(16, 18));
}

void drawFriction(QPainter& p) { // a block on rough ground
  p.setBrush(QColor(0x2b, 0x6c, 0xb0, 70));
  p.drawRect(QRectF(5, 5, 9, 7));
  QPolygonF ground;
  for (int i = 0; i <= 8; ++i) ground << QPointF(2 + 2 * i, i % 2 ? 13.4 : 16.4);
  p.drawPolyline(ground);
  p.setPen(QPen(ink("warm"), 1.6, Qt::SolidLine, Qt::RoundCap));
  p.drawLine(QPointF(7.5, 8.5), QPointF(12, 8.5));
}

void drawDamping(QPainter& p) { // a dashpot
  p.drawLine(QPointF(10, 2), QPointF(10, 8));
  p.drawLine(QPointF(6.5, 9), QPointF(13.5, 9));
  p.drawPolyline(QPolygonF() << QPointF(4.5, 6) << QPointF(4.5, 15) << QPointF(15.5, 15)
                             << QPointF(15.5, 6));
  p.drawLine(QPointF(10, 15), QPointF(10, 18));
}

void drawRoughness(QPainter& p) {
  QPolygonF ground;
  const double heights[] = {12, 9, 13, 7, 12, 10, 14, 8, 12};
  for (int i = 0; i <= 8; ++i) ground << QPointF(2 + 2 * i, heights[i]);
  p.drawPolyline(ground);
  p.drawLine(QPointF(2, 16.5), QPointF(18, 16.5));
}

void drawErase(QPainter& p) {
  p.save();
  p.translate(10, 10);
  p.rotate(-40);
  p.setBrush(QColor(0xf0, 0xb8, 0xb0));
  p.drawRoundedRect(QRectF(-7, -3.6, 6, 7.2), 1, 1);
  p.setBrush(ink("card"));
  p.drawRoundedRect(QRectF(-1, -3.6, 8, 7.2), 1, 1);
  p.restore();
  p.drawLine(QPointF(4, 17.5), QPointF(16, 17.5));
}

void drawPick(QPainter& p) { // a pipette
  p.setPen(QPen(ink("text"), 3.6, Qt::SolidLine, Qt::RoundCap));
  p.drawLine(QPointF(13.5, 6.5), QPointF(16, 4));
  p.setPen(QPen(ink("text"), 1.5, Qt::SolidLine, Qt::RoundCap));
  p.drawLine(QPointF(10.5, 5.5), QPointF(14.5, 9.5));
  p.setBrush(QColor(0x2b, 0x6c, 0xb0, 90));
  p.drawPolygon(QPolygonF() << QPointF(11.2, 6.8) << QPointF(13.2, 8.8) << QPointF(6, 16)
                            << QPointF(3.6, 16.4) << QPointF(4, 14));
}

using Draw = void (*)(QPainter&);

// How a channel's button looks and is reached, where it has a picture or a key of its own.
struct Button {
  std::string_view tool; // of the channel
  Draw draw;
  int key;
  bool seldom; // in the small menu
};
constexpr Button kButtons[] = {{"stiffness", drawStiffness, Qt::Key_D, false},
                               {"friction", drawFriction, Qt::Key_G, false},
                               {"damping", drawDamping, Qt::Key_J, true},
                               {"roughness", drawRoughness, Qt::Key_U, true}};

Button buttonOf(MaterialChannel channel) {
  const std::string_view tool = rowOf(channel).tool;
  for (const Button& button : kButtons)
    if (button.tool == tool) return button;
  return {tool, drawBrush, 0, true};
}

Draw drawerOf(const ToolChoice& choice) {
  switch (choice.handling) {
  case Handling::navigate:
    return drawNavigate;
  case Handling::feel:
    return drawFeel;
  case Handling::press:
    return drawPress;
  case Handling::pick:
    return drawPick;
  case Handling::paint:
    break;
  }
  if (const auto channel = channelOf(choice.tool)) return buttonOf(*channel).draw;
  if (choice.tool == Tool::color) return drawBrush;
  return choice.tool == Tool::relief ? drawRelief : drawErase;
}

QString capitalized(std::string_view word) {
  QString text = QString::fromUtf8(word.data(), static_cast<int>(word.size()));
  return text.isEmpty() ? text : text.left(1).toUpper() + text.mid(1);
}

std::vector<ToolCard> makeCards() {
  const auto paint = [](Tool tool) { return ToolChoice{Handling::paint, tool}; };
  std::vector<ToolCard> cards = {{{Handling::navigate, {}},
                                  "tool_navigate",
                                  tr("Navigate"),
                                  tr("Left drag turns the camera, the wheel zooms"),
                                  Qt::Key_A},
                                 {{Handling::feel, {}},
                                  "tool_feel",
                                  tr("Feel"),
                                  tr("Left drag moves the tip, the wheel moves it in depth"),
                                  Qt::Key_V},
                                 {{Handling::press, {}},
                                  "tool_press",
                                  tr("Press"),
                                  tr("Press on the surface under the pointer with one force, "
                                     "which the wheel sets"),
                                  Qt::Key_Q},
                                 {paint(Tool::color), "tool_color", tr("Paint"),
                                  tr("Paint colour onto the surface"), Qt::Key_P},
                                 {paint(Tool::relief), "tool_relief", tr("Relief"),
                                  tr("Raise or engrave the surface, felt as it is painted"),
                                  Qt::Key_H}};
  for (const Channel& row : kChannels) {
    if (firstOfTool(row.channel) != row.channel) continue;
    const Button button = buttonOf(row.channel);
    cards.push_back({paint(Tool::material(row.channel)), "tool_" + std::string(row.tool),
                     capitalized(row.tool), tr(row.tip), button.key, button.seldom});
  }
  cards.push_back({paint(Tool::erase), "tool_erase", tr("Erase"),
                   tr("Take away what was painted, all of it or one kind"), Qt::Key_X});
  cards.push_back({{Handling::pick, {}},
                   "tool_pick",
                   tr("Eyedropper"),
                   tr("Take what is painted at a place into the brush; with Alt, any tool does"),
                   Qt::Key_C});
  return cards;
}

} // namespace

const std::vector<ToolCard>& toolCards() {
  static const std::vector<ToolCard> kCards = makeCards();
  return kCards;
}

QIcon iconOf(const ToolChoice& choice) {
  return drawnIcon(drawerOf(choice));
}

QString captionOf(const Tool& tool) {
  if (const auto channel = channelOf(tool)) return tr(rowOf(*channel).caption);
  return tool == Tool::color    ? tr("colour")
         : tool == Tool::relief ? tr("relief")
                                : tr("everything");
}

std::optional<PaintQuantity> quantityOf(const ToolChoice& choice) {
  if (choice.handling != Handling::paint || choice.tool == Tool::erase) return std::nullopt;
  if (choice.tool == Tool::color) return PaintQuantity::color;
  if (choice.tool == Tool::relief) return PaintQuantity::relief;
  return quantityOf(*channelOf(choice.tool));
}

} // namespace patina

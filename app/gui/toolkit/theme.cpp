#include "app/gui/toolkit/theme.h"

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <QFont>
#include <QPainter>
#include <QPalette>
#include <QProxyStyle>
#include <QRegularExpression>
#include <QStyleFactory>
#include <QStyleOption>
#include <QVariant>
#include <QWidget>

namespace patina {
namespace {

// Text has a contrast of at least 4.5 to its background; a test checks every pixel.
struct ThemeColor {
  const char *name, *light, *dark;
};
// Backgrounds: window, card, soft, and of white text strong and recording. Text: quiet for
// captions, faint for disabled items. line and accent are drawn lines.
constexpr ThemeColor kColors[] = {
    {"window", "#f1f3f6", "#23272e"},   {"card", "#ffffff", "#2b3038"},
    {"soft", "#f6f8fa", "#31363f"},     {"button", "#e8ebf0", "#3a414c"},
    {"hover", "#e0e6ee", "#434c59"},    {"chosen", "#cfe0f3", "#2d4a68"},
    {"notice", "#e3eefa", "#2b3f55"},   {"text", "#222832", "#e6e9ee"},
    {"quiet", "#5b6575", "#aab4c2"},    {"faint", "#5f6875", "#a9b3c1"},
    {"line", "#d5dae2", "#454d59"},     {"grip", "#c3cad5", "#5b6573"},
    {"strong", "#2b6cb0", "#2b6cb0"},   {"recording", "#b3261e", "#b3261e"},
    {"accent", "#2b6cb0", "#6cabe6"},   {"link", "#14568c", "#8fc1f0"},
    {"warm", "#cc4a2c", "#e8795c"},     {"warn", "#7a4f00", "#f0c060"},
    {"bad", "#a12a1a", "#ff9d8f"},      {"series_x", "#d55e00", "#f08030"},
    {"series_y", "#009e73", "#20c090"}, {"series_z", "#0072b2", "#56b4e9"},
    {"series_e", "#1f5ca8", "#7fb2f0"}};

// Fusion frames a box with a darker shade of its background, which is invisible on dark ones. It
// shades buttons, so that their text has uneven contrast.
class FlatControls final : public QProxyStyle {
 public:
  FlatControls() : QProxyStyle(QStyleFactory::create(QStringLiteral("Fusion"))) {}
  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override {
    if (element == PE_PanelButtonCommand) return drawButton(*option, *painter);
    QProxyStyle::drawPrimitive(element, option, painter, widget);
    if (element == PE_IndicatorCheckBox || element == PE_IndicatorRadioButton)
      drawFrame(*option, *painter, element == PE_IndicatorRadioButton);
  }

  // Draws no handle for splitters that cannot move.
  void drawControl(ControlElement element, const QStyleOption* option, QPainter* painter,
                   const QWidget* widget) const override {
    if (element != CE_Splitter || (option->state & State_Enabled))
      QProxyStyle::drawControl(element, option, painter, widget);
  }

 private:
  static QRectF frameOf(const QStyleOption& option) {
    return QRectF(option.rect).adjusted(0.5, 0.5, -0.5, -0.5);
  }
  static void drawButton(const QStyleOption& option, QPainter& painter) {
    const auto is = [&](State state) { return (option.state & state) != 0; };
    const bool enabled = is(State_Enabled);
    const auto* button = qstyleoption_cast<const QStyleOptionButton*>(&option);
    const bool by_return = button && (button->features & QStyleOptionButton::DefaultButton);
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setBrush(themeColor(is(State_Sunken | State_On)      ? "chosen"
                                : enabled && is(State_MouseOver) ? "hover"
                                                                 : "button"));
    painter.setPen(themeColor(!enabled                          ? "line"
                              : by_return || is(State_HasFocus) ? "accent"
                                                                : "grip"));
    painter.drawRoundedRect(frameOf(option), 3, 3);
    if (is(State_HasFocus)) painter.drawRoundedRect(frameOf(option).adjusted(2, 2, -2, -2), 2, 2);
    painter.restore();
  }
  static void drawFrame(const QStyleOption& option, QPainter& painter, bool round) {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing, round);
    painter.setBrush(Qt::NoBrush);
    painter.setPen(themeColor(option.state & State_Enabled ? "quiet" : "grip"));
    if (round)
      painter.drawEllipse(frameOf(option));
    else
      painter.drawRect(frameOf(option));
    painter.restore();
  }
};

constexpr const char* kSheet = "sheet"; // Property with the original style sheet.

bool isDark() {
  return QApplication::palette().color(QPalette::Window).lightness() < 128;
}

} // namespace

Theme systemTheme() {
  const QPalette ours = QApplication::palette();
  QApplication::setPalette(QPalette()); // Resets to the platform's palette.
  const Theme found = isDark() ? Theme::dark : Theme::light;
  if (ours.resolve() != 0) QApplication::setPalette(ours);
  return found;
}

QColor themeColor(const char* name) {
  const bool dark = isDark();
  for (const ThemeColor& row : kColors)
    if (std::string_view(name) == row.name) return {QLatin1String(dark ? row.dark : row.light)};
  throw std::invalid_argument(std::string("no theme colour is called ") + name);
}

const palette::BackgroundStyle& pictureGround() {
  return isDark() ? palette::kDark : palette::kLight;
}

void applyStyleSheet(QWidget& widget, const QString& sheet) {
  static const QRegularExpression kName(QStringLiteral("@([a-z_]+)"));
  QString made = sheet;
  for (auto name = kName.match(made); name.hasMatch(); name = kName.match(made))
    made.replace(name.capturedStart(), name.capturedLength(),
                 themeColor(name.captured(1).toUtf8().constData()).name());
  widget.setProperty(kSheet, sheet);
  if (widget.styleSheet() != made) widget.setStyleSheet(made);
}

void applyCardStyle(QWidget& widget) {
  applyStyleSheet(
      widget,
      QStringLiteral("QGroupBox { background: @card; border: 1px solid @line;"
                     " border-radius: 6px; margin-top: 22px; padding: 6px 8px 6px 8px; }"
                     "QGroupBox::title { subcontrol-origin: margin; left: 2px; top: 2px;"
                     " color: @text; font-weight: bold; }"
                     "QScrollBar:vertical { width: 10px; border: none; background: transparent; }"
                     "QScrollBar::handle:vertical { background: @grip; border-radius: 4px;"
                     " min-height: 24px; margin: 1px; }"
                     "QScrollBar::handle:vertical:disabled { background: transparent; }"
                     "QScrollBar::add-line:vertical, QScrollBar::sub-line:vertical { height: 0; }"
                     "QLabel[quiet=\"true\"] { color: @quiet; }"
                     "QLabel[bad=\"true\"] { color: @bad; }"));
}

void applyStyle(QApplication& application, Theme theme) {
  application.setStyle(new FlatControls);
  QPalette palette(
      QColor(QLatin1String(theme == Theme::dark ? kColors[0].dark : kColors[0].light)));
  application.setPalette(palette); // This sets the theme of themeColor().
  const std::pair<QPalette::ColorRole, const char*> roles[] = {{QPalette::Window, "window"},
                                                               {QPalette::WindowText, "text"},
                                                               {QPalette::Base, "card"},
                                                               {QPalette::AlternateBase, "soft"},
                                                               {QPalette::Text, "text"},
                                                               {QPalette::Button, "button"},
                                                               {QPalette::ButtonText, "text"},
                                                               {QPalette::ToolTipBase, "card"},
                                                               {QPalette::ToolTipText, "text"},
                                                               {QPalette::Highlight, "strong"},
                                                               {QPalette::PlaceholderText, "quiet"},
                                                               {QPalette::Link, "link"}};
  for (const auto& [role, name] : roles) palette.setColor(role, themeColor(name));
  palette.setColor(QPalette::HighlightedText, Qt::white);
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    palette.setColor(QPalette::Disabled, role, themeColor("faint"));
  application.setPalette(palette);
  QFont font = application.font();
  font.setPointSizeF(9);
  application.setFont(font);
  for (QWidget* widget : QApplication::allWidgets())
    if (const QVariant sheet = widget->property(kSheet); sheet.isValid())
      applyStyleSheet(*widget, sheet.toString());
}

} // namespace patina

#include "app/gui/window/window_style.h"

#include <QFont>
#include <QPalette>
#include <QStyleFactory>

namespace patina {

QColor toQColor(const palette::Color& color) {
  return QColor::fromRgbF(color[0], color[1], color[2]);
}

QString cardStyle() {
  return QStringLiteral(
      "QGroupBox { background: #ffffff; border: 1px solid #d5dae2;"
      " border-radius: 6px; margin-top: 22px; padding: 6px 8px 6px 8px; }"
      "QGroupBox::title { subcontrol-origin: margin; left: 2px; top: 2px;"
      " color: #2a3240; font-weight: bold; }"
      "QScrollBar:vertical { width: 10px; border: none; background: transparent; }"
      "QScrollBar::handle:vertical { background: #c3cad5; border-radius: 4px;"
      " min-height: 24px; margin: 1px; }"
      "QScrollBar::handle:vertical:disabled { background: transparent; }"
      "QScrollBar::add-line:vertical, QScrollBar::sub-line:vertical { height: 0; }"
      "QLabel[quiet=\"true\"] { color: #5b6575; }"
      "QLabel[bad=\"true\"] { color: #a12a1a; }");
}

void applyStyle(QApplication& application) {
  application.setStyle(QStyleFactory::create("Fusion"));
  QPalette palette;
  palette.setColor(QPalette::Window, QColor(0xf1, 0xf3, 0xf6));
  palette.setColor(QPalette::WindowText, QColor(0x22, 0x28, 0x32));
  palette.setColor(QPalette::Base, Qt::white);
  palette.setColor(QPalette::AlternateBase, QColor(0xf6, 0xf8, 0xfa));
  palette.setColor(QPalette::Text, QColor(0x22, 0x28, 0x32));
  palette.setColor(QPalette::Button, QColor(0xe8, 0xeb, 0xf0));
  palette.setColor(QPalette::ButtonText, QColor(0x22, 0x28, 0x32));
  palette.setColor(QPalette::ToolTipBase, QColor(0xff, 0xff, 0xf2));
  palette.setColor(QPalette::ToolTipText, QColor(0x22, 0x28, 0x32));
  palette.setColor(QPalette::Highlight, QColor(0x2b, 0x6c, 0xb0));
  palette.setColor(QPalette::HighlightedText, Qt::white);
  palette.setColor(QPalette::Link, QColor(0x2b, 0x6c, 0xb0));
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
    palette.setColor(QPalette::Disabled, role, QColor(0x9a, 0xa3, 0xb0));
  application.setPalette(palette);
  QFont font = application.font();
  font.setPointSizeF(9);
  application.setFont(font);
}

} // namespace patina

#include "app/gui/painting/color_choice.h"

#include <QColorDialog>
#include <QVBoxLayout>

#include "app/gui/painting/recent_colors.h"
#include "app/gui/panels/form.h"
#include "app/gui/window/theme.h"

namespace patina {
namespace {

constexpr int kWide = 21, kHigh = 22;
constexpr std::array<ColorChoice::Color, 8> kSwatches{{{0.80, 0.22, 0.16},
                                                       {0.93, 0.55, 0.13},
                                                       {0.95, 0.83, 0.30},
                                                       {0.29, 0.58, 0.28},
                                                       {0.16, 0.52, 0.65},
                                                       {0.20, 0.29, 0.62},
                                                       {0.96, 0.96, 0.94},
                                                       {0.14, 0.15, 0.18}}};

QColor qColor(const ColorChoice::Color& color) {
  return QColor::fromRgbF(color[0], color[1], color[2]);
}

void dressAsSwatch(QToolButton& button, const ColorChoice::Color& color, const char* border) {
  dress(button, QStringLiteral("QToolButton { background: %1; border: %2; border-radius: 3px; }"
                               "QToolButton:focus { border: 2px solid @text; }")
                    .arg(qColor(color).name(), QString::fromUtf8(border)));
}

QHBoxLayout* lineIn(QWidget& parent) {
  auto* line = new QHBoxLayout(&parent);
  line->setContentsMargins(0, 0, 0, 0);
  line->setSpacing(3);
  return line;
}

} // namespace

ColorChoice::ColorChoice(const Color& now, QWidget* parent)
    : QWidget(parent), color_(now), recent_(nullptr) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(4);
  auto* above = new QWidget(this);
  QHBoxLayout* line = lineIn(*above);
  now_ = swatch(*line, 40);
  now_->setObjectName(QStringLiteral("brush_color"));
  now_->setToolTip(tr("What is painted with; choose another colour…"));
  dressAsSwatch(*now_, color_, "2px solid @accent");
  connect(now_, &QToolButton::clicked, this, &ColorChoice::ask);
  for (const Color& color : kSwatches) offer(*swatch(*line, kWide), color);
  line->addStretch(1);
  column->addWidget(above);
  showRecent();
}

QToolButton* ColorChoice::swatch(QHBoxLayout& line, int wide) {
  auto* button = new QToolButton(this);
  button->setFixedSize(wide, kHigh);
  line.addWidget(button);
  return button;
}

void ColorChoice::offer(QToolButton& button, const Color& color) {
  dressAsSwatch(button, color, "1px solid @faint");
  button.setToolTip(tr("Paint with %1").arg(qColor(color).name()));
  connect(&button, &QToolButton::clicked, this, [this, color] { choose(color); });
}

void ColorChoice::choose(const Color& color) {
  color_ = color;
  dressAsSwatch(*now_, color, "2px solid @accent");
  emit chosen(color);
}

void ColorChoice::ask() {
  const QColor color = QColorDialog::getColor(qColor(color_), this, tr("Brush colour"));
  if (!color.isValid()) return;
  rememberColor(color);
  showRecent();
  choose({color.redF(), color.greenF(), color.blueF()});
}

// Nothing is there before a colour was chosen that is no swatch.
void ColorChoice::showRecent() {
  takeAway(recent_);
  recent_ = nullptr;
  const auto colors = recentColors();
  if (colors.empty()) return;
  recent_ = new QWidget(this);
  QHBoxLayout* line = lineIn(*recent_);
  auto* caption = new QLabel(tr("Last"), recent_);
  caption->setProperty("quiet", true);
  caption->setFixedWidth(40);
  line->addWidget(caption);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    QToolButton* button = swatch(*line, kWide);
    button->setObjectName(QStringLiteral("recent_color_%1").arg(i));
    offer(*button, {colors[i].redF(), colors[i].greenF(), colors[i].blueF()});
  }
  line->addStretch(1);
  layout()->addWidget(recent_);
}

} // namespace patina

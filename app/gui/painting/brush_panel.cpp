#include "app/gui/painting/brush_panel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QColorDialog>
#include <QHBoxLayout>
#include <QMenu>
#include <QToolButton>

#include "app/gui/painting/recent_colors.h"
#include "app/gui/state/tool_choice.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"
#include "authoring/brush/painter.h"

namespace patina {

namespace {

using Color = std::array<double, 3>; // sRGB

constexpr int kWide = 21, kHigh = 22;
constexpr std::array<Color, 8> kSwatches{{{0.80, 0.22, 0.16},
                                          {0.93, 0.55, 0.13},
                                          {0.95, 0.83, 0.30},
                                          {0.29, 0.58, 0.28},
                                          {0.16, 0.52, 0.65},
                                          {0.20, 0.29, 0.62},
                                          {0.96, 0.96, 0.94},
                                          {0.14, 0.15, 0.18}}};

QColor qColor(const Color& color) {
  return QColor::fromRgbF(color[0], color[1], color[2]);
}

void dressAsSwatch(QToolButton& button, const Color& color, const char* border) {
  applyStyleSheet(button,
                  QStringLiteral("QToolButton { background: %1; border: %2; border-radius: 3px; }"
                                 "QToolButton:focus { border: 2px solid @text; }")
                      .arg(qColor(color).name(), QString::fromUtf8(border)));
}

// Plots the weight of the brush from edge to edge.
PlotContent weightsOf(const Brush& brush) {
  constexpr int kSteps = 400;
  PlotCurve curve{{}, "accent"};
  for (int i = 0; i <= kSteps; ++i) {
    const double d = 2. * i / kSteps - 1;
    curve.points << QPointF(d, std::abs(d) < 1 ? brushWeight(brush, std::abs(d), 1) : 0);
  }
  PlotContent content{{{{}, {}, {curve}}}};
  content.bare = true;
  return content;
}

QString titleOf(const Tool& tool) {
  if (tool == Tool::erase) return BrushPanel::tr("Eraser");
  const auto channel = channelOf(tool);
  return BrushPanel::tr("Brush: %1")
      .arg(channel ? shownText(rowOf(*channel).tool) : captionOf(tool));
}

} // namespace

// The colour of a brush: the current one, swatches and recent ones.
class ColorChoice : public QWidget {
  Q_OBJECT
 public:
  ColorChoice(const Color& now, QWidget* parent) : QWidget(parent), color_(now), recent_(nullptr) {
    auto* column = layoutIn<QVBoxLayout>(this, 4);
    auto* above = new QWidget(this);
    auto* line = layoutIn<QHBoxLayout>(above, 3);
    now_ = named(swatch(*line, 40), "brush_color",
                 tr("Colour of the brush; click to choose another…"));
    dressAsSwatch(*now_, color_, "2px solid @accent");
    connect(now_, &QToolButton::clicked, this, &ColorChoice::ask);
    for (const Color& color : kSwatches) offer(*swatch(*line, kWide), color);
    line->addStretch(1);
    column->addWidget(above);
    showRecent();
  }

 signals:
  void chosen(const std::array<double, 3>& color);

 private:
  QToolButton* swatch(QHBoxLayout& line, int wide) {
    auto* button = new QToolButton(this);
    button->setFixedSize(wide, kHigh);
    line.addWidget(button);
    return button;
  }
  void offer(QToolButton& button, const Color& color) {
    dressAsSwatch(button, color, "1px solid @faint");
    button.setToolTip(tr("Paint with %1").arg(qColor(color).name()));
    connect(&button, &QToolButton::clicked, this, [this, color] { choose(color); });
  }
  void choose(const Color& color) {
    color_ = color;
    dressAsSwatch(*now_, color, "2px solid @accent");
    emit chosen(color);
  }
  void ask() {
    const QColor color = QColorDialog::getColor(qColor(color_), this, tr("Brush colour"));
    if (!color.isValid()) return;
    rememberColor(color);
    showRecent();
    choose({color.redF(), color.greenF(), color.blueF()});
  }
  // Hidden until a colour other than a swatch was chosen.
  void showRecent() {
    takeAway(recent_);
    recent_ = nullptr;
    const auto colors = recentColors();
    if (colors.empty()) return;
    recent_ = new QWidget(this);
    auto* line = layoutIn<QHBoxLayout>(recent_, 3);
    QLabel* caption = quietLabel(tr("Last"));
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

  Color color_;
  QToolButton* now_;
  QWidget* recent_;
};

BrushPanel::BrushPanel(QWidget* parent) : QGroupBox(parent), layout_(layoutIn<QVBoxLayout>(this)) {}

void BrushPanel::show(const Brush& brush, const BrushPresets& presets) {
  brush_ = brush;
  setTitle(titleOf(brush.tool));
  rebuild(presets);
}

void BrushPanel::change() {
  curve_->setContent(weightsOf(brush_));
  emit edited(brush_);
}

void BrushPanel::rebuild(const BrushPresets& presets) {
  takeAway(form_);
  form_ = new Form(this);
  connect(form_, &Form::edited, this, &BrushPanel::change);
  if (brush_.tool == Tool::color)
    addColor();
  else
    addValue(presets.extent());
  addLayers(presets);
  addSize(presets);
  addShape();
  addChoices();
  layout_->addWidget(form_);
}

void BrushPanel::addColor() {
  auto* choice = new ColorChoice(brush_.color, form_);
  connect(choice, &ColorChoice::chosen, this, [this](const Color& color) {
    brush_.color = color;
    change();
  });
  form_->addWidget(choice);
}

void BrushPanel::addValue(double extent) {
  if (brush_.tool == Tool::erase) return addErased();
  const double highest = 1000 * std::max(1e-3, std::min(0.05 * extent, 0.05));
  QString caption = tr("Height; below 0 it engraves"), unit = QStringLiteral("mm");
  RowRange range{-highest, highest, highest / 50, 2};
  double display_per_si = 1000;
  if (const auto channel = channelOf(brush_.tool)) {
    addChannels(*channel);
    const Channel& row = rowOf(*channel);
    const SliderRange& dial = row.dial;
    caption = shownText(row.dial_caption);
    unit = shownText(row.reading.unit);
    range = {dial.min, dial.max, dial.step, dial.decimals, dial.logarithmic};
    display_per_si = row.reading.display_per_si;
  }
  form_->addRow(
      RowSpec("brush_value", caption, unit, range, tr("What the brush paints"), display_per_si),
      brush_.value);
}

// Adds a choice of the channels that share a tool.
void BrushPanel::addChannels(MaterialChannel channel) {
  std::vector<MaterialChannel> shared;
  QStringList words;
  int now = 0;
  for (const Channel& row : kChannels) {
    if (row.tool != rowOf(channel).tool) continue;
    if (row.channel == channel) now = words.size();
    shared.push_back(row.channel);
    words << captionOf(Tool::material(row.channel));
  }
  if (shared.size() == 1) return;
  const std::string name = "which_" + std::string(rowOf(channel).tool);
  form_->addChoice(
      name.c_str(), tr("Paints"), words, now,
      [this, shared](int index) {
        emit toolRequested(Tool::material(shared[static_cast<std::size_t>(index)]));
      },
      tr("Channel to paint; these channels share the tool"));
}

void BrushPanel::addErased() {
  QStringList words{captionOf(Tool::erase)};
  std::vector<std::string> names{""};
  for (const Tool& tool : kTools) {
    if (tool == Tool::erase) continue;
    words << captionOf(tool);
    names.emplace_back(name(tool));
  }
  const auto now = std::find(names.begin(), names.end(), brush_.erases) - names.begin();
  form_->addChoice(
      "erases", tr("Erases"), words, static_cast<int>(now),
      [this, names](int index) { brush_.erases = names[static_cast<std::size_t>(index)]; },
      tr("What to erase: all paint, or one kind"));
}

void BrushPanel::addLayers(const BrushPresets& presets) {
  if (brush_.tool == Tool::erase) return;
  auto* box =
      named(new QToolButton(form_), "brush_also",
            tr("Further channels that the stroke paints, each with the settings of its own tool"));
  box->setPopupMode(QToolButton::InstantPopup);
  box->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  auto* menu = new QMenu(box);
  const auto say = [box, menu] {
    QStringList words;
    for (const QAction* action : menu->actions())
      if (action->isChecked()) words << action->text();
    box->setText(words.isEmpty() ? tr("Paints also…")
                                 : tr("Also: %1").arg(words.join(QStringLiteral(", "))));
  };
  for (const Tool& tool : kTools) {
    if (!canJoin(brush_, tool)) continue;
    QAction* action = menu->addAction(captionOf(tool));
    action->setObjectName(QStringLiteral("also_") +
                          QString::fromUtf8(std::string(name(tool)).c_str()));
    action->setCheckable(true);
    action->setChecked(layerOf(brush_, tool) != nullptr);
    const BrushLayer layer = presets.brush(tool);
    connect(action, &QAction::toggled, this, [this, layer, say](bool on) {
      std::erase_if(brush_.extra_layers, [&](const BrushLayer& l) { return l.tool == layer.tool; });
      if (on) brush_.extra_layers.push_back(layer);
      say();
      change();
    });
  }
  say();
  box->setMenu(menu);
  form_->addWidget(box);
}

void BrushPanel::addSize(const BrushPresets& presets) {
  const double max_radius = 500 * presets.extent();
  form_->addRow(RowSpec("brush_radius", tr("Radius"), QStringLiteral("mm"),
                        {max_radius / 500, max_radius, max_radius / 100, 2, true},
                        tr("[ smaller, ] larger"), 1000),
                brush_.radius);
  form_->addRow(RowSpec("brush_grows", tr("Radius from force"), QStringLiteral("mm/N"),
                        {0, max_radius / 10, max_radius / 500, 2},
                        tr("The brush grows with the pressing force, or with a pen's pressure"),
                        1000),
                brush_.radius_per_force);
  form_->addRow(RowSpec("brush_press", tr("Pressing force"), QStringLiteral("N"), {0.1, 3, 0.1, 1},
                        tr("Pressing force of the mouse, or of a pen at full pressure")),
                presets.press, [this](double now) { emit pressed(now); });
}

void BrushPanel::addShape() {
  form_->addChoice(
      "brush_shape", tr("Shape"), {tr("power"), tr("cone"), tr("smooth")},
      static_cast<int>(brush_.shape),
      [this](int index) { brush_.shape = static_cast<BrushShape>(index); },
      tr("1 − (d/r)^f, (1 − d/r)^f or (1 − (d/r)²)^f"));
  form_->addRow(RowSpec("brush_falloff", tr("Fall-off"), QString(), {0.25, 16, 0.25, 2, true},
                        tr("{ less, } more: the exponent f of the shape")),
                brush_.falloff);
  curve_ = new PlotWidget(form_);
  curve_->setFixedHeight(44);
  curve_->setToolTip(tr("Strength of the brush from edge to edge"));
  curve_->setContent(weightsOf(brush_));
  form_->addWidget(curve_);
}

void BrushPanel::addChoices() {
  if (brush_.tool != Tool::erase) {
    QStringList words = {tr("once a stroke"), tr("builds up"), tr("adds"), tr("smooths")};
    std::vector<StrokeMode> modes = {StrokeMode::max, StrokeMode::build_up, StrokeMode::add,
                                     StrokeMode::smooth};
    if (brush_.tool == Tool::color) {
      words.removeAt(2);
      modes.erase(modes.begin() + 2);
    }
    const auto now = std::find(modes.begin(), modes.end(), brush_.mode) - modes.begin();
    form_->addChoice(
        "brush_mode", tr("Lays on"), words, static_cast<int>(now),
        [this, modes](int index) { brush_.mode = modes[static_cast<std::size_t>(index)]; },
        tr("How a stroke combines with existing paint: once a stroke, continuously, added, or "
           "smoothed"));
  }
  form_->addChoice(
      "brush_seed", tr("Starts"), {tr("at the nearest point"), tr("under the tip")},
      static_cast<int>(brush_.anchor),
      [this](int index) { brush_.anchor = static_cast<DabAnchor>(index); },
      tr("Under the tip: where the line from the tip meets the surface, as in the paper. On thin "
         "parts this is the touched side."));
  form_->addChoice(
      "brush_symmetry", tr("Mirrored"), {tr("not"), tr("across x"), tr("across y"), tr("across z")},
      static_cast<int>(brush_.symmetry),
      [this](int index) { brush_.symmetry = static_cast<Symmetry>(index); },
      tr("Paints mirrored about the centre of the object's box, too"));
  form_->addCheck(
      "front_only", tr("Front faces only"),
      tr("Skips faces that point away from the touched point, such as the far side of a thin part"),
      brush_.front_only, [this](bool on) { brush_.front_only = on; });
}

} // namespace patina

#include "brush_panel.moc"

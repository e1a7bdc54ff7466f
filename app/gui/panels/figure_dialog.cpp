#include "app/gui/panels/figure_dialog.h"

#include <algorithm>
#include <utility>

#include <QFormLayout>
#include <QHBoxLayout>
#include <QSettings>
#include <QToolButton>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/value_row.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"

namespace patina {
namespace {

enum Unit { kPixels, kMillimetres };

QString settingOf(const char* key) {
  return QStringLiteral("figure/") + QString::fromUtf8(key);
}

} // namespace

QString sizeInWords(const Figure& figure) {
  const QString words =
      QDialog::tr("%1 × %2 pixels").arg(figure.width).arg(figure.height).replace(' ', kNoBreak);
  if (!figure.dpi) return words;
  return words + QDialog::tr(", %1 mm at %2 dpi")
                     .arg(25.4 * figure.width / *figure.dpi, 0, 'f', 1)
                     .arg(qRound(*figure.dpi));
}

FigureDialog::FigureDialog(const SeenView& seen, QWidget* parent) : QDialog(parent), seen_(seen) {
  setObjectName(QStringLiteral("figure_dialog"));
  setWindowTitle(tr("Export picture"));
  setAttribute(Qt::WA_DeleteOnClose);
  auto* form = new QFormLayout(this);
  const QSettings settings;
  const auto number = [&](const char* name, const QString& caption, const QString& unit,
                          const RowRange& range, double usual, const QString& tip) {
    QDoubleSpinBox* box = named(numberBox(caption, unit, range, this), name, tip);
    box->setKeyboardTracking(true);
    box->setValue(settings.value(settingOf(name), usual).toDouble());
    connect(box, qOverload<double>(&QDoubleSpinBox::valueChanged), this, &FigureDialog::refresh);
    return box;
  };
  pixels_ = number("figure_pixels", tr("Width"), tr("px"), {16, 16384, 1, 0}, seen.size.width(),
                   tr("Width of the picture; texts grow with it"));
  millimetres_ = number("figure_mm", tr("Width"), tr("mm"), {5, 1000, 1, 1}, 85,
                        tr("Width on paper; texts have about 6 pt"));
  dpi_ = number("figure_dpi", tr("Resolution"), tr("dpi"), {10, 1200, 50, 0}, 300,
                tr("Pixels per inch of paper, written into the file"));
  auto* width = new QWidget(this);
  auto* line = layoutIn<QHBoxLayout>(width);
  for (QWidget* box : {pixels_, millimetres_, dpi_}) line->addWidget(box);
  form->addRow(tr("Width"), width);
  unit_ =
      addChoices("figure_unit", tr("Width in"), {"px", "mm"}, {tr("Pixels"), tr("Millimetres")});
  scale_ = addChoices("figure_scale", tr("Scale"), {"1", "2", "3", "4"},
                      {tr("1×"), tr("2×"), tr("3×"), tr("4×")},
                      {{}, tr("Twice the pixels, with the same looks"), {}, {}});
  background_ =
      addChoices("figure_background", tr("Background"), {"as-seen", "white", "transparent"},
                 {tr("As seen"), tr("White"), tr("Transparent")});
  auto* parts = new QWidget(this);
  auto* row = layoutIn<QHBoxLayout>(parts, 12);
  const std::pair<FigurePart, QString> captions[] = {{FigurePart::cube, tr("Cube")},
                                                     {FigurePart::scale, tr("Scale bar")},
                                                     {FigurePart::tool, tr("Tool")},
                                                     {FigurePart::legend, tr("Legend")}};
  for (const auto& [part, words] : captions) {
    const QString key = shownText(name(part));
    auto* box = new QCheckBox(words, parts);
    box->setObjectName(QStringLiteral("figure_with_") + key);
    box->setToolTip(tr("In commands: <i>--without %1</i>").arg(key));
    box->setChecked(settings.value(settingOf("with_") + key, true).toBool());
    row->addWidget(box);
    parts_[part] = box;
  }
  form->addRow(tr("With"), parts);
  size_ = named(quietLabel({}), "figure_size");
  form->addRow(QString(), size_);
  auto* buttons = new QHBoxLayout;
  copy_ = addButton(buttons, "figure_copy", tr("Copy"), tr("Copies the picture to the clipboard"),
                    this, [this] { finish(true); });
  buttons->addStretch(1);
  addButton(buttons, "figure_cancel", tr("Cancel"), {}, this, &QDialog::reject);
  save_ = addButton(buttons, "figure_save", tr("Save…"),
                    tr("As PNG or TIFF, or as SVG or PDF with texts as vectors"), this,
                    [this] { finish(false); });
  copy_->setAutoDefault(false);
  save_->setDefault(true);
  form->addRow(buttons);
  refresh();
  save_->setFocus();
}

QButtonGroup* FigureDialog::addChoices(const char* name, const QString& caption,
                                       const QStringList& keys, const QStringList& words,
                                       const QStringList& tips) {
  auto* group = new QButtonGroup(this); // Makes them exclusive.
  auto* row = new QHBoxLayout;
  row->setSpacing(0);
  const QString chosen = QSettings().value(settingOf(name), keys.front()).toString();
  for (int i = 0; i < keys.size(); ++i) {
    auto* button = new QToolButton(this);
    button->setObjectName(QString::fromUtf8(name) + '_' + keys[i]);
    button->setText(words[i]);
    button->setToolTip(tips.value(i));
    button->setCheckable(true);
    button->setChecked(i == 0 || keys[i] == chosen);
    button->setProperty("key", keys[i]);
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    group->addButton(button, i);
    row->addWidget(button);
  }
  connect(group, &QButtonGroup::idClicked, this, &FigureDialog::refresh);
  static_cast<QFormLayout*>(layout())->addRow(caption, row);
  return group;
}

Figure FigureDialog::figure() const {
  FigureWidth width;
  if (unit_->checkedId() == kMillimetres) {
    width.length = millimetres_->value() / 1000;
    width.dpi = dpi_->value();
  } else {
    width.pixels = qRound(pixels_->value());
  }
  width.scale = 1 + scale_->checkedId();
  Figure figure;
  const double wide = std::max(1, seen_.size.width()), high = std::max(1, seen_.size.height());
  setSize(figure, width, wide / high, wide * 72 / seen_.dpi);
  figure.background = allFigureBackgrounds()[static_cast<std::size_t>(background_->checkedId())];
  for (const auto& [part, box] : parts_)
    if (!box->isChecked()) figure.without.insert(part);
  return figure;
}

void FigureDialog::refresh() {
  const bool paper = unit_->checkedId() == kMillimetres;
  pixels_->setVisible(!paper);
  millimetres_->setVisible(paper);
  dpi_->setVisible(paper);
  bool fits = true;
  try {
    size_->setText(sizeInWords(figure()));
  } catch (const Error&) {
    fits = false;
    size_->setText(tr("Its sides may have 16 to 16384 pixels"));
  }
  save_->setEnabled(fits);
  copy_->setEnabled(fits);
}

void FigureDialog::finish(bool copies) {
  const Figure made = figure();
  QSettings settings;
  for (const QDoubleSpinBox* box : {millimetres_, dpi_})
    settings.setValue(QStringLiteral("figure/") + box->objectName(), box->value());
  const std::pair<const char*, QButtonGroup*> groups[] = {
      {"figure_unit", unit_}, {"figure_scale", scale_}, {"figure_background", background_}};
  for (const auto& [name, group] : groups)
    settings.setValue(settingOf(name), group->checkedButton()->property("key"));
  for (const auto& [part, box] : parts_)
    settings.setValue(settingOf("with_") + shownText(name(part)), box->isChecked());
  accept();
  copies ? emit copyRequested(made) : emit saveRequested(made);
}

} // namespace patina

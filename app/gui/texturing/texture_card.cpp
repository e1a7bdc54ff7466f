#include "app/gui/texturing/texture_card.h"

#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/gui/panels/form.h"
#include "app/gui/scanning/scan_path.h"
#include "app/gui/widgets/words.h"
#include "core/numbers.h"

namespace patina {
namespace {

QString wordsOf(const TextureRow& row) {
  if (row.texture == nullptr) return TextureCard::tr("%1 · not known: rigid").arg(row.number);
  const FourierTexture& texture = row.texture->value;
  const QString name =
      texture.name.empty() ? TextureCard::tr("texture") : QString::fromStdString(texture.name);
  return row.faces > 0 ? TextureCard::tr("%1 · %2, on %3 faces")
                             .arg(row.number)
                             .arg(name, QString::fromStdString(formatCount(row.faces)))
                       : TextureCard::tr("%1 · %2, not laid").arg(row.number).arg(name);
}

QString tipOf(const TextureRow& row) {
  if (row.texture == nullptr)
    return TextureCard::tr("Faces of the mesh name it; lay a file in its place by Swap");
  const FourierTexture& texture = row.texture->value;
  return TextureCard::tr("%1 harmonics over %2, rms height %3")
      .arg(harmonics(texture))
      .arg(inWords(period(texture)), inWords(rmsHeight(texture)));
}

} // namespace

TextureCard::TextureCard(QWidget* parent) : QGroupBox(tr("Textures"), parent) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  list_ = new QListWidget;
  list_->setObjectName(QStringLiteral("textures"));
  list_->setToolTip(tr("Textures of the scene, and those that were read"));
  list_->setFixedHeight(96);
  column->addWidget(list_);
  const auto button = [&](const char* name, const QString& words, const QString& tip) {
    auto* made = new QPushButton(words);
    made->setObjectName(QString::fromUtf8(name));
    made->setToolTip(tip);
    column->addWidget(made);
    return made;
  };
  read_ = button("texture_read", tr("Read texture…"),
                 tr("A texture.json, as `patina fit-texture` and Keep write it"));
  scan_ =
      button("texture_scan", tr("From the scan"),
             tr("Heights of the scan that is open, over the mesh, from where the desk Align has "
                "laid its path: a texture, laid where it was scanned"));
  keep_ = button("texture_keep", tr("Keep…"), tr("Writes it as a texture.json, for another mesh"));
  draw_ = button("texture_draw", tr("Lay along a path"),
                 tr("Draw on the mesh with the left button: the chosen texture is laid along what "
                    "you draw; Shift turns the picture, Esc ends it"));
  draw_->setCheckable(true);
  hint_ = new QLabel;
  hint_->setObjectName(QStringLiteral("texture_hint"));
  hint_->setWordWrap(true);
  hint_->setProperty("quiet", true);
  column->addWidget(hint_);
  auto* form = new Form(this);
  form->addRow({"texture_rings",
                tr("Faces beside the path"),
                tr("rings"),
                {0, 12, 1, 0},
                1,
                tr("So many rings of neighbours of the faces under the path get the texture too")},
               rings_, [this](double rings) { rings_ = static_cast<int>(rings); });
  column->addWidget(form);
  swap_ = button("texture_swap", tr("Swap…"),
                 tr("A file's texture takes the chosen one's place on all of its faces"));
  remove_ = button("texture_remove", tr("Take off"), tr("Its faces have no texture any more"));
  connect(list_, &QListWidget::currentRowChanged, this, [this] {
    offer();
    emit chosenChanged();
  });
  connect(read_, &QPushButton::clicked, this, &TextureCard::readAsked);
  connect(scan_, &QPushButton::clicked, this, &TextureCard::scanAsked);
  connect(draw_, &QPushButton::toggled, this, &TextureCard::drawToggled);
  connect(swap_, &QPushButton::clicked, this, &TextureCard::swapAsked);
  connect(remove_, &QPushButton::clicked, this, &TextureCard::removeAsked);
  connect(keep_, &QPushButton::clicked, this, &TextureCard::keepAsked);
  setHint({});
  offer();
}

void TextureCard::show(const std::vector<TextureRow>& rows) {
  const TextureRow* before = chosen();
  const std::int32_t number = before ? before->number : -1;
  {
    const QSignalBlocker quiet(list_);
    rows_ = rows;
    list_->clear();
    for (const TextureRow& row : rows_) {
      auto* item = new QListWidgetItem(wordsOf(row), list_);
      item->setToolTip(tipOf(row));
    }
  }
  if (!rows_.empty()) list_->setCurrentRow(0);
  choose(number);
  offer();
  emit chosenChanged();
}

void TextureCard::choose(std::int32_t number) {
  for (std::size_t i = 0; i < rows_.size(); ++i)
    if (rows_[i].number == number) list_->setCurrentRow(static_cast<int>(i));
}

const TextureRow* TextureCard::chosen() const {
  const int row = list_->currentRow();
  return row >= 0 && static_cast<std::size_t>(row) < rows_.size()
             ? &rows_[static_cast<std::size_t>(row)]
             : nullptr;
}

void TextureCard::offer() {
  const TextureRow* row = chosen();
  list_->setVisible(!rows_.empty());
  for (QPushButton* button : {draw_, keep_})
    button->setVisible(row != nullptr && row->texture != nullptr);
  for (QPushButton* button : {swap_, remove_}) button->setVisible(row != nullptr && row->faces > 0);
}

void TextureCard::setHint(const QString& words) {
  hint_->setText(words);
  hint_->setVisible(!words.isEmpty());
}

void TextureCard::setDrawing(bool on) {
  const QSignalBlocker quiet(draw_);
  draw_->setChecked(on);
  setHint(on ? tr("Draw on the mesh with the left button; Esc ends it.") : QString());
}

} // namespace patina

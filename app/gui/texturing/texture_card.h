// The library of textures: what lies on the scene and what was read from files, to be laid along a
// path that is drawn, to take another's place, to be kept as a file.
#pragma once

#include <optional>
#include <vector>

#include <QGroupBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>

#include "scene/fourier/felt_texture.h"

namespace patina {

struct TextureRow {
  std::int32_t number = 0;
  std::shared_ptr<const FeltTexture> texture; // nullptr: faces name it, and nobody knows it
  std::size_t faces = 0;                      // that it lies on
};

class TextureCard : public QGroupBox {
  Q_OBJECT
 public:
  explicit TextureCard(QWidget* parent = nullptr);

  void show(const std::vector<TextureRow>& rows); // keeps the choice where it can
  void setHint(const QString& words);             // empty: none
  void setDrawing(bool on);
  const TextureRow* chosen() const; // nullptr: none
  void choose(std::int32_t number);
  int rings() const { return rings_; }

 signals:
  void chosenChanged();
  void readAsked();          // of a file
  void drawToggled(bool on); // along a path
  void swapAsked();          // another in the place of the chosen
  void removeAsked();        // from its faces
  void keepAsked();          // as a file
  void scanAsked();          // from the scan that is open

 private:
  void offer();

  std::vector<TextureRow> rows_;
  QListWidget* list_;
  QLabel* hint_;
  QPushButton *read_, *scan_, *draw_, *swap_, *remove_, *keep_;
  int rings_ = 2;
};

} // namespace patina

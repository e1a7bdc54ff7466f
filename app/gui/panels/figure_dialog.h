// Asks for size, background and parts of a picture to export. Remembers the last answers.
#pragma once

#include <map>

#include <QButtonGroup>
#include <QCheckBox>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSize>

#include "visualization/values/figure.h"

namespace patina {

// The view as it is in the window.
struct SeenView {
  QSize size; // [pixels of the screen]
  int dpi = 72;
};

QString sizeInWords(const Figure& figure); // "1004 × 694 pixels, 85 mm at 300 dpi"

class FigureDialog : public QDialog {
  Q_OBJECT
 public:
  // Deletes itself when closed.
  FigureDialog(const SeenView& seen, QWidget* parent);

 signals:
  void saveRequested(const patina::Figure& figure);
  void copyRequested(const patina::Figure& figure);

 private:
  QButtonGroup* addChoices(const char* name, const QString& caption, const QStringList& keys,
                           const QStringList& words, const QStringList& tips = {});
  Figure figure() const; // Throws Error for a size that is out of range.
  void refresh();
  void finish(bool copies);

  SeenView seen_;
  QDoubleSpinBox *pixels_, *millimetres_, *dpi_;
  QButtonGroup *unit_ = nullptr, *scale_ = nullptr, *background_ = nullptr;
  std::map<FigurePart, QCheckBox*> parts_;
  QLabel* size_;
  QPushButton *save_, *copy_;
};

} // namespace patina

// Rows of values in a column, each of which says what a person has made of it.
#pragma once

#include <functional>

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>

#include "app/gui/panels/value_row.h"

namespace patina {

struct RowSpec {
  const char* name; // of the widget
  QString caption, unit;
  RowRange range; // in that unit
  double per_si = 1;
  QString tip{};
};

class Form : public QWidget {
  Q_OBJECT
 public:
  explicit Form(QWidget* parent);

  ValueRow* addRow(const RowSpec& spec, double now, std::function<void(double)> set); // SI
  ValueRow* addRow(const RowSpec& spec, double& value); // which outlives the form
  void addCheck(const char* name, const QString& words, const QString& tip, bool now,
                std::function<void(bool)> set);
  void addChoice(const char* name, const QString& caption, const QStringList& words, int now,
                 std::function<void(int)> set, const QString& tip = {});
  void addWidget(QWidget* widget) { grid_->addWidget(widget, grid_->rowCount(), 0, 1, 2); }

 signals:
  void edited(); // after a value was set

 private:
  QGridLayout* grid_;
};

} // namespace patina

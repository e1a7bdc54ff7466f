// A column of value rows, each of which reports the user's changes.
#pragma once

#include <functional>
#include <utility>

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>

#include "app/gui/toolkit/value_row.h"

namespace patina {

struct RowSpec {
  RowSpec(const char* widget, QString words, QString measured_in, const RowRange& limits,
          QString help, double per_si = 1)
      : name(widget), caption(std::move(words)), unit(std::move(measured_in)), range(limits),
        tip(std::move(help)), display_per_si(per_si) {}

  const char* name; // Name of the widget.
  QString caption, unit;
  RowRange range; // In that unit.
  QString tip;
  double display_per_si;
};

class Form : public QWidget {
  Q_OBJECT
 public:
  explicit Form(QWidget* parent);

  // Values in SI units.
  ValueRow* addRow(const RowSpec& spec, double now, std::function<void(double)> set);
  ValueRow* addRow(const RowSpec& spec, double& value); // `value` must outlive the form.
  void addCheck(const char* name, const QString& words, const QString& tip, bool now,
                std::function<void(bool)> set);
  void addChoice(const char* name, const QString& caption, const QStringList& words, int now,
                 std::function<void(int)> set, const QString& tip = {});
  void addWidget(QWidget* widget) { grid_->addWidget(widget, grid_->rowCount(), 0, 1, 2); }

 signals:
  void edited(); // Sent after a value was set.

 private:
  QGridLayout* grid_;
};

} // namespace patina

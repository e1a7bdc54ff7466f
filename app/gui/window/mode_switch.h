// Where contact is: on the surface, on its offset, or on a surface that pulls. One of the three,
// because offset and magnet act in the same band (K12, K13).
#pragma once

#include <QButtonGroup>
#include <QWidget>

#include "scene/haptic_properties.h"

namespace patina {

enum class TouchMode { contact, offset, magnetic };
TouchMode touchMode(const HapticProperties& haptics);

class ModeSwitch : public QWidget {
  Q_OBJECT
 public:
  explicit ModeSwitch(QWidget* parent = nullptr);
  void setMode(TouchMode mode); // sends no signal

 signals:
  void chosen(patina::TouchMode mode); // by a person

 private:
  QButtonGroup* buttons_;
};

} // namespace patina

// The device that feels, its numbers, and what keeps the loop stable on it.
#pragma once

#include <optional>
#include <string>

#include <QComboBox>
#include <QGridLayout>
#include <QGroupBox>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/gui/panels/attached_devices.h"
#include "haptics/stability/stabilisers.h"
#include "scene/scene.h"

namespace patina {

// The part of a scene that this panel edits.
struct DeviceChoice {
  std::string device = "mouse";
  std::optional<DeviceModel> model;
  std::optional<Stabilisers> stabilisers; // absent: automatic
  bool operator==(const DeviceChoice&) const = default;
};
DeviceChoice deviceChoice(const Scene& scene);

class DevicePanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit DevicePanel(QWidget* parent = nullptr);

  void setValues(const DeviceChoice& choice); // sends no signal
  const DeviceChoice& values() const { return choice_; }
  void showPlan(const StabiliserPlan& plan); // what follows from the numbers

 signals:
  void edited();

 private:
  void rebuild();
  void addNumbers(QVBoxLayout* column);
  void addDevice(const QString& caption, const std::string& device); // to the list, once

  DeviceChoice choice_;
  QComboBox* device_;
  QComboBox* stabiliser_;
  QVBoxLayout* layout_;
  QWidget* numbers_ = nullptr;
  QLabel* note_;
  AttachedDevices* attached_;
};

} // namespace patina

// Settings of painted relief, and its largest stable height.
#pragma once

#include <memory>

#include <QGroupBox>
#include <QLabel>
#include <QVBoxLayout>

#include "app/gui/toolkit/background.h"
#include "app/gui/toolkit/form.h"
#include "scene/paint/relief_settings.h"
#include "session/compile/compile_scene.h"

namespace patina {

class ReliefPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit ReliefPanel(QWidget* parent = nullptr);

  void show(std::shared_ptr<const CompiledScene> scene); // Sends no signal.
  void cancel() { jobs_.discardResult(); }

 signals:
  void edited(const patina::ReliefSettings& relief);

 private:
  void rebuild();
  void measure(std::shared_ptr<const CompiledScene> scene);

  ReliefSettings relief_;
  QVBoxLayout* layout_;
  QLabel* note_;
  Form* form_ = nullptr;
  // The newest scene whose note is shown or computed.
  std::shared_ptr<const CompiledScene> measured_;
  Background jobs_{this};
};

} // namespace patina

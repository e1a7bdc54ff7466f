// How painted relief is felt, and how high it may be.
#pragma once

#include <memory>

#include <QGroupBox>
#include <QLabel>
#include <QVBoxLayout>

#include "app/gui/panels/form.h"
#include "app/gui/window/background.h"
#include "scene/paint/relief_settings.h"
#include "session/build/compile_scene.h"

namespace patina {

class ReliefPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit ReliefPanel(QWidget* parent = nullptr);

  // Sends no signal; the note follows as soon as it is computed.
  void show(std::shared_ptr<const CompiledScene> scene);
  bool resting() const { return jobs_.resting(); }
  void cancel();

 signals:
  void edited(const patina::ReliefSettings& relief);
  void rested();

 private:
  void rebuild();
  void measure(std::shared_ptr<const CompiledScene> scene);

  ReliefSettings relief_;
  QVBoxLayout* layout_;
  QLabel* note_;
  Form* form_ = nullptr;
  std::shared_ptr<const CompiledScene> measured_; // the newest that the note is or will be of
  Background jobs_;
};

} // namespace patina

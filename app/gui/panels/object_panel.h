// Facts about the open scene: the mesh, its defects, the field and its memory.
#pragma once

#include <QGroupBox>

#include "app/gui/toolkit/card.h"
#include "session/open/session.h"

namespace patina {

class ObjectPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit ObjectPanel(QWidget* parent = nullptr);

  void showMesh(const TriangleMesh& mesh, const QString& name); // Shown before the field exists.
  void showScene(const CompiledScene& scene);

 private:
  void clear();
  void meshRows(const TriangleMesh& mesh);

  FactTable* facts_ = nullptr;
};

} // namespace patina

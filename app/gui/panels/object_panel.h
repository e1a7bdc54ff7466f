// What is open: the mesh, its defects, the field and its bytes.
#pragma once

#include <QGridLayout>
#include <QGroupBox>

#include "session/build/session.h"

namespace patina {

class ObjectPanel : public QGroupBox {
  Q_OBJECT
 public:
  explicit ObjectPanel(QWidget* parent = nullptr);

  void showMesh(const TriangleMesh& mesh, const QString& name); // before the field is there
  void showScene(const CompiledScene& scene);

 private:
  void clear();
  void row(const QString& caption, const QString& value, const QString& tip = {}, bool bad = false);
  void heading(const QString& words);
  void meshRows(const TriangleMesh& mesh);

  QGridLayout* grid_;
  QWidget* body_ = nullptr;
  int rows_ = 0;
};

} // namespace patina

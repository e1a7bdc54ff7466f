// Writes a video while the window goes on, with a dialog that shows its progress.
#pragma once

#include <memory>
#include <vector>

#include <QProgressDialog>
#include <QTimer>

#include "scene/tool_sample.h"
#include "visualization/plots/video.h"

namespace patina {

class VideoExport : public QProgressDialog {
  Q_OBJECT
 public:
  // Deletes itself at the end. `view` is in no window. Throws Error.
  VideoExport(std::unique_ptr<SceneView> view, std::vector<ToolSample> samples,
              const Figure& figure, const QString& path, QWidget* window);

 signals:
  void written(const QString& path);
  void failed(const QString& cause);

 private:
  void writeNext();

  QString path_;
  std::unique_ptr<SceneView> view_;
  VideoWriter writer_; // draws that view
  QTimer timer_;
};

} // namespace patina

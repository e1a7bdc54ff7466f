#include "app/gui/panels/video_export.h"

#include <utility>

#include "core/error.h"

namespace patina {

VideoExport::VideoExport(std::unique_ptr<SceneView> view, std::vector<ToolSample> samples,
                         const Figure& figure, const QString& path, QWidget* window)
    : QProgressDialog(window), path_(path), view_(std::move(view)),
      writer_(*view_, std::move(samples), figure, path.toStdString()) {
  setObjectName(QStringLiteral("video_progress"));
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Export video"));
  setLabelText(tr("Drawing %1 frames").arg(writer_.frames()));
  setRange(0, writer_.frames());
  setMinimumDuration(500);
  setAutoClose(false);
  setAutoReset(false);
  connect(this, &QProgressDialog::canceled, this, &QObject::deleteLater);
  connect(&timer_, &QTimer::timeout, this, &VideoExport::writeNext);
  timer_.start(0);
}

void VideoExport::writeNext() {
  try {
    if (writer_.writeNext()) return setValue(writer_.written());
    emit written(path_);
  } catch (const Error& error) {
    emit failed(QString::fromUtf8(error.what()));
  }
  timer_.stop();
  deleteLater();
}

} // namespace patina

// The frame that is looked at: what the camera saw, the markers that were found in it, and the
// probe's axes and tip through the lens.
#pragma once

#include <map>

#include <QImage>
#include <QLabel>
#include <QWidget>

#include "acquisition/recording/recorder.h"
#include "acquisition/vision/vision.h"
#include "app/gui/scanning/open_scan.h"
#include "app/gui/widgets/elided_label.h"

namespace patina {

QImage imageOf(const GreyFrame& frame);

// What is drawn over a picture.
struct FrameMarks {
  struct Outline {
    int id = 0;
    std::array<Vec2, 4> corner; // [px] of the frame
  };
  std::vector<Outline> markers;
  std::vector<Vec2> corners; // of a board [px]
  std::optional<Pose> camera_from_probe;
  bool left_out = false; // the pose, of the path
};
std::vector<FrameMarks::Outline> outlinesOf(const std::vector<SeenMarker>& markers);

// A picture as large as there is room, and marks over it.
class FrameCanvas : public QWidget {
  Q_OBJECT
 public:
  explicit FrameCanvas(QWidget* parent = nullptr);
  // Of a camera that is absent only outlines are drawn. An empty picture shows the words.
  void show(const QImage& picture, const FrameMarks& marks, const std::optional<Camera>& camera,
            const Vec3& tip, const QString& words = {});
  QPointF placeOf(const Vec2& pixel) const; // in the widget; (0, 0) is a pixel's middle
  QSize minimumSizeHint() const override { return {200, 150}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;

 private:
  double scale() const; // pixels of the widget a pixel of the picture
  void drawMarkers(QPainter& painter) const;
  void drawProbe(QPainter& painter) const;
  void drawBoard(QPainter& painter) const;

  QImage picture_;
  FrameMarks marks_;
  std::optional<Camera> camera_;
  Vec3 tip_ = Vec3::Zero();
  QString words_;
  double zoom_ = 1; // of what fits
  QPointF shift_, last_;
};

class FrameView : public QWidget {
  Q_OBJECT
 public:
  explicit FrameView(OpenScan& scan, QWidget* parent = nullptr);
  void showLive(const RecordedFrame& frame);
  void addBoard(std::size_t frame, const BoardView& view); // until another scan is opened

 private:
  void load(); // the cursor's frame, if it is not the one that is shown
  void refresh();
  void describe();
  void sayWhy(const QString& why); // empty: all is well

  OpenScan& scan_;
  ElidedLabel* title_;
  FrameCanvas* canvas_;
  QLabel* why_;
  Background job_;
  std::optional<std::size_t> asked_; // the frame
  QImage picture_;
  std::optional<Camera> camera_; // of the picture as it is shown
  std::vector<FrameMarks::Outline> markers_;
  std::map<std::size_t, std::vector<Vec2>> boards_; // corners by frame
  QString fault_;
};

} // namespace patina

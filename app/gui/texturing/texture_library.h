// Connects the library's panel, the picture for drawing paths, and the edits of textures.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <QGroupBox>

#include "app/gui/panels/message_panel.h"
#include "app/gui/scanning/scan_view.h"
#include "app/gui/state/window_state.h"
#include "app/gui/texturing/aligned_scan.h"
#include "app/gui/texturing/scene_textures.h"
#include "app/gui/toolkit/background.h"
#include "app/gui/toolkit/card.h"
#include "geometry/tree/triangle_tree.h"
#include "session/edit/edit_thread.h"

namespace patina {

// Shows the library. A texture can be mapped along a drawn path, replace another one, or be saved.
class TextureCard : public QGroupBox {
  Q_OBJECT
 public:
  explicit TextureCard(QWidget* parent = nullptr);

  void show(const std::vector<TextureRow>& rows);           // Keeps the selection if possible.
  void setHint(const QString& words) { say(hint_, words); } // Empty: none.
  void setDrawing(bool on);
  const TextureRow* chosen() const; // nullptr: none.
  void choose(std::int32_t number);
  int rings() const { return rings_; }

 signals:
  void chosenChanged();
  void readRequested();
  void drawToggled(bool on); // Draws a path to map the texture along.
  void swapRequested();      // Replaces the selected texture.
  void removeRequested();
  void keepRequested();
  void scanRequested(); // Makes one from the open scan.

 private:
  void offer();

  std::vector<TextureRow> rows_;
  QListWidget* list_;
  QLabel* hint_;
  QPushButton *draw_, *swap_, *remove_, *keep_;
  int rings_ = 2;
};

// Draws a path on a mesh with the left button, in the 3D picture of a scan.
class PathPen : public QObject {
  Q_OBJECT
 public:
  // The view owns it.
  explicit PathPen(ScanView& view) : QObject(&view), view_(view) { view_.installEventFilter(this); }

  void setScene(const Scene& scene);
  void setOn(bool on); // False: the button moves the camera.

 signals:
  // Points on the object, object frame.
  void drawn(int object, const std::vector<patina::Vec3>& points);
  void left();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void touch(const QPoint& pixel);
  void showPath();

  struct Ground {
    std::shared_ptr<const TriangleMesh> mesh;
    Pose world_from_object = Pose::Identity();
    std::unique_ptr<TriangleTree> tree; // Made on first use.
  };
  ScanView& view_;
  std::vector<Ground> grounds_;
  bool on_ = false, down_ = false;
  int object_ = -1;          // The object with the path.
  std::vector<Vec3> points_; // Object frame.
};

class TextureLibrary : public QObject {
  Q_OBJECT
 public:
  explicit TextureLibrary(QWidget& window);

  TextureCard* card() const { return card_; }
  ScanView* view(); // Made on first use.
  bool hasScene() const { return scene_ != nullptr; }
  const std::optional<TaskProgress>& work() const { return work_; }

  void createFromScan();
  // `make_aligned` returns the aligned scan, or throws why there is none.
  void setSources(EditThread& edits, std::function<AlignedScan()> make_aligned) {
    edits_ = &edits;
    make_aligned_ = std::move(make_aligned);
  }
  void setScene(std::shared_ptr<const CompiledScene> scene) {
    scene_ = std::move(scene);
    stale_ = true;
    list();
  }
  void read(const std::filesystem::path& file); // Adds a texture file to the list.
  void cancel();
  void refresh();

 signals:
  void changed();
  void notified(const patina::Message& message);
  void chosen(std::shared_ptr<const patina::HapticTexture> texture); // nullptr: none.

 private:
  void list() { card_->show(scene_ ? texturesOf(scene_->scene, read_) : read_); }
  void showScene();
  void markFaces(); // Highlights faces with the selected texture.
  void readDialog(bool swaps);
  void keepDialog();
  void mapAlong(int object, const std::vector<Vec3>& points);
  void swap(const std::filesystem::path& file);
  void removeTexture();
  void apply(const std::string& what, std::function<Scene(const Scene&)> edit);
  std::shared_ptr<const HapticTexture> readOrReport(const std::filesystem::path& file);

  QWidget& window_;
  TextureCard* card_ = new TextureCard;
  ScanView* view_ = nullptr;
  PathPen* pen_ = nullptr;
  Background job_;
  EditThread* edits_ = nullptr;
  std::function<AlignedScan()> make_aligned_;
  std::shared_ptr<const CompiledScene> scene_;
  std::shared_ptr<const TriangleMesh> shown_;
  std::vector<TextureRow> read_;
  std::optional<TaskProgress> work_;
  bool stale_ = false;    // The scene has changed since it was drawn.
  bool unmarked_ = false; // The selection has changed since it was drawn.
};

} // namespace patina

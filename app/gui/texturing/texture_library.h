// The library of textures at work: its card, the scene's picture that paths are drawn in, and the
// edits that come of it, each with undo.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "app/gui/panels/message_panel.h"
#include "app/gui/texturing/path_pen.h"
#include "app/gui/texturing/placed_scan.h"
#include "app/gui/texturing/texture_card.h"
#include "app/gui/window/background.h"
#include "app/gui/window/window_state.h"
#include "session/edit/edit_thread.h"

namespace patina {

class TextureLibrary : public QObject {
  Q_OBJECT
 public:
  explicit TextureLibrary(QWidget& window); // to which it belongs

  TextureCard* card() const { return card_; }
  ScanView* view(); // made when it is first asked for
  bool hasScene() const { return scene_ != nullptr; }
  const std::optional<Work>& work() const { return work_; }

  // Who edits; asks for a scan's texture have `placed` say which, by a throw why there is none.
  void takeFromScan(); // lays what the scan that is open says
  void setSources(EditThread& edits, std::function<PlacedScan()> placed);
  void setScene(std::shared_ptr<const CompiledScene> scene);
  void read(const std::filesystem::path& file); // a texture, into the list
  void cancel();
  void refresh();

 signals:
  void changed();
  void said(const patina::Message& message);
  void chosen(std::shared_ptr<const patina::FeltTexture> texture); // nullptr: none

 private:
  void list();
  void showScene();
  void markFaces(); // of the chosen texture
  void readDialog(bool swaps);
  void keepDialog();
  void lay(int object, const std::vector<Vec3>& points);
  void swap(const std::filesystem::path& file);
  void takeOff();
  void apply(const std::string& what, std::function<Scene(const Scene&)> edit);
  std::shared_ptr<const FeltTexture> readOrTell(const std::filesystem::path& file);

  QWidget& window_;
  TextureCard* card_ = new TextureCard;
  ScanView* view_ = nullptr;
  PathPen* pen_ = nullptr;
  Background job_;
  EditThread* edits_ = nullptr;
  std::function<PlacedScan()> placed_;
  std::shared_ptr<const CompiledScene> scene_;
  std::shared_ptr<const TriangleMesh> shown_; // mesh
  std::vector<TextureRow> read_;
  std::optional<Work> work_;
  bool stale_ = false;    // the scene has changed since it was drawn
  bool unmarked_ = false; // the choice has
};

} // namespace patina

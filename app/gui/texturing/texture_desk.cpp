#include "app/gui/texturing/texture_desk.h"

#include <unistd.h>

#include <QLabel>
#include <QVBoxLayout>

#include "app/gui/loading/load_dialogs.h"
#include "core/error.h"
#include "demo/demo_pictures.h"

namespace patina {
namespace {

std::shared_ptr<const TriangleMesh> texturedFaces(const Demo& demo) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = demo.object.mesh.positions;
  for (const DemoTexture& texture : demo.textures)
    for (const TexturedFace& face : texture.scanned.laid.faces)
      mesh->triangles.push_back(demo.object.mesh.triangles[index(face.face)]);
  return mesh->triangles.empty() ? nullptr : mesh;
}

} // namespace

TextureDesk::TextureDesk(QWidget& window)
    : QObject(&window), window_(window), job_(this), library_(window) {
  auto* empty = new QWidget;
  auto* column = new QVBoxLayout(empty);
  auto* words = new QLabel(tr(
      "From a scan to a feel, on a toy.\n\nA hand scans three materials on a toy dinosaur. Eight "
      "steps track it, find its place on the mesh, make textures of what it went over, lay them "
      "onto the mesh and let you feel them. Each step says how far it is from the truth.\n\n"
      "A scan of your own becomes a texture by From the scan in the card Textures, once the desk "
      "Align has laid it onto its mesh."));
  words->setWordWrap(true);
  words->setAlignment(Qt::AlignCenter);
  column->addStretch(1);
  column->addWidget(words);
  column->addStretch(1);
  cells_->addWidget(empty);

  auto* page = new QVBoxLayout(profile_);
  page->setContentsMargins(0, 0, 0, 0);
  page->setSpacing(2);
  material_->setObjectName(QStringLiteral("texture_choice"));
  material_->setToolTip(tr("The texture whose heights, harmonics and forces are drawn"));
  page->addWidget(material_, 0, Qt::AlignLeft);
  page->addWidget(plot_, 1);
  connect(material_, qOverload<int>(&QComboBox::currentIndexChanged), this,
          &TextureDesk::showProfile);
  connect(steps_, &StepList::nextAsked, this, [this] { run(false); });
  connect(steps_, &StepList::allAsked, this, [this] { run(true); });
  connect(steps_, &StepList::feelAsked, this,
          [this] { emit openAsked(QString::fromStdString((folder_ / "workspace").string())); });
  connect(steps_, &StepList::lookAsked, this, [this](const QString& scan) {
    emit scanAsked(QString::fromStdString((folder_ / ("scan-" + scan.toStdString())).string()));
  });
  connect(&library_, &TextureLibrary::changed, this, &TextureDesk::changed);
  connect(&library_, &TextureLibrary::said, this, &TextureDesk::said);
  connect(&library_, &TextureLibrary::chosen, this, [this](const auto& texture) {
    chosen_ = texture;
    if (library_shown_) showProfile();
    emit changed();
  });
  connect(&job_, &Background::progressed, this, [this](double fraction, const QString& what) {
    if (!work_) return;
    work_->words = tr("From a scan to a feel: %1").arg(what);
    work_->fraction = fraction;
    emit changed();
  });
}

TextureDesk::~TextureDesk() = default;

TextureDesk::Scratch::~Scratch() {
  std::error_code unheard; // it is in the temporary folder
  for (const auto& folder : folders) std::filesystem::remove_all(folder, unheard);
}

std::map<Panel, QWidget*> TextureDesk::panels() const {
  return {{Panel::steps, steps_}, {Panel::profile, profile_}, {Panel::library, library_.card()}};
}

void TextureDesk::runAll() {
  run(true);
}

void TextureDesk::run(bool all) {
  if (work_) return;
  if (!demo_) {
    // Never the last one's: a step that was cancelled may still be writing there.
    folder_ = std::filesystem::temp_directory_path() /
              ("patina-demo-" + std::to_string(getpid()) + "-" + std::to_string(++begun_));
    scratch_.folders.push_back(folder_);
    demo_ = std::make_shared<Demo>(folder_, 1);
  }
  const QString title = tr("From a scan to a feel");
  work_ = Work{title, title};
  steps_->show(demo_.get(), false);
  steps_->show(demo_.get(), true);
  emit changed();
  job_.start([this, demo = demo_, all](Progress& progress, const Background::Deliver& deliver) {
    try {
      const std::string& name = demoSteps()[demo->seconds.size()].name;
      Progress part(progress,
                    [&](double fraction, std::string_view) { progress.report(fraction, name); });
      progress.report(0, name);
      runNext(*demo, part);
      deliver(true, [this, all] {
        takeStep();
        if (all && !isDone(*demo_)) run(true);
      });
    } catch (const Cancelled&) {
      deliver(true, [this] { beginAnew(); });
    } catch (const std::exception& error) {
      deliver(true, [this, problem = QString::fromStdString(error.what())] {
        beginAnew();
        showProblem(&window_, tr("A step has failed"), problem,
                    tr("The sequence begins anew; what was open is as it was."));
      });
    }
  });
}

// What a step has half done cannot be gone on with.
void TextureDesk::beginAnew() {
  demo_.reset();
  delete view_;
  view_ = nullptr;
  takeStep();
}

void TextureDesk::takeStep() {
  work_.reset();
  steps_->show(demo_.get(), false);
  has_texture_ = demo_ != nullptr && !demo_->textures.empty();
  if (has_texture_ && material_->count() == 0)
    for (const DemoMaterial& material : demo_->object.materials)
      material_->addItem(QString::fromStdString(material.name));
  if (!has_texture_) material_->clear();
  showProfile();
  draw();
  if (demo_ && isDone(*demo_))
    emit said({tr("Every step's files are in %1, until the window is closed")
                   .arg(QString::fromStdString(folder_.string()))});
  emit changed();
}

void TextureDesk::draw() {
  choosePage();
  if (!demo_) return;
  const bool first = view_ == nullptr;
  if (first) {
    view_ = new ScanView;
    view_->setObjectName(QStringLiteral("texture_view"));
    view_->setToolTip(tr("The toy, the tip's paths on it and the faces that got a texture"));
    cells_->addWidget(view_);
    choosePage();
  }
  view_->picture().setMesh(std::make_shared<const TriangleMesh>(demo_->object.mesh));
  view_->picture().setPath(demoPaths(*demo_));
  view_->picture().setHighlight(texturedFaces(*demo_));
  if (first) view_->picture().setView(ViewPreset::minus_y);
}

void TextureDesk::choosePage() {
  QWidget* page = hasBegun() ? view_ : cells_->widget(0);
  if (library_shown_ && library_.hasScene()) {
    page = library_.view();
    if (cells_->indexOf(page) < 0) cells_->addWidget(page);
  }
  cells_->setCurrentWidget(page);
}

void TextureDesk::showLibrary(bool on) {
  if (on == library_shown_) return;
  library_shown_ = on;
  choosePage();
  showProfile();
}

void TextureDesk::showProfile() {
  material_->setVisible(!library_shown_);
  if (library_shown_) return plot_->setTexture(chosen_ ? &chosen_->value : nullptr);
  const int chosen = material_->currentIndex();
  const bool there = !work_ && has_texture_ && chosen >= 0;
  if (work_) return;
  plot_->setTexture(there ? &demo_->textures[static_cast<std::size_t>(chosen)] : nullptr);
}

void TextureDesk::cancel() {
  library_.cancel();
  if (!work_) return;
  job_.silence();
  beginAnew();
}

void TextureDesk::fit() {
  for (ScanView* view : {view_, library_shown_ ? library_.view() : nullptr})
    if (view != nullptr && view->isVisible()) view->picture().fit();
}

void TextureDesk::setView(ViewPreset view) {
  for (ScanView* each : {view_, library_shown_ ? library_.view() : nullptr})
    if (each != nullptr && each->isVisible()) each->picture().setView(view);
}

void TextureDesk::refresh() {
  if (view_ != nullptr) view_->refresh();
  library_.refresh();
}

} // namespace patina

#include "app/gui/texturing/texture_desk.h"

#include <algorithm>
#include <cmath>

#include <unistd.h>

#include <QGridLayout>
#include <QMenu>
#include <QVBoxLayout>

#include "app/gui/loading/load_dialogs.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "demo/demo_pictures.h"

namespace patina {
namespace {

constexpr double kMilli = 1e3, kMicro = 1e6;
constexpr double kFineStep = 0.1e-3;     // Spacing of drawn points along the path [m].
constexpr double kMinAmplitude = 0.1e-6; // Smallest drawn amplitude of the spectrum [m].

PlotAxes axesOf(const QString& y_unit, std::vector<PlotCurve> curves) {
  return {TextureDesk::tr("mm"), y_unit, std::move(curves)};
}

PlotAxes spectrumOf(const FourierSeries& series, double period) {
  PlotCurve curve{TextureDesk::tr("spectrum"), "accent"};
  // The points go from short to long wavelengths.
  for (std::size_t j = series.a.size(); j-- > 0;) {
    const double amplitude = std::hypot(series.a[j], series.b[j]);
    if (amplitude < kMinAmplitude) continue;
    curve.points << QPointF(kMilli * period / static_cast<double>(j + 1), kMicro * amplitude);
  }
  PlotAxes axes = axesOf(TextureDesk::tr("µm"), {curve});
  axes.spectrum = true;
  return axes;
}

// Plots one period of the heights, and the harmonics.
PlotContent plotOf(const FourierTexture& texture) {
  PlotCurve heights{TextureDesk::tr("height over a period"), "accent"};
  const int steps = std::clamp(8 * harmonics(texture), 64, 2000);
  for (int i = 0; i <= steps; ++i) {
    const double x = period(texture) * i / steps;
    heights.points << QPointF(kMilli * x, kMicro * height(texture, x));
  }
  PlotContent content{{axesOf(TextureDesk::tr("µm"), {heights})}};
  if (texture.kind == TextureKind::line || texture.kind == TextureKind::spectrum)
    content.axes.push_back(spectrumOf(seriesOf(texture), period(texture)));
  return content;
}

// Plots heights, harmonics, and the rendered profile with the true one.
PlotContent plotOf(const DemoTexture& texture) {
  const FourierTexture& fitted = texture.scanned.fitted.texture;
  PlotCurve measured{TextureDesk::tr("measured"), "quiet"},
      series{TextureDesk::tr("harmonics"), "accent"};
  double last = -1;
  for (const ScanHeight& height : texture.scanned.heights) {
    const double along = height.point.arc_length;
    if (along < last + kFineStep) continue;
    last = along;
    measured.points << QPointF(kMilli * along, kMicro * height.point.height);
    series.points << QPointF(kMilli * along, kMicro * patina::height(fitted, along));
  }
  PlotContent content{{axesOf(TextureDesk::tr("µm"), {measured, series}),
                       spectrumOf(seriesOf(fitted), period(fitted))}};
  if (texture.felt.empty()) return content;
  PlotCurve truth{TextureDesk::tr("true surface"), "quiet"},
      felt{TextureDesk::tr("felt"), "accent"};
  for (std::size_t i = 0; i < texture.felt.size(); i += 3) {
    const ForcePoint& point = texture.felt[i];
    truth.points << QPointF(kMilli * point.along, point.truth.dot(point.outward));
    felt.points << QPointF(kMilli * point.along, point.felt.dot(point.outward));
  }
  content.axes.push_back(axesOf(TextureDesk::tr("N"), {truth, felt}));
  return content;
}

QString valueWords(double value, const std::string& unit) {
  return inWords(figureText(value, unit));
}

// Returns the worst value of each figure over all materials.
QString foundBy(const Demo& demo, const std::string& step, bool& holds) {
  QStringList lines;
  std::vector<DemoFigure> worst;
  for (const DemoFigure& figure : demoFigures(demo)) {
    if (figure.step != step) continue;
    holds = holds && figure.passes();
    const auto same = std::find_if(worst.begin(), worst.end(), [&](const DemoFigure& other) {
      return other.what == figure.what;
    });
    if (same == worst.end())
      worst.push_back(figure);
    else if (figure.value > same->value)
      *same = figure;
  }
  for (const DemoFigure& figure : worst)
    lines << StepList::tr("%1: %2, at most %3")
                 .arg(shownText(figure.what), valueWords(figure.value, figure.unit),
                      valueWords(figure.limit, figure.unit));
  return lines.join('\n');
}

QString countsOf(const Demo& demo, const std::string& step) {
  std::size_t frames = 0, poses = 0, faces = 0;
  double tip = 0, path = 0;
  for (const DemoScan& scan : demo.scans) {
    frames += scan.frames;
    poses += scan.streams.poses.size();
    tip = std::max(tip, scan.tip_error);
    path = std::max(path, scan.path_error.rms);
  }
  for (const DemoTexture& texture : demo.textures) faces += texture.scanned.laid.faces.size();
  if (step == "scan") return StepList::tr("%1 scans, %2 frames").arg(demo.scans.size()).arg(frames);
  if (step == "track")
    return StepList::tr("%1 poses, tip within %2 (rms)").arg(poses).arg(valueWords(tip, "m"));
  if (step == "filter") return StepList::tr("tip within %1 (rms)").arg(valueWords(path, "m"));
  if (step == "map") return StepList::tr("%1 faces").arg(faces);
  if (step == "paint") return StepList::tr("three colours, and a region with friction");
  return {};
}

std::shared_ptr<const TriangleMesh> texturedFaces(const Demo& demo) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = demo.object.mesh.positions;
  for (const DemoTexture& texture : demo.textures)
    for (const TexturedFace& face : texture.scanned.laid.faces)
      mesh->triangles.push_back(demo.object.mesh.triangles[index(face.face)]);
  return mesh->triangles.empty() ? nullptr : mesh;
}

} // namespace

StepList::StepList(QWidget* parent) : QGroupBox(tr("From a scan to a feel"), parent) {
  setFocusPolicy(Qt::ClickFocus); // Otherwise keys would go to the parent.
  auto* column = layoutIn<QVBoxLayout>(this, 8);
  next_ = addButton(column, "next_step", {}, {}, this, &StepList::nextRequested);
  next_->setDefault(true);
  all_ = addButton(column, "all_steps", tr("Run all"),
                   tr("Runs the remaining steps: about a minute in all"), this,
                   &StepList::allRequested);
  feel_ = addButton(column, "feel_demo", tr("Feel it"),
                    tr("Opens the new workspace, to touch and paint it"), this,
                    &StepList::feelRequested);
  feel_->setDefault(true);
  look_ = named(new QPushButton(tr("Look at the frames"), this), "look_at_scan",
                tr("Opens a scan of the toy on the desk Scan: frames, markers, path"));
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(8);
  grid->setVerticalSpacing(2);
  grid->setColumnStretch(1, 1);
  for (const DemoStep& step : demoSteps()) {
    const int line = grid->rowCount();
    Row row{new QLabel(this), new QLabel(shownText(step.about), this), quietLabel({})};
    row.mark->setFixedWidth(20);
    row.mark->setAlignment(Qt::AlignTop | Qt::AlignHCenter);
    row.words->setWordWrap(true);
    named(row.words, ("step_" + step.name).c_str());
    row.found->setWordWrap(true);
    named(row.found, ("found_" + step.name).c_str());
    grid->addWidget(row.mark, line, 0, Qt::AlignTop);
    grid->addWidget(row.words, line, 1);
    grid->addWidget(row.found, line + 1, 1);
    if (rows_.empty()) grid->addWidget(look_, line + 2, 1, Qt::AlignLeft);
    rows_.push_back(row);
  }
  column->addLayout(grid);
  look_->setMenu(new QMenu(look_));
  show(nullptr, false);
}

void StepList::offerScans(const Demo* demo) {
  look_->menu()->clear();
  if (demo == nullptr || done_ == 0) return;
  for (const DemoScan& scan : demo->scans) {
    const QString name = shownText(scan.name);
    look_->menu()->addAction(name, this, [this, name] { emit lookRequested(name); });
  }
}

void StepList::show(const Demo* demo, bool running) {
  if (!running) done_ = demo != nullptr ? demo->seconds.size() : 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const bool now = running && i == done_;
    row.words->setEnabled(i <= done_);
    if (running) {
      if (now) row.mark->setText(QStringLiteral("…"));
      continue;
    }
    bool holds = true;
    QString found;
    if (i < done_) {
      const std::string& name = demoSteps()[i].name;
      found = foundBy(*demo, name, holds);
      const QString counts = countsOf(*demo, name);
      if (!counts.isEmpty()) found = found.isEmpty() ? counts : counts + '\n' + found;
    }
    row.mark->setText(i >= done_ ? QString::number(i + 1)
                      : holds    ? QStringLiteral("✓")
                                 : QStringLiteral("✗"));
    say(row.found, found);
  }
  // A disabled button would pass the focus to the next widget.
  if (running && (next_->hasFocus() || all_->hasFocus())) setFocus();
  const bool ended = done_ == rows_.size();
  next_->setVisible(!ended);
  all_->setVisible(!ended);
  feel_->setVisible(ended);
  look_->setVisible(done_ > 0);
  look_->setEnabled(!running);
  if (!running) offerScans(demo);
  next_->setEnabled(!running);
  all_->setEnabled(!running);
  if (!running && hasFocus()) (ended ? feel_ : next_)->setFocus();
  if (!ended)
    next_->setText(done_ == 0 ? tr("Begin with the toy's scan")
                              : tr("Next: %1").arg(shownText(demoSteps()[done_].name)));
  if (!ended) next_->setToolTip(shownText(demoSteps()[done_].about));
}

TextureDesk::TextureDesk(QWidget& window)
    : QObject(&window), window_(window), job_(this), library_(window) {
  central_views_->addWidget(emptyPage(new QLabel(tr(
      "From a scan to a feel, on a toy.\n\nA simulated hand scans three materials on a toy "
      "dinosaur. Eight steps track it, register its path with the mesh, make textures, map them "
      "onto the mesh and let you feel them. Each step reports its error.\n\nTo make a texture from "
      "your own scan, align it on the desk Align, then use From the scan in the card Textures."))));

  auto* page = layoutIn<QVBoxLayout>(profile_, 2);
  page->addWidget(named(material_, "texture_choice",
                        tr("Texture whose heights, harmonics and forces are plotted")),
                  0, Qt::AlignLeft);
  page->addWidget(named(plot_, "profile_plot"), 1);
  connect(material_, qOverload<int>(&QComboBox::currentIndexChanged), this,
          &TextureDesk::showProfile);
  connect(steps_, &StepList::nextRequested, this, [this] { run(false); });
  connect(steps_, &StepList::allRequested, this, [this] { run(true); });
  connect(steps_, &StepList::feelRequested, this,
          [this] { emit openRequested(shownText((folder_ / "workspace").string())); });
  connect(steps_, &StepList::lookRequested, this, [this](const QString& scan) {
    emit scanRequested(shownText((folder_ / ("scan-" + scan.toStdString())).string()));
  });
  connect(&library_, &TextureLibrary::changed, this, &TextureDesk::changed);
  connect(&library_, &TextureLibrary::notified, this, &TextureDesk::notified);
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
  std::error_code ignored; // The system clears the temporary folder.
  for (const auto& folder : folders) std::filesystem::remove_all(folder, ignored);
}

std::map<Panel, QWidget*> TextureDesk::panels() const {
  return {{Panel::steps, steps_}, {Panel::profile, profile_}, {Panel::library, library_.card()}};
}

void TextureDesk::run(bool all) {
  if (work_) return;
  if (!demo_) {
    // A new folder each time, because a cancelled step may still be writing to the last one.
    folder_ = std::filesystem::temp_directory_path() /
              ("patina-demo-" + std::to_string(getpid()) + "-" + std::to_string(++begun_));
    scratch_.folders.push_back(folder_);
    demo_ = std::make_shared<Demo>(folder_, 1);
  }
  const QString title = tr("From a scan to a feel");
  work_ = TaskProgress{title, title};
  steps_->show(demo_.get(), false);
  steps_->show(demo_.get(), true);
  emit changed();
  job_.start([this, demo = demo_, all](Progress& progress, const Background::Post& post) {
    try {
      const std::string& name = demoSteps()[demo->seconds.size()].name;
      Progress part(progress,
                    [&](double fraction, std::string_view) { progress.report(fraction, name); });
      progress.report(0, name);
      runNext(*demo, part);
      post(true, [this, all] {
        takeStep();
        if (all && !isDone(*demo_)) run(true);
      });
    } catch (const Cancelled&) {
      post(true, [this] { restart(); });
    } catch (const std::exception& error) {
      post(true, [this, problem = shownText(error.what())] {
        restart();
        showProblem(&window_, tr("A step has failed"), problem,
                    tr("The demonstration starts again; what was open stays open."));
      });
    }
  });
}

// A failed step cannot be continued.
void TextureDesk::restart() {
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
      material_->addItem(shownText(material.name));
  if (!has_texture_) material_->clear();
  showProfile();
  draw();
  if (demo_ && isDone(*demo_))
    emit notified({tr("The files of all steps are in %1, until the window is closed")
                       .arg(shownText(folder_.string()))});
  emit changed();
}

void TextureDesk::draw() {
  choosePage();
  if (!demo_) return;
  const bool first = view_ == nullptr;
  if (first) {
    view_ = named(new ScanView, "texture_view",
                  tr("The toy, the tip's paths on it and the faces with a texture"));
    central_views_->addWidget(view_);
    choosePage();
  }
  view_->picture().setMesh(std::make_shared<const TriangleMesh>(demo_->object.mesh));
  view_->picture().setPath(demoPaths(*demo_));
  view_->picture().setHighlight(texturedFaces(*demo_));
  if (first) view_->picture().setView(ViewPreset::minus_y);
}

void TextureDesk::choosePage() {
  QWidget* page = hasBegun() ? view_ : central_views_->widget(0);
  if (library_shown_ && library_.hasScene()) {
    page = library_.view();
    if (central_views_->indexOf(page) < 0) central_views_->addWidget(page);
  }
  central_views_->setCurrentWidget(page);
}

void TextureDesk::showLibrary(bool on) {
  if (on == library_shown_) return;
  library_shown_ = on;
  choosePage();
  showProfile();
}

void TextureDesk::showProfile() {
  material_->setVisible(!library_shown_);
  if (library_shown_) return plot_->setContent(chosen_ ? plotOf(chosen_->value) : PlotContent());
  const int chosen = material_->currentIndex();
  const bool there = !work_ && has_texture_ && chosen >= 0;
  if (work_) return;
  plot_->setContent(there ? plotOf(demo_->textures[static_cast<std::size_t>(chosen)])
                          : PlotContent());
}

void TextureDesk::cancel() {
  library_.cancel();
  if (!work_) return;
  job_.discardResult();
  restart();
}

void TextureDesk::fit() {
  for (ScanView* view : {view_, library_shown_ ? library_.view() : nullptr})
    if (view != nullptr && view->isVisible()) view->picture().fit();
}

void TextureDesk::setView(ViewPreset view) {
  for (ScanView* each : {view_, library_shown_ ? library_.view() : nullptr})
    if (each != nullptr && each->isVisible()) each->picture().setView(view);
}

} // namespace patina

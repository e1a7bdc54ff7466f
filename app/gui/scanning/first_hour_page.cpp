#include "app/gui/scanning/first_hour_page.h"

#include <cmath>

#include <QDir>
#include <QPainter>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include "acquisition/files/camera_file.h"
#include "app/gui/scanning/found_files.h"
#include "app/gui/scanning/frame_view.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/words.h"
#include "core/error.h"
#include "core/file.h"
#include "scan/print_rig.h"

namespace patina {
namespace {

constexpr double kWaveSeconds = 60;
constexpr int kWidth = 800;         // Largest width of lines and steps [px].
constexpr int kTicksOfReading = 60; // The folder is read again after as many ticks.
const QColor kSeen(0x20, 0xc0, 0x90, 70), kRaster(255, 255, 255, 110), kCorner(0x3d, 0xe0, 0xff);

QString shownFigure(const std::string& text) {
  return inWords(text).replace(QStringLiteral("+-"), QStringLiteral("±"));
}

// Applies the style of a property that has changed.
void restyle(QWidget& widget) {
  widget.style()->unpolish(&widget);
  widget.style()->polish(&widget);
}

// Tints the parts of the picture that the board has covered.
QImage withCoverage(const QImage& image, const BoardGuide& guide) {
  QImage drawn = image.convertToFormat(QImage::Format_RGB32);
  QPainter painter(&drawn);
  const auto cells = static_cast<int>(BoardGuide::kCells);
  for (int i = 0; i < cells * cells; ++i) {
    const int row = i / cells, column = i % cells;
    const QRect cell(
        QPoint(column * drawn.width() / cells, row * drawn.height() / cells),
        QPoint((column + 1) * drawn.width() / cells - 1, (row + 1) * drawn.height() / cells - 1));
    if (guide.seen[static_cast<std::size_t>(i)]) painter.fillRect(cell, kSeen);
    painter.setPen(QPen(kRaster, 0));
    painter.drawRect(cell);
  }
  return drawn;
}

// Returns the advice for this time of the recording.
QString waveAdvice(double seconds) {
  const double share = seconds / kWaveSeconds;
  if (share < 0.5) return FirstHourPage::tr("Wave the rig and turn all its sides to the camera");
  if (share < 0.9)
    return FirstHourPage::tr("Put the tip into a dimple and turn the rig about it to all sides");
  return FirstHourPage::tr("Lay the rig to rest");
}

std::vector<MeasuredSize> measuredIn(const QString& words, const std::string& rig,
                                     const std::string& name) {
  if (words.isEmpty()) return {};
  const double size = parseLength(words.toStdString());
  if (!(size > 0 && size < 100)) throw Error("the measured side must be above 0");
  return {{parseMarkers(rig, name).front().id, size}};
}

} // namespace

FirstHourPage::FirstHourPage(QWidget* parent)
    : QWidget(parent), job_(this), recording_(this), settings_(new QWidget(this)),
      lines_(layoutIn<QGridLayout>(settings_, 4)), steps_(new QWidget(this)),
      grid_(layoutIn<QGridLayout>(steps_)), live_(named(new PictureView(this), "hour_live")),
      room_(new QWidget(this)) {
  setObjectName(QStringLiteral("first_hour"));
  applyStyleSheet(*this, QStringLiteral("QLabel#hour_title { font-size: 13pt; font-weight: bold; }"
                                        "QLabel#hour_advice { font-size: 13pt; font-weight: bold; }"
                                        "QLabel[quiet=\"true\"] { color: @quiet; }"
                                        "QLabel[bad=\"true\"] { color: @bad; }"
                                        "QLabel[mark=\"done\"] { color: @series_y; }"
                                        "QLabel[mark=\"next\"] { color: @accent; }"
                                        "QLabel[mark=\"open\"] { color: @faint; }"
                                        "QLabel[mark] { font-size: 13pt; font-weight: bold; }"));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(16, 12, 16, 12);
  column->setSpacing(8);
  auto* top = new QHBoxLayout;
  top->addWidget(named(new QLabel(tr("The first hour")), "hour_title"));
  top->addWidget(quietLabel(tr("from nothing to a scan")), 1);
  addButton(top, "open_first_scan", tr("Open scan…"),
            tr("A folder of frames, poses, a probe's stream or a path. You can also drop one on "
               "the window."),
            this, &FirstHourPage::openRequested);
  column->addLayout(top);
  const auto addNarrow = [&](QWidget* widget) {
    auto* line = new QHBoxLayout;
    widget->setMaximumWidth(kWidth);
    line->addWidget(widget, 1000);
    line->addStretch(1);
    column->addLayout(line);
  };
  addNarrow(settings_);
  lines_->setColumnStretch(1, 1);
  folder_ = addLine("hour_folder", tr("Folder"),
                    tr("Holds everything of this rig: sheets, camera.yml, rig.json, recordings"));
  folder_->setText(QDir::home().filePath(QStringLiteral("patina-rig")));
  auto* look = named(new QToolButton, "hour_choose", tr("Choose a folder"));
  look->setText(QStringLiteral("…"));
  lines_->addWidget(look, 0, 2);
  connect(look, &QToolButton::clicked, this, [this] {
    askForPath(window(), tr("Folder of the rig"), QFileDialog::Directory, {},
               [this](const QString& path) { folder_->setText(path); });
  });
  camera_ = addLine("hour_camera", tr("Camera"),
                    tr("camera:0 for the first camera, or replay: before a folder of frames"));
  camera_->setText(QStringLiteral("camera:0"));
  board_ = addLine("hour_board", tr("Board"),
                   tr("The board that is photographed: the printed one, or "
                      "chessboard:COLUMNSxROWS:SQUARE, counted in inner corners"));
  measured_ = addLine("hour_measured", tr("Marker"),
                      tr("Side of the black square of the first marker as a calliper measures it, "
                         "27.05mm; without it the scale stays as uncertain as the print"));
  measured_->setPlaceholderText(tr("side of its black square, if measured: 27mm"));
  shape_ = named(new QComboBox(this), "hour_shape", tr("Body of the rig that is printed"));
  for (const QString& words :
       {tr("Cube, 5 markers"), tr("Pen, 13 markers"), tr("Dodecahedron, 11 markers")})
    shape_->addItem(words);
  lines_->addWidget(quietLabel(tr("Shape")), lines_->rowCount(), 0);
  lines_->addWidget(shape_, lines_->rowCount() - 1, 1);

  grid_->setHorizontalSpacing(10);
  grid_->setVerticalSpacing(8);
  grid_->setColumnStretch(2, 1);
  addNarrow(steps_);
  addStep(kPrint, "hour_print", tr("Print"),
          tr("Writes markers.pdf, board.pdf, holder.stl and rig.json into the folder"));
  addStep(kPhotograph, "hour_photograph", tr("Photograph"),
          tr("Finds the board in the camera's picture, says where to hold it next, and calibrates "
             "the camera when it was everywhere"));
  addStep(kWave, "hour_wave", tr("Wave"),
          tr("Records the rig for a minute and finds its markers and its tip"));
  addStep(kScan, "hour_scan", tr("Scan"),
          tr("Records a scan with this rig and the probe of the card Record"));
  advice_ = addNote(column, "hour_advice", "");
  column->addWidget(live_, 1);
  summary_ = addNote(column, "hour_summary");
  note_ = addNote(column, "hour_note", "");
  note_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  column->addWidget(room_, 1);
  live_->setMinimumSize(200, 150);
  live_->hide();

  connect(folder_, &QLineEdit::textChanged, this, &FirstHourPage::readFolder);
  connect(&job_, &Background::progressed, this, [this](double fraction, const QString&) {
    if (running_ == Running::calibrating)
      say(summary_, tr("Finding the rig: %1 %").arg(std::lround(100 * fraction)));
  });
  connect(&recording_, &ScanRecording::updated, this, &FirstHourPage::showWave);
  connect(&recording_, &ScanRecording::failed, this,
          [this](const QString& problem) { end(problem, true); });
  connect(&recording_, &ScanRecording::ended, this,
          [this](const QString& recorded, const QString& problem) {
            if (!problem.isEmpty()) return end(problem, true);
            calibrate(recorded.toStdString());
          });
  readFolder();
}

QLineEdit* FirstHourPage::addLine(const char* name, const QString& caption, const QString& tip) {
  const int row = lines_->count() == 0 ? 0 : lines_->rowCount();
  auto* line = named(new QLineEdit(settings_), name, tip);
  lines_->addWidget(quietLabel(caption), row, 0);
  lines_->addWidget(line, row, 1);
  return line;
}

void FirstHourPage::addStep(Step step, const char* button, const QString& name,
                            const QString& tip) {
  Row& row = rows_[step];
  row.mark = named(new QLabel, (std::string(button) + "_mark").c_str());
  row.mark->setFixedWidth(fontMetrics().horizontalAdvance(QStringLiteral("MM")));
  row.mark->setAlignment(Qt::AlignCenter);
  row.name = new QLabel(name);
  row.words = named(new QLabel, (std::string(button) + "_words").c_str());
  row.words->setWordWrap(true);
  row.button = named(new QPushButton(name), button, tip);
  row.button->setMinimumWidth(110);
  connect(row.button, &QPushButton::clicked, this, [this, step] { act(step); });
  grid_->addWidget(row.mark, step, 0);
  grid_->addWidget(row.name, step, 1);
  grid_->addWidget(row.words, step, 2);
  grid_->addWidget(row.button, step, 3);
}

void FirstHourPage::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  readFolder();
}

void FirstHourPage::refresh() {
  recording_.refresh();
  if (isVisible() && running_ == Running::nothing && ++ticks_ % kTicksOfReading == 0) readFolder();
}

void FirstHourPage::finish() {
  recording_.finish();
  job_.wait();
}

void FirstHourPage::readFolder() {
  const bool is_other = read_ != folder_->text();
  read_ = folder_->text();
  const std::string board = hour_.board;
  hour_ = readFirstHour(folder());
  // A board that the user has named stays.
  if (board_->text().isEmpty() || board_->text().toStdString() == board)
    board_->setText(shownText(hour_.board));
  if (is_other && running_ == Running::nothing) say(note_, {});
  showSteps();
}

void FirstHourPage::showSteps() {
  const std::array<const FirstHourStep*, kSteps> steps{&hour_.print, &hour_.photograph, &hour_.wave,
                                                       &hour_.scan};
  const bool waits = hour_.waved != failed_ && !hour_.waved.empty() && !hour_.wave.done;
  rows_[kWave].button->setText(waits ? tr("Calibrate") : tr("Wave"));
  const int running = running_ == Running::printing        ? kPrint
                      : running_ == Running::photographing ? kPhotograph
                      : running_ == Running::nothing       ? -1
                                                           : kWave;
  bool is_next = true;
  for (int i = 0; i < kSteps; ++i) {
    const FirstHourStep& step = *steps[static_cast<std::size_t>(i)];
    const Row& row = rows_[static_cast<std::size_t>(i)];
    const QString between = step.figure.empty() || step.remedy.empty() ? "" : "; ";
    row.words->setText(shownFigure(step.figure) + between + shownFigure(step.remedy));
    const char* mark = step.done ? "done" : is_next ? "next" : "open";
    row.mark->setText(step.done ? QStringLiteral("✓") : QString::number(i + 1));
    row.mark->setToolTip(step.done ? tr("Done") : is_next ? tr("The next step") : tr("Open"));
    row.mark->setProperty("mark", mark);
    row.words->setProperty("quiet", !step.done);
    QFont font = row.name->font();
    font.setBold(!step.done && is_next);
    row.name->setFont(font);
    is_next = is_next && step.done;
    for (QLabel* label : {row.mark, row.words}) restyle(*label);
    const bool ready =
        i == kPrint || i == kPhotograph ||
        (hour_.print.done && hour_.photograph.done && (i == kWave || hour_.wave.done));
    row.button->setEnabled(running == i || (running == -1 && ready));
    if (running == i)
      row.button->setText(tr("Stop"));
    else if (i != kWave)
      row.button->setText(row.name->text());
  }
  const bool shows = running_ == Running::photographing || running_ == Running::waving;
  settings_->setVisible(!shows);
  live_->setVisible(shows);
  room_->setVisible(!shows);
}

void FirstHourPage::begin(Running running, const QString& words) {
  running_ = running;
  say(note_, {});
  say(advice_, words);
  say(summary_, {});
  live_->setContent({{}, {}, tr("Waiting for the camera")});
  showSteps();
}

void FirstHourPage::end(const QString& words, bool is_bad) {
  running_ = Running::nothing;
  say(advice_, {});
  say(summary_, {});
  note_->setProperty("bad", is_bad);
  restyle(*note_);
  say(note_, withoutCommands(words));
  readFolder();
}

void FirstHourPage::act(Step step) {
  switch (running_) {
  case Running::photographing:
    if (!ends_->exchange(true)) return;
    job_.discardResult(); // The camera gives no picture.
    return end(tr("Stopped; nothing has changed"));
  case Running::waving:
    return recording_.end();
  case Running::printing:
  case Running::calibrating:
    job_.discardResult();
    return end(tr("Stopped; nothing has changed"));
  case Running::nothing:
    break;
  }
  switch (step) {
  case kPrint:
    return print();
  case kPhotograph:
    return photograph();
  case kWave:
    if (rows_[kWave].button->text() == tr("Calibrate")) return calibrate(hour_.waved);
    return wave();
  default:
    emit scanRequested({camera_->text().trimmed(),
                        {},
                        folder_->text().trimmed(),
                        shownText(freshPath(folder(), "scan").string())});
  }
}

void FirstHourPage::print() {
  begin(Running::printing, {});
  RigPlan plan;
  plan.shape = static_cast<RigShape>(shape_->currentIndex());
  job_.start([this, plan, into = folder()](Progress&, const Background::Post& post) {
    try {
      const PrintRigReport printed = printRig(plan, into);
      post(true, [this, printed, into] {
        end(tr("Print markers.pdf and board.pdf of %1 at 100 %, check the ruler, glue the markers "
               "onto the holder (holder.stl) and the board onto something flat.")
                .arg(shownText(into.string())));
      });
    } catch (const std::exception& error) {
      post(true, [this, words = shownText(error.what())] { end(words, true); });
    }
  });
}

void FirstHourPage::photograph() {
  const std::string words = board_->text().trimmed().toStdString();
  std::optional<Board> board;
  try {
    board = parseBoard(words);
    makeFolder(folder());
  } catch (const Error& error) {
    return end(shownText(error.what()), true);
  }
  begin(Running::photographing, tr("Hold the board into the picture"));
  ends_ = std::make_shared<std::atomic<bool>>(false);
  job_.start([this, board = *board, words, ends = ends_, into = folder() / "camera.yml",
              from = camera_->text().trimmed().toStdString()](Progress& progress,
                                                              const Background::Post& post) {
    Progress looking(progress, {});
    const auto seen = [&](const BoardLook& look) {
      if (*ends) looking.cancel();
      post(false, [this, image = imageOf(look.image), guide = look.guide,
                   corners = look.view ? look.view->pixel : std::vector<Vec2>()] {
        showBoard(image, corners, guide);
      });
    };
    try {
      const CameraCalibration found = calibrateCamera({from, board, words}, looking, seen);
      progress.throwIfCancelled();
      if (!found.doubt.empty()) throw Error(found.doubt);
      writeKeepingOld(into, found.file);
      QStringList lines(tr("camera.yml is there, from %1 views").arg(found.views));
      for (const std::string& line : found.notes) lines << shownText(line);
      post(true, [this, lines] { end(lines.join('\n')); });
    } catch (const std::exception& error) {
      post(true, [this, problem = shownText(error.what())] { end(problem, true); });
    }
  });
}

void FirstHourPage::showBoard(const QImage& image, const std::vector<Vec2>& corners,
                              const BoardGuide& guide) {
  PictureContent content{withCoverage(image, guide)};
  QPolygonF points;
  for (const Vec2& corner : corners) points << QPointF(corner.x(), corner.y());
  content.marks.push_back({points, kCorner, 1.4, PictureMark::Shape::crosses});
  live_->setContent(content);
  QString advice = shownText(guide.advice);
  if (!advice.isEmpty()) advice[0] = advice[0].toUpper();
  say(advice_, advice);
  say(summary_,
      shownText(guide.summary()) + (guide.blur && std::isfinite(*guide.blur)
                                        ? tr(", blurred %1 px").arg(*guide.blur, 0, 'f', 1)
                                        : QString()));
}

void FirstHourPage::wave() {
  begin(Running::waving, waveAdvice(0));
  recording_.begin({camera_->text().trimmed(),
                    {},
                    folder_->text().trimmed(),
                    shownText(freshPath(folder(), "wave").string())});
}

void FirstHourPage::showWave(const RecordingUpdate& news) {
  if (news.frame) {
    PictureContent content{imageOf(news.frame->image)};
    content.marks = markerMarks(news.frame->markers);
    live_->setContent(content);
  }
  say(advice_, waveAdvice(news.state.seconds));
  say(summary_, tr("%1 of %2 s, frames: %3, with a pose: %4")
                    .arg(news.state.seconds, 0, 'f', 0)
                    .arg(kWaveSeconds)
                    .arg(news.state.frames)
                    .arg(news.state.poses));
  if (news.state.seconds >= kWaveSeconds) recording_.end();
}

void FirstHourPage::calibrate(const std::filesystem::path& recording) {
  begin(Running::calibrating, {});
  failed_ = recording;
  job_.start([this, recording, measured = measured_->text().trimmed(),
              into = folder() / "rig.json"](Progress& progress, const Background::Post& post) {
    try {
      const std::filesystem::path rig = recording / "rig.json";
      const std::string text = readFile(rig);
      RigCalibrationOptions options{.frames = recording.string(),
                                    .camera = readCamera(recording / "camera.yml")};
      options.fit.measured = measuredIn(measured, text, rig.string());
      const RigCalibration found = calibrateRig(options, {text, rig.string()}, progress);
      progress.throwIfCancelled();
      if (!found.doubt.empty()) throw Error(found.doubt);
      writeKeepingOld(into, found.file);
      QStringList lines(tr("rig.json is calibrated, the one before is rig.json~; corners miss by "
                           "%1 px instead of %2 px")
                            .arg(found.fit.rms, 0, 'f', 2)
                            .arg(found.fit.rms_before, 0, 'f', 2));
      for (const std::string& line : found.warnings) lines << shownText(line);
      post(true, [this, lines] { end(lines.join('\n')); });
    } catch (const std::exception& error) {
      post(true, [this, problem = shownText(error.what())] { end(problem, true); });
    }
  });
}

} // namespace patina

#include "app/gui/scanning/calibration_card.h"

#include <cmath>

#include <QScrollArea>
#include <QTimer>
#include <QVBoxLayout>

#include "app/gui/widgets/words.h"
#include "core/error.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr std::size_t kLeastPoses = 10;
constexpr int kLaidOut = 50; // until the column has made room [ms]

QString withDeviation(double value, double deviation, int digits) {
  return QStringLiteral("%1 ± %2").arg(value, 0, 'f', digits).arg(deviation, 0, 'g', 2);
}

QString wordsOf(const CalibratedCamera& found) {
  const auto values = parametersOf(found.fit.camera);
  QString words = CalibrationCard::tr("rms %1 px, the board in %2 of %3")
                      .arg(found.fit.rms, 0, 'f', 3)
                      .arg(found.views)
                      .arg(found.frames);
  for (std::size_t i = 0; i < values.size(); ++i)
    words += QStringLiteral("\n%1 %2%3")
                 .arg(QString::fromUtf8(kCameraParameters[i]),
                      withDeviation(values[i], found.fit.deviation[i], i < 4 ? 2 : 5),
                      i < 4 ? QStringLiteral(" px") : "");
  for (const std::string& line : found.notes) words += "\n" + QString::fromStdString(line);
  return words;
}

QString wordsOf(const PivotFit& fit, std::size_t poses) {
  QString words = CalibrationCard::tr("rms %1, %2 of %3 poses")
                      .arg(inWords(fit.rms))
                      .arg(poses - fit.rejected)
                      .arg(poses);
  for (int i = 0; i < 3; ++i)
    words += QStringLiteral("\n%1 %2 mm")
                 .arg(QChar('x' + i))
                 .arg(withDeviation(1e3 * fit.tip[i], 1e3 * std::sqrt(fit.covariance(i, i)), 3));
  return words;
}

} // namespace

CalibrationCard::CalibrationCard(OpenScan& scan, QWidget* parent)
    : QGroupBox(tr("Calibrate"), parent), scan_(scan), job_(this), board_(new QLineEdit(this)),
      source_(new QLineEdit(this)), found_(new QLabel(this)) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(6);
  board_->setObjectName(QStringLiteral("calibrate_board"));
  board_->setText(QStringLiteral("chessboard:9x6:25mm"));
  board_->setToolTip(tr("chessboard:COLUMNSxROWS:SQUARE, counted in inner corners, or "
                        "charuco:COLUMNSxROWS:SQUARE:MARKER:FAMILY, counted in squares"));
  column->addWidget(board_);
  source_->setObjectName(QStringLiteral("calibrate_source"));
  source_->setPlaceholderText(tr("a video, camera:0 or replay:FOLDER"));
  source_->setToolTip(tr("Where the board is seen, in place of what is open: sharp frames that "
                         "differ are chosen, and a camera is watched until there are 60"));
  column->addWidget(source_);
  pictures_ = button("calibrate_pictures", tr("Open pictures…"),
                     tr("A folder of pictures of the board, without times"));
  camera_ = button("calibrate_camera", tr("Camera from the board"),
                   tr("Looks for the board in every frame and fits the camera, as `patina "
                      "calibrate --board` does"));
  tip_ = button("calibrate_tip", tr("Tip from the poses"),
                tr("The point that stood still while the probe turned about it, as `patina "
                   "calibrate` finds it"));
  found_->setObjectName(QStringLiteral("calibrate_found"));
  found_->setWordWrap(true);
  found_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  column->addWidget(found_);
  use_ = button("calibrate_use", tr("Use it"),
                tr("Becomes the scan's: in the workspace where the scan is in it, where it can be "
                   "undone, else in the scan's folder. What follows from it is found anew"));
  connect(pictures_, &QPushButton::clicked, this, &CalibrationCard::picturesAsked);
  connect(camera_, &QPushButton::clicked, this, &CalibrationCard::findCamera);
  connect(tip_, &QPushButton::clicked, this, &CalibrationCard::findTip);
  connect(use_, &QPushButton::clicked, this, [this] { emit useAsked(file_, text_); });
  connect(source_, &QLineEdit::textChanged, this, &CalibrationCard::refresh);
  connect(&job_, &Background::progressed, this,
          [this](double fraction, const QString&) { emit progressed(fraction); });
  connect(&scan_, &OpenScan::opened, this, [this] {
    job_.silence();
    offer({}, {}, {});
  });
  for (const auto signal : {&OpenScan::pathMade, &OpenScan::finished})
    connect(&scan_, signal, this, &CalibrationCard::refresh);
  refresh();
}

QPushButton* CalibrationCard::button(const char* name, const QString& words, const QString& tip) {
  auto* made = new QPushButton(words, this);
  made->setObjectName(QString::fromUtf8(name));
  made->setToolTip(tip);
  layout()->addWidget(made);
  return made;
}

void CalibrationCard::cancel() {
  if (!job_.busy()) return;
  job_.silence();
  refresh();
  emit changed();
}

void CalibrationCard::refresh() {
  const bool frames = scan_.files() != nullptr && !scan_.grows() && !scan_.files()->frames.empty();
  const bool poses =
      scan_.path() != nullptr && !scan_.grows() && scan_.path()->poses.size() >= kLeastPoses;
  const bool seen = frames || !source_->text().trimmed().isEmpty();
  board_->setVisible(seen);
  camera_->setVisible(seen);
  tip_->setVisible(poses);
  for (QPushButton* each : {pictures_, camera_, tip_}) each->setEnabled(!job_.busy());
  found_->setVisible(!found_->text().isEmpty());
  use_->setVisible(!file_.isEmpty());
}

void CalibrationCard::offer(const QString& words, const QString& file, const std::string& text) {
  found_->setText(words);
  found_->setProperty("bad", false);
  file_ = file;
  text_ = QString::fromStdString(text);
  refresh();
  emit changed();
  QTimer::singleShot(kLaidOut, this, &CalibrationCard::bringIntoView);
}

void CalibrationCard::bringIntoView() {
  if (found_->text().isEmpty()) return;
  QWidget* last = file_.isEmpty() ? static_cast<QWidget*>(found_) : use_;
  for (QWidget* above = parentWidget(); above != nullptr; above = above->parentWidget())
    if (auto* column = qobject_cast<QScrollArea*>(above)) return column->ensureWidgetVisible(last);
}

void CalibrationCard::refuse(const QString& problem) {
  offer(problem, {}, {});
}

void CalibrationCard::findCamera() {
  const std::string words = board_->text().toStdString();
  std::optional<Board> board;
  try {
    board = parseBoard(words);
  } catch (const Error& error) {
    return refuse(QString::fromStdString(error.what()));
  }
  offer({}, {}, {});
  const std::string source = source_->text().trimmed().toStdString();
  const std::string from = source.empty() ? scan_.files()->folder.string() : source;
  job_.start([this, board = *board, words, from,
              is_open = source.empty()](Progress& progress, const Background::Deliver& deliver) {
    try {
      const auto seen = [&](std::size_t i, const std::optional<BoardView>& view) {
        if (view && is_open) deliver(false, [this, i, found = *view] { emit boardSeen(i, found); });
      };
      // Nobody needs to know when pictures were taken.
      const auto frames = openFrames(from, std::filesystem::is_directory(from) ? 1 : 0);
      const CalibratedCamera found = calibrateCamera(*frames, board, words, from, progress, seen);
      deliver(true, [this, found, words] {
        if (!found.doubt.empty()) return refuse(QString::fromStdString(found.doubt));
        offer(wordsOf(found), QStringLiteral("camera.yml"), calibratedText(found.fit, words));
      });
    } catch (const std::exception& error) {
      deliver(true, [this, problem = QString::fromStdString(error.what())] { refuse(problem); });
    }
  });
  refresh();
  emit changed();
}

void CalibrationCard::findTip() {
  try {
    const std::vector<CameraPose>& poses = scan_.path()->poses;
    const std::string where = scan_.name().toStdString();
    const PivotFit fit = tipOf(poses, where);
    const std::string* rig = scan_.files()->scan.text("rig.json");
    offer(wordsOf(fit, poses.size()), QStringLiteral("rig.json"),
          rigWithTip(rig ? *rig : "{}", where + "/rig.json", fit));
  } catch (const Error& error) {
    refuse(QString::fromStdString(error.what()));
  }
}

} // namespace patina

#include "app/gui/window/welcome_page.h"

#include <QEvent>
#include <QFileInfo>

#include "app/gui/loading/presets.h"
#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/theme.h"
#include "app/gui/toolkit/value_row.h"

namespace patina {
namespace {

constexpr int kRecentShown = 5;
constexpr QSize kPicture{144, 108};

QLabel* heading(const QString& words, const char* name) {
  return named(new QLabel(words), name);
}

} // namespace

WelcomePage::WelcomePage(QWidget& over)
    : QScrollArea(&over), over_(over), recent_column_(new QVBoxLayout) {
  hide();
  setObjectName(QStringLiteral("welcome"));
  setCursor(Qt::ArrowCursor);
  setFocusPolicy(Qt::NoFocus); // Its cards take the keys.
  applyStyleSheet(
      *this, QStringLiteral(
                 "QScrollArea#welcome, QWidget#welcome_page {"
                 " background: @window; }"
                 "QLabel#welcome_title { color: @text; font-size: 15pt; font-weight: bold; }"
                 "QLabel#welcome_words { color: @quiet; }"
                 "QLabel#welcome_recent, QLabel#welcome_try { color: @text; font-weight: bold; }"
                 "QToolButton { background: @card; color: @text; border: 1px solid @line;"
                 " border-radius: 6px; padding: 6px; }"
                 "QToolButton:hover { background: @hover; }"
                 "QToolButton:focus { border: 2px solid @accent; padding: 5px; }"
                 "QPushButton[recent=\"true\"] { border: 1px solid transparent; border-radius: 4px;"
                 " color: @link; background: transparent; text-align: left; padding: 3px 4px; }"
                 "QPushButton[recent=\"true\"]:hover { background: @hover; }"
                 "QPushButton[recent=\"true\"]:focus { border-color: @accent; }"));
  auto* column = new QVBoxLayout;
  column->setSpacing(8);
  column->addWidget(heading(tr("Surfaces to see, shape and feel"), "welcome_title"));
  column->addWidget(heading(tr("Open a mesh, a volume, a workspace or a scan, or drop it here."),
                            "welcome_words"));
  auto* line = new QHBoxLayout;
  addButton(line, "welcome_open", tr("Open…"), tr("A mesh, a volume, a workspace or a scan folder"),
            this, &WelcomePage::openRequested);
  addButton(line, "welcome_guide", tr("From a scan to a feel…"),
            tr("The desks Scan, Align and Texture, step by step"), this,
            &WelcomePage::guideRequested);
  line->addStretch(1);
  column->addLayout(line);
  column->addSpacing(10);
  addPresets(*column);
  column->addSpacing(10);
  column->addLayout(recent_column_);
  auto* across = new QHBoxLayout;
  across->addStretch(1);
  across->addLayout(column);
  across->addStretch(1);
  auto* page = named(new QWidget, "welcome_page"); // Scrolled if there is no room.
  auto* whole = new QVBoxLayout(page);
  whole->addStretch(1);
  whole->addLayout(across);
  whole->addStretch(2);
  setWidget(page);
  setWidgetResizable(true);
  setFrameShape(QFrame::NoFrame);
  over_.installEventFilter(this);
  setGeometry(over_.rect());
}

void WelcomePage::addPresets(QVBoxLayout& column) {
  column.addWidget(heading(tr("Try one"), "welcome_try"));
  auto* row = new QHBoxLayout;
  row->setSpacing(8);
  for (const Preset& preset : presets()) {
    const QString name = QString::fromStdString(preset.name);
    auto* button =
        addButton<QToolButton>(row, ("preset_" + preset.name).c_str(), preset.words, preset.tip,
                               this, [this, name] { emit presetChosen(name); });
    button->setIcon(QIcon(pictureOf(preset)));
    button->setIconSize(kPicture);
    button->setToolButtonStyle(Qt::ToolButtonTextUnderIcon);
    button->setFocusPolicy(Qt::StrongFocus);
    button->setFixedWidth(kPicture.width() + 22);
    if (first_ == nullptr) first_ = button;
  }
  column.addLayout(row);
}

void WelcomePage::setRecent(const QStringList& paths) {
  if (paths == recent_paths_) return;
  recent_paths_ = paths;
  takeAway(recent_);
  recent_ = nullptr;
  if (paths.isEmpty()) return;
  recent_ = new QWidget(this);
  auto* column = layoutIn<QVBoxLayout>(recent_, 2);
  column->addWidget(heading(tr("Open again"), "welcome_recent"));
  for (const QString& path : paths.mid(0, kRecentShown)) {
    const QFileInfo file(path);
    auto* button = new QPushButton(
        fontMetrics().elidedText(QStringLiteral("%1   %2").arg(file.fileName(), file.path()),
                                 Qt::ElideMiddle, 4 * kPicture.width()));
    button->setProperty("recent", true);
    button->setToolTip(path);
    button->setCursor(Qt::PointingHandCursor);
    connect(button, &QPushButton::clicked, this, [this, path] { emit recentChosen(path); });
    column->addWidget(button);
  }
  recent_column_->addWidget(recent_);
}

void WelcomePage::setShown(bool on) {
  if (isHidden() != on) return;
  setVisible(on);
  if (on) raise();
  if (!over_.isHidden()) takeKeys(); // Otherwise another desk has the keys.
}

void WelcomePage::takeKeys() {
  QWidget& next = isHidden() ? over_ : *first_;
  next.setFocus();
}

bool WelcomePage::eventFilter(QObject* receiver, QEvent* event) {
  if (receiver == &over_ && event->type() == QEvent::Resize) setGeometry(over_.rect());
  if (receiver == &over_ && event->type() == QEvent::Show && !isHidden()) takeKeys();
  return QScrollArea::eventFilter(receiver, event);
}

} // namespace patina

#include "app/gui/window/user_guide.h"

#include <QFile>
#include <QLineEdit>
#include <QRegularExpression>
#include <QShortcut>
#include <QTextBrowser>
#include <QVBoxLayout>

void initGuideResource() {
  Q_INIT_RESOURCE(user_guide); // of a static library
}

namespace patina {
namespace {

constexpr int kWidth = 760, kHeight = 640; // [px]

class GuideWindow final : public QWidget {
 public:
  explicit GuideWindow(QWidget& over) : QWidget(&over, Qt::Window) {
    setObjectName(QStringLiteral("user_guide"));
    setWindowTitle(tr("User guide"));
    setAttribute(Qt::WA_DeleteOnClose);
    resize(kWidth, kHeight);
    auto* find = new QLineEdit(this);
    find->setObjectName(QStringLiteral("guide_find"));
    find->setPlaceholderText(tr("Find in the guide; Return goes on"));
    auto* text = new QTextBrowser(this);
    text->setObjectName(QStringLiteral("guide_text"));
    text->setOpenLinks(false); // they lead to other files of the project
    initGuideResource();
    QFile file(QStringLiteral(":/user_guide.md"));
    if (file.open(QIODevice::ReadOnly)) {
      static const QRegularExpression kPicture(QStringLiteral(R"(!\[[^\]]*\]\([^)]*\))"));
      text->setMarkdown(QString::fromUtf8(file.readAll()).remove(kPicture)); // they are wide
    }
    connect(new QShortcut(Qt::Key_Escape, this), &QShortcut::activated, this, &QWidget::close);
    auto* column = new QVBoxLayout(this);
    column->addWidget(find);
    column->addWidget(text);
    connect(find, &QLineEdit::returnPressed, text, [find, text] {
      if (text->find(find->text())) return;
      text->moveCursor(QTextCursor::Start); // round again
      text->find(find->text());
    });
  }
};

} // namespace

void showGuide(QWidget& over) {
  auto* guide = over.findChild<QWidget*>(QStringLiteral("user_guide"));
  if (!guide) guide = new GuideWindow(over);
  guide->show();
  guide->raise();
  guide->activateWindow();
}

} // namespace patina

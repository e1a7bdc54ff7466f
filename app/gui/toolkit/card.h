// Parts of cards and dialogs, which look and behave alike on every desk.
#pragma once

#include <functional>

#include <QFileDialog>
#include <QGridLayout>
#include <QLabel>
#include <QLayout>
#include <QListWidget>
#include <QPushButton>
#include <QStringList>

namespace patina {

// Gives the widget an object name, by which tests and styles find it, and a tooltip.
template <typename Widget>
Widget* named(Widget* widget, const char* name, const QString& tip = {}) {
  widget->setObjectName(QString::fromUtf8(name));
  widget->setToolTip(tip);
  return widget;
}

// Gives the widget a layout without margins.
template <typename Layout> Layout* layoutIn(QWidget* widget, int spacing = 6) {
  auto* layout = new Layout(widget);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(spacing);
  return layout;
}

template <typename Button = QPushButton>
Button* addButton(QLayout* layout, const char* name, const QString& words, const QString& tip) {
  auto* button = named(new Button, name, tip);
  button->setText(words);
  layout->addWidget(button);
  return button;
}

// The same, and a click calls the receiver.
template <typename Button = QPushButton, typename Receiver, typename Slot>
Button* addButton(QLayout* layout, const char* name, const QString& words, const QString& tip,
                  Receiver* receiver, Slot called) {
  auto* button = addButton<Button>(layout, name, words, tip);
  QObject::connect(button, &Button::clicked, receiver, called);
  return button;
}

QLabel* quietLabel(const QString& words);
// Adds a text that wraps. kind: "quiet", "bad", or empty for the usual colour.
QLabel* addNote(QLayout* layout, const char* name, const char* kind = "quiet");
void say(QLabel* note, const QString& words); // Hides the label if there are no words.

// Gives a list the looks of a page of the bottom panel.
void dressPage(QListWidget* list, const char* name, const QString& tip);
// Adds a list in a frame.
QListWidget* addList(QLayout* layout, const char* name, const QString& tip);
// Replaces the lines, and shows at most five at once. The tooltip of each has all of it.
void fillList(QListWidget* list, const QStringList& lines);

// A page with a text in the middle, and a button (or nullptr) below it.
QWidget* emptyPage(QLabel* words, QPushButton* button = nullptr);

// Facts in two columns.
class FactTable : public QWidget {
 public:
  explicit FactTable(QWidget* parent);
  void row(const QString& caption, const QString& value, const QString& tip = {}, bool bad = false);
  void heading(const QString& words);

 private:
  QGridLayout* grid_;
};

// Folder of the file that was last chosen in a dialog, between sessions; empty: none yet.
QString lastFolder();
void rememberFolder(const QString& path); // path: a file in it
// The dialog begins there, and the folder of what it accepts is remembered.
void beginInLastFolder(QFileDialog& dialog);
// Asks for a file or folder that exists. The window goes on meanwhile.
void askForPath(QWidget* window, const QString& title, QFileDialog::FileMode mode,
                const QString& filter, std::function<void(const QString&)> then);
// Returns a dialog that asks where to save a file. The caller opens it.
QFileDialog* saveDialog(QWidget* window, const QString& title, const QString& filter,
                        const QString& name, std::function<void(const QString&)> then);

} // namespace patina

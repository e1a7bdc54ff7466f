#include "app/gui/loading/load_dialogs.h"

#include <QButtonGroup>
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QMessageBox>
#include <QRadioButton>
#include <QVBoxLayout>

#include "app/gui/toolkit/card.h"
#include "app/gui/toolkit/words.h"
#include "session/edit/reread_object.h"

namespace patina {
namespace {

QDialog* questionAbout(QWidget* parent, const QString& title, const QString& words) {
  auto* dialog = new QDialog(parent);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(title);
  auto* layout = new QVBoxLayout(dialog);
  auto* label = new QLabel(words, dialog);
  label->setWordWrap(true);
  label->setMinimumWidth(380);
  layout->addWidget(label);
  return dialog;
}

// Adds the buttons and opens the dialog.
void ask(QDialog* dialog, QWidget* parent, std::function<void()> accepted) {
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, dialog);
  dialog->layout()->addWidget(buttons);
  QObject::connect(buttons, &QDialogButtonBox::accepted, dialog, &QDialog::accept);
  QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::reject);
  QObject::connect(dialog, &QDialog::accepted, parent, std::move(accepted));
  dialog->open();
}

QMessageBox* warningBox(QWidget* parent, const char* name, const QString& title,
                        const QString& message, QMessageBox::StandardButton button,
                        const QString& advice) {
  auto* box = named(
      new QMessageBox(QMessageBox::Warning, title, withoutCommands(message), button, parent), name);
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setInformativeText(advice);
  box->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return box;
}

} // namespace

void askUnit(QWidget* parent, const QString& name, double longest, UpAxis up,
             std::function<void(MeshUnit, UpAxis)> answer) {
  QDialog* dialog = questionAbout(
      parent, QDialog::tr("Which unit?"),
      QDialog::tr("%1 is %2 units long. Mesh files contain no unit, and in millimetres it would be "
                  "too small or too large for the tool. What is its unit?")
          .arg(name)
          .arg(longest, 0, 'g', 4));
  dialog->setObjectName(QStringLiteral("unit_dialog"));
  auto* group = new QButtonGroup(dialog);
  const std::pair<MeshUnit, QString> choices[] = {
      {MeshUnit::fit, QDialog::tr("Unknown: make the longest side 100 mm")},
      {MeshUnit::m, QDialog::tr("Metres (%1)").arg(inWords(longest))},
      {MeshUnit::cm, QDialog::tr("Centimetres (%1)").arg(inWords(longest / 100))},
      {MeshUnit::mm, QDialog::tr("Millimetres (%1)").arg(inWords(longest / 1000))},
      {MeshUnit::in, QDialog::tr("Inches (%1)").arg(inWords(longest * 0.0254))}};
  for (const auto& [unit, words] : choices) {
    auto* button = new QRadioButton(words, dialog);
    group->addButton(button, static_cast<int>(unit));
    dialog->layout()->addWidget(button);
  }
  group->button(static_cast<int>(likelyUnit(longest)))->setChecked(true);
  auto* y_up = named(new QCheckBox(QDialog::tr("y points upwards, not z"), dialog), "y_is_up");
  y_up->setChecked(up == UpAxis::y);
  dialog->layout()->addWidget(y_up);
  ask(dialog, parent, [group, y_up, answer = std::move(answer)] {
    answer(static_cast<MeshUnit>(group->checkedId()), y_up->isChecked() ? UpAxis::y : UpAxis::z);
  });
}

void askReread(QWidget* parent, const QString& name, double longest,
               std::function<void(MeshUnit, MeshUnit, UpAxis)> answer) {
  QDialog* dialog =
      questionAbout(parent, QDialog::tr("Unit and upper axis"),
                    QDialog::tr("Mesh files contain no unit. %1 is %2 long as it was read.")
                        .arg(name, inWords(longest)));
  dialog->setObjectName(QStringLiteral("reread_dialog"));
  auto* form = new QFormLayout;
  static_cast<QVBoxLayout*>(dialog->layout())->addLayout(form);
  const QString units[] = {QDialog::tr("millimetres"), QDialog::tr("centimetres"),
                           QDialog::tr("metres"),
                           QDialog::tr("inches")}; // the order is that of MeshUnit
  auto* was = named(new QComboBox(dialog), "unit_was");
  auto* now = named(new QComboBox(dialog), "unit_now");
  for (QComboBox* combo : {was, now})
    for (const QString& unit : units) combo->addItem(unit);
  now->addItem(QDialog::tr("unknown: make it 100 mm long"));
  auto* result = named(new QLabel(dialog), "unit_result");
  form->addRow(QDialog::tr("Read as"), was);
  form->addRow(QDialog::tr("It is in"), now);
  form->addRow(QDialog::tr("Longest side"), result);
  auto* y_up = named(new QCheckBox(QDialog::tr("y points upwards, not z"), dialog), "y_is_up");
  dialog->layout()->addWidget(y_up);
  const auto unitOf = [](const QComboBox* combo) {
    return static_cast<MeshUnit>(combo->currentIndex());
  };
  const auto show = [=] {
    const bool fits = unitOf(now) == MeshUnit::fit;
    const double length = fits ? 0.1 : longest * unitRatio(unitOf(was), unitOf(now));
    result->setText(inWords(length) +
                    (isUsualLength(length) ? QString() : QDialog::tr(", which is unlikely")));
  };
  for (QComboBox* combo : {was, now})
    QObject::connect(combo, qOverload<int>(&QComboBox::currentIndexChanged), dialog, show);
  show();
  ask(dialog, parent, [was, now, y_up, unitOf, answer = std::move(answer)] {
    answer(unitOf(was), unitOf(now), y_up->isChecked() ? UpAxis::y : UpAxis::z);
  });
}

void askPicture(QWidget* parent, const QString& name, bool has_coordinates,
                std::function<void(PictureTarget, Projection)> answer) {
  QDialog* dialog = questionAbout(parent, QDialog::tr("Lay a picture"),
                                  QDialog::tr("What does %1 give the object?").arg(name));
  dialog->setObjectName(QStringLiteral("picture_dialog"));
  const auto addChoice = [dialog](const char* words, const QString& label,
                                  const QStringList& choices, int chosen) {
    auto* group = new QButtonGroup(dialog);
    if (!label.isEmpty()) dialog->layout()->addWidget(new QLabel(label, dialog));
    for (int i = 0; i < choices.size(); ++i) {
      if (choices[i].isEmpty()) continue;
      auto* button = new QRadioButton(choices[i], dialog);
      button->setObjectName(QString::fromUtf8(words) + QString::number(i));
      button->setChecked(i == chosen);
      group->addButton(button, i);
      dialog->layout()->addWidget(button);
    }
    return group;
  };
  auto* target = addChoice("picture_target_", {},
                           {QDialog::tr("Colour"), QDialog::tr("Relief: bright is high")}, 0);
  auto* projection =
      addChoice("picture_projection_", QDialog::tr("It is laid"),
                {has_coordinates ? QDialog::tr("by the mesh's own texture coordinates") : QString(),
                 QDialog::tr("along x, onto both sides"), QDialog::tr("along y, onto both sides"),
                 QDialog::tr("along z, onto both sides")},
                has_coordinates ? 0 : 3);
  ask(dialog, parent, [target, projection, answer = std::move(answer)] {
    answer(static_cast<PictureTarget>(target->checkedId()),
           static_cast<Projection>(projection->checkedId()));
  });
}

void askIso(QWidget* parent, const QString& name, double low, double high,
            std::function<void(double)> answer) {
  QDialog* dialog =
      questionAbout(parent, QDialog::tr("Where is the surface?"),
                    QDialog::tr("%1 is a volume with values from %2 to %3. Value at the surface:")
                        .arg(name)
                        .arg(low, 0, 'g', 5)
                        .arg(high, 0, 'g', 5));
  dialog->setObjectName(QStringLiteral("iso_dialog"));
  auto* number = new QDoubleSpinBox(dialog);
  number->setDecimals(6);
  number->setRange(low, high);
  number->setSingleStep((high - low) / 20);
  // The surface of a distance field is at 0; otherwise the mean is a first guess.
  number->setValue(low < 0 && high > 0 ? 0 : 0.5 * (low + high));
  dialog->layout()->addWidget(number);
  ask(dialog, parent, [number, answer = std::move(answer)] { answer(number->value()); });
}

QString adviceFor(const QString& message) {
  if (message.contains(QStringLiteral("no object")))
    return QDialog::tr("Start with a mesh, File → Add object…, and save the workspace.");
  if (message.contains(QStringLiteral("workspace.json: cannot be opened")))
    return QDialog::tr(
        "A workspace folder contains workspace.json; a scan folder contains frames.csv, poses.tum "
        "or path.csv. Open pictures without times by Open pictures… on the desk Scan.");
  if (message.contains(QStringLiteral("no such file")))
    return QDialog::tr("Check the name, or open it with File → Open.");
  if (message.contains(QStringLiteral("extension")) || message.contains(QStringLiteral("format")))
    return QDialog::tr("Patina opens .obj, .ply and .stl meshes, .vti volumes and its own "
                       "workspace folders.");
  if (message.contains(QStringLiteral("memory")) || message.contains(QStringLiteral("grid")))
    return QDialog::tr("Choose a smaller resolution or a smaller band.");
  return QDialog::tr("Repair the file at the reported place, or export it again.");
}

void askRecover(QWidget* parent, const QString& name, const QString& message,
                std::function<void()> yes) {
  auto* box = warningBox(
      parent, "damaged", QDialog::tr("%1 is damaged").arg(name), message, QMessageBox::Cancel,
      QDialog::tr("Patina can open the readable part. It reports what is missing."));
  auto* recover =
      named(box->addButton(QDialog::tr("Recover"), QMessageBox::AcceptRole), "recover_damaged");
  QObject::connect(recover, &QPushButton::clicked, parent, std::move(yes));
  box->open();
}

void showProblem(QWidget* parent, const QString& title, const QString& message,
                 const QString& advice) {
  warningBox(parent, "problem", title, message, QMessageBox::Ok, advice)->open();
}

int askToSave(QWidget* parent, const char* name, const QString& title, const QString& message,
              const QString& advice) {
  QMessageBox box(QMessageBox::Question, title, message,
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, parent);
  box.setObjectName(QString::fromUtf8(name));
  box.setInformativeText(advice);
  return box.exec();
}

} // namespace patina

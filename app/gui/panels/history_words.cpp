#include "app/gui/panels/history_words.h"

#include <algorithm>

#include <QCoreApplication>
#include <QStringList>

#include "app/gui/widgets/words.h"
#include "core/numbers.h"
#include "scene/scene_values.h"
#include "scene/stroke.h"

namespace patina {
namespace {

QString text(std::string_view utf8) {
  return QString::fromUtf8(utf8.data(), static_cast<int>(utf8.size()));
}

// "tip.radius = 0.001" as "tip radius 1 mm".
QString wordsOfValue(const QString& piece) {
  const QString key = piece.section(QStringLiteral(" = "), 0, 0);
  const QString value = piece.section(QStringLiteral(" = "), 1);
  if (key == QStringLiteral("friction.slip"))
    return value == QStringLiteral("paper") ? tr("slips towards the tip")
                                            : tr("slips against its motion");
  const auto number = parseNumber(value.toStdString());
  if (!number) return wordsOfKeys(key) + ' ' + value;
  const std::string_view unit = sceneKey(key.toStdString()).unit;
  if (unit == "m") return wordsOfKeys(key) + ' ' + text(formatLength(*number));
  return (wordsOfKeys(key) + ' ' + QString::number(*number, 'g', 4) + ' ' + text(unit)).trimmed();
}

// What goes with all its keys is named once: "no friction".
QString wordsOfValues(const QStringList& pieces) {
  const QString none = QStringLiteral(" = none");
  QStringList words;
  for (const QString& piece : pieces) {
    const QString whole = piece.section('.', 0, 0);
    const bool gone = piece.endsWith(none);
    const bool family = pieces.filter(QRegExp("^" + whole + "[. ]")).filter(none).size() > 1;
    words << (gone ? tr("no %1").arg(wordsOfKeys(family ? QString(whole).remove(none)
                                                        : QString(piece).remove(none)))
                   : wordsOfValue(piece));
  }
  words.removeDuplicates();
  return words.join(QStringLiteral(", "));
}

bool isStroke(const QString& edit) {
  const QString first = edit.section(QRegExp("[ ,]"), 0, 0);
  return std::any_of(kTools.begin(), kTools.end(),
                     [&](const Tool& tool) { return text(name(tool)) == first; });
}

} // namespace

QString wordsOfKeys(QString words) {
  for (const Channel& row : kChannels) words.replace(text(name(row.channel)), text(row.caption));
  return words.replace(QRegExp(QStringLiteral("[._](?=[a-z])")), QStringLiteral(" "));
}

QString wordsOfEdit(const std::string& edit) {
  QString words = text(edit);
  if (words.contains(QStringLiteral(" = "))) {
    words = wordsOfValues(words.split(QStringLiteral(", ")));
  } else if (words.startsWith(text(name(Tool::erase)))) {
    words.replace(0, 5, tr("erased"));
  } else if (isStroke(words)) {
    words = tr("painted %1").arg(wordsOfKeys(words).replace(QStringLiteral("color"), tr("colour")));
  }
  words = withMicro(words);
  return words.left(1).toUpper() + words.mid(1);
}

} // namespace patina

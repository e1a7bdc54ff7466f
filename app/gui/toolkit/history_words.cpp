#include "app/gui/toolkit/history_words.h"

#include <algorithm>

#include <QCoreApplication>
#include <QStringList>

#include "app/gui/toolkit/words.h"
#include "core/numbers.h"
#include "scene/pin.h"
#include "scene/scene_values.h"
#include "scene/slice_position.h"
#include "scene/stroke.h"

namespace patina {
namespace {

// Converts "tip.radius = 0.001" to "tip radius 1 mm".
QString wordsOfValue(const QString& piece) {
  const QString key = piece.section(QStringLiteral(" = "), 0, 0);
  const QString value = piece.section(QStringLiteral(" = "), 1);
  if (key == QStringLiteral("friction.slip"))
    return value == QStringLiteral("paper") ? tr("friction towards the tip")
                                            : tr("friction against the motion");
  if (key == QStringLiteral("pins")) {
    QStringList names;
    for (const Pin& pin : parsePins(value.toStdString())) names << shownText(pin.name);
    return tr("pins %1").arg(names.join(QStringLiteral(" ")));
  }
  if (key.startsWith(QStringLiteral("slice"))) {
    const SlicePosition slice = parseSlice(value.toStdString());
    const QString name = QString(key).replace(QStringLiteral("slice"), tr("slice ")).trimmed();
    const QString across = tr("%1 normal to %2").arg(name, shownText(directionText(slice.normal)));
    return !slice.position ? across
                           : tr("%1 at %2").arg(across, shownText(formatLength(*slice.position)));
  }
  const auto number = parseNumber(value.toStdString());
  if (!number) return wordsOfKeys(key) + ' ' + value;
  const std::string_view unit = sceneKey(key.toStdString()).unit;
  if (unit == "m") return wordsOfKeys(key) + ' ' + shownText(formatLength(*number));
  return (wordsOfKeys(key) + ' ' + QString::number(*number, 'g', 4) + ' ' + shownText(unit))
      .trimmed();
}

// A group whose keys are all removed is named once: "no friction".
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
                     [&](const Tool& tool) { return shownText(name(tool)) == first; });
}

} // namespace

QString wordsOfKeys(QString words) {
  for (const Channel& row : kChannels)
    words.replace(shownText(name(row.channel)), shownText(row.caption));
  return words.replace(QRegExp(QStringLiteral("[._](?=[a-z])")), QStringLiteral(" "));
}

QString wordsOfEdit(const std::string& edit) {
  QString words = shownText(edit);
  if (words.contains(QStringLiteral(" = "))) {
    words = wordsOfValues(words.split(QStringLiteral(", ")));
  } else if (words.startsWith(shownText(name(Tool::erase)))) {
    words.replace(0, 5, tr("erased"));
  } else if (isStroke(words)) {
    words = tr("painted %1").arg(wordsOfKeys(words).replace(QStringLiteral("color"), tr("colour")));
  }
  words = withMicro(words);
  return words.left(1).toUpper() + words.mid(1);
}

} // namespace patina

#include "app/gui/panels/history_words.h"

#include <algorithm>

#include <QCoreApplication>
#include <QStringList>

#include "core/numbers.h"
#include "scene/scene_values.h"
#include "scene/stroke.h"

namespace patina {
namespace {

QString tr(const char* words) {
  return QCoreApplication::translate("HistoryPanel", words);
}

QString text(std::string_view utf8) {
  return QString::fromUtf8(utf8.data(), static_cast<int>(utf8.size()));
}

// "tip.radius = 0.001" as "tip radius 1 mm".
QString wordsOfValue(const QString& piece) {
  const int sign = piece.indexOf(QStringLiteral(" = "));
  const QString key = piece.left(sign), value = piece.mid(sign + 3);
  const QString caption = QString(key).replace('.', ' ').replace('_', ' ');
  const auto number = parseNumber(value.toStdString());
  if (!number) return caption + ' ' + value;
  const std::string_view unit = sceneKey(key.toStdString()).unit;
  if (unit == "m")
    return caption + ' ' +
           text(formatLength(*number)).replace(QStringLiteral("um"), QStringLiteral("µm"));
  return (caption + ' ' + QString::number(*number, 'g', 4) + ' ' + text(unit)).trimmed();
}

bool isStroke(const QString& edit) {
  const QString first = edit.section(QRegExp("[ ,]"), 0, 0);
  return std::any_of(kTools.begin(), kTools.end(),
                     [&](const Tool& tool) { return text(name(tool)) == first; });
}

} // namespace

QString wordsOfEdit(const std::string& edit) {
  QString words = text(edit);
  if (words.contains(QStringLiteral(" = "))) {
    QStringList pieces = words.split(QStringLiteral(", "));
    for (QString& piece : pieces) piece = wordsOfValue(piece);
    words = pieces.join(QStringLiteral(", "));
  } else if (words.startsWith(text(name(Tool::erase)))) {
    words.replace(0, 5, tr("erased"));
  } else if (isStroke(words)) {
    words = tr("painted %1")
                .arg(words.replace(QStringLiteral("color"), tr("colour"))
                         .replace(QStringLiteral(" um"), QStringLiteral(" µm")));
  }
  return words.left(1).toUpper() + words.mid(1);
}

} // namespace patina

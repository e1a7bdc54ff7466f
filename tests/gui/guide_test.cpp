// The user guide matches the window: keys, captions and pictures are compared.
#include <fstream>
#include <regex>
#include <sstream>

#include <QAction>
#include <QCheckBox>
#include <QGroupBox>

#include "geometry/mesh/shapes.h"
#include "gui/window_fixture.h"
#include "support/places.h"

namespace patina {
namespace {

std::filesystem::path docs() {
  return test::sourceFolder() / "docs";
}

std::string guide(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(docs() / name).rdbuf();
  return text.str();
}

TEST(Guide, PicturesExistAndAreSmall) {
  for (const char* name : {"user_guide.md", "tutorial.md"}) {
    const std::string text = guide(name);
    ASSERT_FALSE(text.empty()) << name;
    const std::regex picture("\\]\\((images/[a-z_]+\\.png)\\)");
    int count = 0;
    for (std::sregex_iterator it(text.begin(), text.end(), picture), end; it != end;
         ++it, ++count) {
      const auto path = docs() / (*it)[1].str();
      ASSERT_TRUE(std::filesystem::exists(path)) << path;
      EXPECT_LT(std::filesystem::file_size(path), 300000U) << path;
    }
    EXPECT_GE(count, 3) << name;
  }
}

class GuideOfTheWindow : public WindowTest {};

TEST_F(GuideOfTheWindow, NamesEveryKeyOfTheMenus) {
  const QString text = QString::fromStdString(guide("user_guide.md"));
  int keys = 0;
  for (const QAction* action : window_->findChildren<QAction*>()) {
    const QString key = action->shortcut().toString();
    if (key.size() != 1 || key[0].isDigit()) continue;
    ++keys;
    EXPECT_TRUE(text.contains(QRegExp(QStringLiteral("[| ]%1[ ,|]").arg(QRegExp::escape(key)))))
        << key.toStdString() << " (" << action->text().toStdString() << ")";
  }
  EXPECT_GE(keys, 9);
}

TEST_F(GuideOfTheWindow, NamesEveryPanelAndEveryLayer) {
  const QString text = QString::fromStdString(guide("user_guide.md")).toLower();
  for (const QGroupBox* card : window_->findChildren<QGroupBox*>())
    EXPECT_TRUE(text.contains(card->title().toLower())) << card->title().toStdString();
  auto* list = find<QListWidget>("layers");
  for (int i = 0; i < list->count(); ++i)
    EXPECT_TRUE(text.contains(list->item(i)->text().toLower()))
        << list->item(i)->text().toStdString();
  for (const QCheckBox* box : window_->findChildren<QCheckBox*>()) {
    const QString word = box->text().toLower().split(' ').front();
    EXPECT_TRUE(text.contains(word)) << box->text().toStdString();
  }
}

} // namespace
} // namespace patina

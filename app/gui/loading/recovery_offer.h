// What crashes have left behind, offered one after another.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/gui/loading/recover_bar.h"

namespace patina {

class RecoveryOffer : public QObject {
  Q_OBJECT
 public:
  RecoveryOffer(RecoverBar& bar, QObject* parent);
  void begin(); // looks for them
  std::optional<std::filesystem::path> present() const;

 signals:
  void changed();
  void taken(const std::filesystem::path& place); // see autosave.h

 private:
  void next();

  std::vector<std::filesystem::path> places_; // what is offered comes first
};

} // namespace patina

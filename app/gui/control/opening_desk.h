// Which desk is up while something is opened: one that shows it, from when it is seen, and the one
// from which it was asked for where it comes to nothing.
#pragma once

#include <functional>
#include <optional>

#include <QObject>

#include "app/gui/control/desk_controller.h"
#include "app/gui/control/document_controller.h"

namespace patina {

class OpeningDesk : public QObject {
 public:
  // is_seen: on the desk that is up.
  OpeningDesk(DocumentController& documents, DeskController& desks, std::function<bool()> is_seen,
              QObject* parent);

 private:
  void begin();
  void come();
  void goBack();
  void end();

  DeskController& desks_;
  std::function<bool()> is_seen_;
  std::optional<Desk> from_; // where it was asked for; nullopt: nothing is being opened
  bool came_ = false;        // to Feel, for what is being opened
};

} // namespace patina

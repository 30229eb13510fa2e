#pragma once

#include <string>
#include <utility>

#include <QObject>
#include <QString>

namespace lumorph::studio {

/// State of the watch of the running show, as the status line shows it. A plain value; empty words: no watch is on.
struct WatchStand {
    enum class How { unsure, good, alarm };
    QString words;
    std::string sentence; ///< more about it
    How how = How::unsure;
    bool operator==(const WatchStand&) const = default;
};

/// Publishes the state of the watch to the status line. Lives in the window's thread.
class WatchBoard : public QObject {
    Q_OBJECT
public:
    [[nodiscard]] const WatchStand& stand() const noexcept { return stand_; }
    void set(WatchStand stand) {
        if (stand == stand_) return;
        stand_ = std::move(stand);
        emit changed();
    }

signals:
    void changed();
    void checkWanted(); ///< the user has clicked the state: a check of the room is to be opened

private:
    WatchStand stand_;
};

} // namespace lumorph::studio

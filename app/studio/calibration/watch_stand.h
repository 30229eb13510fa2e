#pragma once

#include <string>
#include <utility>

#include <QObject>
#include <QString>

namespace lumorph::studio {

/// What the watch of the running show says, in few words. A plain value; without words nobody watches.
struct WatchStand {
    enum class How { unsure, good, alarm };
    QString words;
    std::string sentence; ///< more about it
    How how = How::unsure;
    bool operator==(const WatchStand&) const = default;
};

/// Where the watch says it, for all windows. Lives in the window's thread.
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
    void checkWanted(); ///< of the room, by whoever has read it

private:
    WatchStand stand_;
};

} // namespace lumorph::studio

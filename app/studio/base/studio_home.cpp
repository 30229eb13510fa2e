#include "app/studio/base/studio_home.h"

#include <chrono>

namespace lumorph::studio {

namespace {

constexpr std::chrono::seconds kPatience{1}; // for a program that was killed and is still ending
constexpr std::chrono::milliseconds kAskAgain{500};

} // namespace

StudioHome::StudioHome(Settings& settings) : settings_(settings), lock_(settings.folder() / "lock") {
    if (lock_.tryLockFor(kPatience)) return;
    settings_.setReadOnly(true);
    connect(&again_, &QTimer::timeout, this, [this] {
        if (!lock_.tryLock()) return;
        again_.stop();
        settings_.setReadOnly(false);
        emit tookOver();
    });
    again_.start(kAskAgain);
}

std::optional<QDateTime> StudioHome::otherSince() const { return first() ? std::nullopt : lock_.since(); }

} // namespace lumorph::studio

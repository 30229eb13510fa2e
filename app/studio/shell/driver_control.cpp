#include "app/studio/shell/driver_control.h"

#include <array>
#include <utility>

#include "core/scene/driver.h"

namespace lumorph::studio {

namespace {

struct DriverWords {
    const char* kind;
    const char* icon;
    const char* step; ///< of undo, where the document says who drives
};

/// In the order of the enum.
constexpr std::array<DriverWords, 6> kWords = {{{"Target", "target", "Follow the target"},
                                                {"Scene item", "scene", "Follow the scene"},
                                                {"Hand", "hand", "Move by hand"},
                                                {"Dance", "dance", ""},
                                                {"Recording", "replay", ""},
                                                {"Show program", "live", ""}}};

const DriverWords& wordsOf(Driver driver) { return kWords.at(static_cast<std::size_t>(driver)); }

} // namespace

DriverControl::DriverControl(StudioDocument& document, StudioLoop& loop, ReplayService& replay)
    : document_(document), loop_(loop), replay_(replay), hand_(document, loop), now_(loop.driver()) {
    connect(&document, &StudioDocument::changed, this, &DriverControl::onDocument);
    connect(&loop, &StudioLoop::driverChanged, this, &DriverControl::compare);
    connect(&loop, &StudioLoop::stoppedChanged, this, &DriverControl::changed);
    connect(&replay, &ReplayService::changed, this, &DriverControl::compare);
    connect(&replay, &ReplayService::drivesServosChanged, this, &DriverControl::changed);
}

void DriverControl::onDocument(StateParts parts) {
    if (parts & StatePart::rig) { // opened: nobody took over
        now_ = loop_.driver();
        before_.reset();
    }
    compare();
}

void DriverControl::compare() {
    const Driver driver = loop_.driver();
    const Driver was = std::exchange(now_, driver);
    if (was != driver) before_ = was;
    emit changed();
    if (was != driver) emit tookOver();
}

void DriverControl::choose(Driver driver) {
    if (driver == this->driver() || !whyNot(driver).isEmpty()) return;
    const std::vector<double> strokes = hand_.strokes();
    give(driver, driver == Driver::hand ? &strokes : nullptr);
}

void DriverControl::back() {
    if (const auto driver = before()) give(*driver, nullptr);
}

void DriverControl::give(Driver driver, const std::vector<double>* strokes) {
    if (driver == Driver::dance) {
        replay_.suspend();
        return loop_.setDancing(true);
    }
    if (driver == Driver::recording) return replay_.resume();
    endMoment();
    if (driver == Driver::program) return loop_.setProgramDrives(true);
    document_.change(wordsOf(driver).step, [&](StudioState& state) {
        state.matching.driver = driver;
        if (strokes) state.strokes = *strokes;
    });
}

void DriverControl::endMoment() {
    replay_.suspend();
    loop_.setDancing(false);
    loop_.setProgramDrives(false);
}

QString DriverControl::whyNot(Driver driver) const {
    const StudioState& state = document_.state();
    if (!state.rig.rig) return tr("There is no device: open a rig first.");
    switch (driver) {
    case Driver::target:
        return state.target.target ? QString() : tr("There is no target: open one in the Field workspace.");
    case Driver::sceneItem: {
        if (state.scene && followableItem(*state.scene)) return {};
        const SceneItem* item = state.scene ? drivingItem(*state.scene) : nullptr;
        if (!item) return tr("No item of the scene is physical: choose one in the Scene workspace, and its role.");
        const QString name = QString::fromStdString(item->name);
        return isShown(*state.scene, *item) ? tr("'%1' stands for the target: choose the target.").arg(name)
                                            : tr("'%1' is hidden: show it in the Scene workspace.").arg(name);
    }
    case Driver::recording:
        return replay_.recording() || replay_.suspended() ? QString()
                                                          : tr("None is open: File, Open recording shows one.");
    case Driver::program:
        return loop_.program() ? QString() : tr("None shows: an application brings one.");
    case Driver::hand:
    case Driver::dance:
        break;
    }
    return {};
}

QString DriverControl::whyStill() const {
    if (loop_.stopped()) return tr("After STOP nothing moves until you resume.");
    const StudioState& state = document_.state();
    if (driver() == Driver::recording)
        return replay_.drivesServos() ? QString()
                                      : tr("The recording '%1' is only shown: servos of a device hold until it drives "
                                           "them, too.")
                                            .arg(nameOf(Driver::recording));
    if (state.scene && state.scene->showing == Showing::virtualOnly)
        return tr("The scene shows light alone, so the servos rest.");
    if (driver() == Driver::target && state.target.target && !state.field.field)
        return tr("There is no field yet, so the target is not matched: build it in the Field workspace.");
    return whyNot(driver());
}

QString DriverControl::nameOf(Driver driver) const {
    const StudioState& state = document_.state();
    switch (driver) {
    case Driver::target:
        return state.target.target ? QString::fromStdString(state.target.target->name) : tr("no target");
    case Driver::sceneItem: {
        const SceneItem* item = state.scene ? followableItem(*state.scene) : nullptr;
        return item ? QString::fromStdString(item->name) : tr("no scene item");
    }
    case Driver::hand:
        return tr("your hand");
    case Driver::dance:
        return tr("dance");
    case Driver::recording:
        return QString::fromStdString(replay_.file().stem().string());
    case Driver::program:
        break;
    }
    return tr("show program");
}

QString DriverControl::kindOf(Driver driver) { return tr(wordsOf(driver).kind); }
QString DriverControl::iconOf(Driver driver) { return wordsOf(driver).icon; }

std::optional<Driver> DriverControl::before() const {
    return before_ && *before_ != driver() && whyNot(*before_).isEmpty() ? before_ : std::nullopt;
}

} // namespace lumorph::studio

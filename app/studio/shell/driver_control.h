#pragma once

#include <optional>

#include <QObject>
#include <QString>

#include "app/studio/document/hand_control.h"
#include "app/studio/document/studio_document.h"
#include "app/studio/document/studio_loop.h"
#include "app/studio/recording/replay_service.h"

namespace lumorph::studio {

/// The one place that says and sets who moves the servos, whoever changed it: the document, a dance, a program or a
/// recording. Lives in the window's thread.
class DriverControl : public QObject {
    Q_OBJECT
public:
    DriverControl(StudioDocument& document, StudioLoop& loop, ReplayService& replay);

    [[nodiscard]] Driver driver() const noexcept { return loop_.driver(); }
    /// Another driver takes over; where the document says who drives, as one step of undo. By hand the actuators stay
    /// where they are. Nothing happens where `whyNot` has a reason.
    void choose(Driver driver);
    /// Why somebody cannot drive now, and what to do about it, as one sentence; empty where he can.
    [[nodiscard]] QString whyNot(Driver driver) const;
    /// Why the present driver moves nothing, as one sentence: STOP was pressed, light works alone, or he has nothing to
    /// follow; empty while he moves the servos.
    [[nodiscard]] QString whyStill() const;

    /// What somebody is called who drives: "dunes", "Sea", "your hand".
    [[nodiscard]] QString nameOf(Driver driver) const;
    /// Of what kind he is: "Target", "Scene item", "Hand", "Dance", "Recording", "Show program".
    [[nodiscard]] static QString kindOf(Driver driver);
    /// Name of the icon of that kind.
    [[nodiscard]] static QString iconOf(Driver driver);

    /// Who drove before the last change, while he could take over again.
    [[nodiscard]] std::optional<Driver> before() const;
    /// He takes over again, as he was left.
    void back();

signals:
    /// Another driver, or what he is called, or whether he moves anything.
    void changed();
    /// Somebody else drives than a moment ago. Not when a rig or a project is opened.
    void tookOver();

private:
    void onDocument(StateParts parts);
    void compare();
    /// `next` is of the document: what moves the servos for the moment lets go of them.
    void endMoment();
    void give(Driver driver, const std::vector<double>* strokes);

    StudioDocument& document_;
    StudioLoop& loop_;
    ReplayService& replay_;
    HandControl hand_;
    Driver now_;
    std::optional<Driver> before_;
};

} // namespace lumorph::studio

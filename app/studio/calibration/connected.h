#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <QString>

#include "app/studio/base/step_tone.h"
#include "app/studio/devices/tracker_service.h"
#include "core/scene/installation.h"
#include "devices/controllers/servo_link_status.h"
#include "devices/trackers/tracker.h"

/// What is connected, how good it is, and what is missing, in the words of the window.
namespace lumorph::studio {

/// What the services know of projectors, camera, trackers, rig and servos at one moment.
struct ConnectedFacts {
    /// Where the picture of a projector is shown.
    struct Output {
        bool isShown = false;
        QString screen;  ///< that its window covers; empty: it is an ordinary window
        QString problem; ///< why it is not shown pixel by pixel, as ProjectorWindow::calibrationProblem
    };
    Installation room;
    std::vector<Output> outputs; ///< one for each projector of the room; one that is left out is not shown
    bool isCameraPresent = true; ///< false: the system has no device at the address of the room's first camera
    std::vector<TrackerStatus> trackers;
    std::vector<SeenBody> bodies;
    std::optional<QString> rig; ///< its name; empty: none is open
    std::size_t servos = 0;     ///< of the rig
    LinkStatus link;            ///< to the controller of the servos
    QString controller;         ///< its name
    bool isControllerSimulated = false;
};

/// One row of the list.
struct ConnectedPart {
    enum class State {
        ready,
        missing,
        needsYou, ///< it is connected, but cannot be used as it is
        lab       ///< the virtual lab has one in its place
    };
    /// Where it is set up.
    enum class Place { setup, devices, scene, rig };
    QString kind; ///< of names of widgets: "projector1", "camera"
    State state = State::missing;
    QString title, text; ///< "Tracker", and how it is, with what to do unless it is ready
    Place place = Place::devices;
    bool isSimulated = false;
    bool operator==(const ConnectedPart&) const = default;
};

/// A part for each enabled projector, then camera, tracker, device and servos. Cameras are not opened for it.
[[nodiscard]] std::vector<ConnectedPart> connectedParts(const ConnectedFacts& facts);

/// "Needs you", as a badge says it.
[[nodiscard]] QString wordOf(ConnectedPart::State state);
/// Of the button that leads there.
[[nodiscard]] QString buttonOf(ConnectedPart::Place place);

/// What is to be done next: about the first part that is missing or needs the user, or about nothing.
struct ConnectedSummary {
    StepTone tone = StepTone::quiet;
    QString title, text, button;
    std::optional<ConnectedPart::Place> place; ///< to which the button leads; empty: to the chain
};
[[nodiscard]] ConnectedSummary connectedSummary(const std::vector<ConnectedPart>& parts);

} // namespace lumorph::studio

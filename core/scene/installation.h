#pragma once

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/geometry/calibrated_camera.h"

namespace lumorph {

/// Where a figure of an installation came from, and when.
struct Origin {
    enum class Way {
        assumed,   ///< not known yet: that of the virtual lab
        entered,   ///< typed or dragged by hand
        measured,  ///< by a calibration in the room
        simulated, ///< by a calibration in the virtual lab, or of simulated devices
        recorded   ///< by a calibration from what was recorded in the room before
    };
    Way way = Way::assumed;
    std::string method; ///< of a measurement, in a few words: "structured light, 12 boards"
    std::string date;   ///< ISO 8601 in UTC, such as "2026-11-24T17:05:00Z"; empty for what is assumed
    bool operator==(const Origin&) const = default;
    /// By a calibration, wherever it was made.
    [[nodiscard]] bool isCalibrated() const noexcept {
        return way == Way::measured || way == Way::simulated || way == Way::recorded;
    }
};

/// How sharp a projector's lens is at which distance. As a thin lens has it, a point of its picture is on a surface
/// across its axis, `distance` away, a disk of `aperture` * |distance / focusDistance - 1| metres.
struct LensFocus {
    double aperture = 0.0;      ///< metres across, focal length / f-number; 0: not known
    double focusDistance = 2.0; ///< metres along the axis
    bool operator==(const LensFocus&) const = default;
};

/// A projector and what is known of its light. Full white on a white diffuse surface that it meets head on at
/// `referenceDistance` has the radiance `peak`, where 1 is white in the eye pass; so `peak` is the headroom for
/// slanting and distant places.
struct InstalledProjector {
    std::string name = "Projector";
    bool enabled = true;
    CalibratedCamera camera;
    LensFocus focus;
    double referenceDistance = 2.0; ///< metres
    double peak = 3.0;
    glm::vec3 gain{1.0F};  ///< relative response of red, green, blue; 1 until measured
    glm::vec3 black{0.0F}; ///< light of each channel at value 0, where its white is 1
    double gamma = 0.0;    ///< light = value^gamma; 0: sRGB
    /// How much light a value makes, where that was measured.
    struct ResponsePoint {
        double value = 0.0;    ///< in [0, 1], of all channels
        glm::vec3 light{0.0F}; ///< of each channel above its black, 1 at value 1
        bool operator==(const ResponsePoint&) const = default;
    };
    std::vector<ResponsePoint> responseCurve; ///< by rising values from 0 to 1; empty: `gamma` says it
    Origin lens, pose, response;
    bool operator==(const InstalledProjector&) const = default;
};

/// A camera that looks at device and table.
struct InstalledCamera {
    std::string name = "Camera";
    std::string address; ///< how it is opened, such as "camera0"; empty: the virtual lab's
    CalibratedCamera camera;
    Origin lens, pose;
    bool operator==(const InstalledCamera&) const = default;
};

/// Where an actuator truly is for what it is told, as a camera saw it. Gears have play: on the way up it stands
/// elsewhere than on the way down.
struct MeasuredServo {
    std::string actuator; ///< its name in the rig
    /// Strokes, as in Actuator: 0 is rest, 1 the end of the range of the rig.
    struct Point {
        double commanded = 0.0;
        double rising = 0.0, falling = 0.0; ///< where it really is when it came from below, and from above
        bool operator==(const Point&) const = default;
    };
    std::vector<Point> points; ///< by rising `commanded`, from 0 to 1
    double lagSeconds = 0.0;   ///< from a command to its motion
    bool operator==(const MeasuredServo&) const = default;
};

/// Whom the show follows when several heads are tracked.
enum class ViewerChoice { automatic, first, nearest, none };

/// What stands in the room, whatever is shown there: a plain value. It belongs to the machine and the room around it;
/// a scene (scene.h) is what is shown in it. Calibration writes it, everything reads it.
struct Installation {
    std::vector<InstalledProjector> projectors;
    std::vector<InstalledCamera> cameras;
    glm::vec2 tableSize{1.2F, 0.9F}; ///< metres in x and z; the table is the world's plane y = 0 around the origin
    glm::mat4 worldFromDevice{1.0F}; ///< where the device lies while no tracker says so
    glm::vec3 deviceColor{1.0F};     ///< of the bare device, on which light falls, sRGB in [0, 1]; white until measured
    glm::vec3 tableColor{1.0F};      ///< of the bare table, as the device's
    glm::vec3 eye{0.0F, 0.45F, 0.55F}; ///< simulated viewer, world metres: followed while nobody is tracked
    glm::vec3 eyeFromHead{0.0F};       ///< the eye in the frame of a tracked head's body, metres
    glm::vec3 pointerTip{0.0F};        ///< of a tracked pointer or hand, in the frame of its body, metres
    glm::mat4 worldFromTracker{1.0F};  ///< rigid: the world of the trackers in the room's
    glm::mat4 bodyFromDevice{1.0F};    ///< rigid: the device in the frame of its tracked body
    std::vector<MeasuredServo> servos; ///< those of the device that were measured; the others do what they are told
    ViewerChoice viewer = ViewerChoice::automatic;
    bool compensation = true; ///< of incidence and distance
    double predictionSeconds =
        0.06;                    ///< from a pose to its light, by which poses are extrapolated at least; 0: not at all
    double trackerSeconds = 0.0; ///< by which poses are older when they arrive than their trackers know
    /// Of what is not a projector's or a camera's own.
    struct Origins {
        Origin table, devicePlace, colors, eyeOffset, delays, tracker, deviceBody, pointer, servos;
        bool operator==(const Origins&) const = default;
    } origins;
    bool operator==(const Installation&) const = default;
};

/// The virtual lab: one calibrated projector about 2 m above the table. Room for all its numbers is in
/// `scene_defaults.cpp`.
[[nodiscard]] Installation defaultInstallation();

/// Throws InvalidInput naming the part and the value: numbers that are not finite or out of range, more than 16
/// projectors or cameras.
void checkInstallation(const Installation& installation);

/// The figures alone, by which two rooms are compared: without origins, and without the simulated eye, which is where
/// one last looked from.
[[nodiscard]] Installation figuresOf(Installation installation);
[[nodiscard]] bool isSameRoom(const Installation& a, const Installation& b);

/// Gives each part of `edited` whose figures differ from those of `before` this origin, unless the edit brought one.
void markOrigins(const Installation& before, Installation& edited, const Origin& origin);

/// What the virtual lab made of `before`: of all that it measured, the origin becomes `simulated`.
void markSimulated(const Installation& before, Installation& made);

/// What was solved of a recording that somebody made before: of all that it measured, the origin becomes `recorded`,
/// with the recording's date and who made it.
void markRecorded(const Installation& before, Installation& made, const std::string& who, const std::string& date);

/// The parts of a room that were measured or entered, in words: "lens of Projector", "delays".
[[nodiscard]] std::vector<std::string> realParts(const Installation& room);

/// Now, as an Origin's date.
[[nodiscard]] std::string utcDate();

} // namespace lumorph

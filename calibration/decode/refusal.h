#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace lumorph {

/// Why a capture is refused or doubted. `--json` and the studio name it by the key in quotes.
enum class Cause {
    missingImage,       ///< "missing_image": a pose has fewer images than the patterns
    doubledImage,       ///< "doubled_image": an image is there twice, or there are too many
    lateFrame,          ///< "late_frame": from some image on, each shows the pattern before
    wrongOrder,         ///< "wrong_order": images show other patterns than the order says
    unreadableImage,    ///< "unreadable_image": broken, no picture, or of an absurd size
    imageSize,          ///< "image_size": images of different sizes
    blackWhiteSwapped,  ///< "black_white_swapped": the image called white is the dark one
    inverseSwapped,     ///< "inverse_swapped": patterns and inverses are exchanged
    mirrored,           ///< "mirrored": the camera's or the projector's picture is a mirror image
    rigMoved,           ///< "rig_moved": camera, board or projector moved within a pose
    projectorSize,      ///< "projector_size": the projector has another size than was said
    widthHeightSwapped, ///< "width_height_swapped": the projector's width and height are exchanged
    frontalViews,       ///< "frontal_views": the board was tilted too little to tell focal lengths
    tooFewViews,        ///< "too_few_views"
    clipped,            ///< "clipped": the board is overexposed
    underexposed,       ///< "underexposed": light and dark hardly differ
    exposureDrifts,     ///< "exposure_drifts": the camera's exposure or the lamp changes within a pose
    boardNotFound,      ///< "board_not_found"
    boardUnlit,         ///< "board_unlit": the projector's patterns cannot be read on the board
    tooFewPoints,       ///< "too_few_points": fewer known points than the unknown needs
    pointsDegenerate,   ///< "points_degenerate": all known points on a line or in a plane
    pointSuspicious,    ///< "point_suspicious": a point that the others contradict
    disconnected,       ///< "disconnected": devices that share no view, by which they could be put into one world
    mirrorUnknown,      ///< "mirror_unknown": nothing tells where the mirror stands
    modelDoesNotFit,    ///< "model_does_not_fit": no model explains what was seen
    undetermined,       ///< "undetermined": a parameter that the data cannot tell was locked
    keystone,           ///< "keystone": the projector warps or scales its picture
    boardWarped,        ///< "board_warped": the board is not flat
    squareSize,         ///< "square_size": the board's squares are not as said; not square
    strangeLens,        ///< "strange_lens": a lens bends light as no pinhole with distortion does
    projectorGamma,     ///< "projector_gamma": the projector's gamma bends the phases
    cameraRefocused,    ///< "camera_refocused": the camera's focal length changed between poses
    wrongUnits,         ///< "wrong_units": metres and something else
    doubledRows,        ///< "doubled_rows": a recording repeats itself
    clockJumps,         ///< "clock_jumps": a clock goes back, or jumps within a recording
    clocksUnknown,      ///< "clocks_unknown": nothing tells how two clocks differ
    motionDegenerate,   ///< "motion_degenerate": a motion is missing without which something stays open
    bodySwapped,        ///< "body_swapped": a tracked body is elsewhere for a while
    tipSlipped,         ///< "tip_slipped": a pointer's tip left its dimple
    tipWrong,           ///< "tip_wrong": the pointer's tip is elsewhere than was said
    trackerLost,        ///< "tracker_lost": the tracker saw a body no more while it was recorded
    notANumber,         ///< "not_a_number": a recording holds numbers that are none
    freshPointsFar,     ///< "fresh_points_far": points that a fit never saw contradict it
    servoDead,          ///< "servo_dead": a servo does not move
    servoSwapped,       ///< "servo_swapped": a servo moves the part of another
    servoReversed,      ///< "servo_reversed": a servo runs from the end of its range
    servoJammed,        ///< "servo_jammed": a servo stops before its range ends
    cameraSlow,         ///< "camera_slow": a camera gives too few pictures a second for what is timed by it
    flashNotSeen,       ///< "flash_not_seen": the camera's pictures do not follow the projector's light
    nothingMoves,       ///< "nothing_moves": what should be moved rests
    motionPeriodic,     ///< "motion_periodic": a motion repeats itself, so that several delays fit
    cameraSaturates,    ///< "camera_saturates": white is cut off at any exposure
    lightTooDark,       ///< "light_too_dark": projected light hardly shows
    ambientChanges,     ///< "ambient_changes": the light of the room changed meanwhile
    cameraAdjusts,      ///< "camera_adjusts": a camera sets its exposure by itself
    responseNotRising,  ///< "response_not_rising": a projector makes less light of a higher value
    surfaceUnseen,      ///< "surface_unseen": a camera sees too little of what is lit
    cameraMoved,        ///< "camera_moved": camera or projector moved between poses
    repeatedPoses,      ///< "repeated_poses": the same view twice, which checks nothing
    passedOver,         ///< "passed_over": a file beside the capture that is none of it
    noisy,              ///< "noisy": the camera's noise hides the patterns
    bitOrder,           ///< "bit_order": Gray code patterns in another order than said
    periodCount,        ///< "period_count": stripes have another number of periods than said
    phaseOrder,         ///< "phase_order": phase steps are exchanged
    outOfFocus,         ///< "out_of_focus": camera or projector is not in focus
    boardSize,          ///< "board_size": the board has another number of corners than said
    boardKind,          ///< "board_kind": another kind of board, or another dictionary, than said
    handInView,         ///< "hand_in_view": something covers a part of the board in some images
    foreignImage,       ///< "foreign_image": an image of another pose
    unlikelyLength,     ///< "unlikely_length": a length that no room has
    quaternionOrder,    ///< "quaternion_order": one recording has its quaternion's w first
    inverted,           ///< "inverted": one recording has the world in the body's frame
    timeUnit,           ///< "time_unit": times in milliseconds, microseconds, nanoseconds or frames
    turnsInPlace,       ///< "turns_in_place": a body turned about its own origin
    rowsOutOfOrder,     ///< "rows_out_of_order": rows of a recording stand in another order than their times
    lensModel,          ///< "lens_model": a lens model that cannot be used, or is not named
};

/// All of them, in the order above.
inline constexpr int kCauseCount = static_cast<int>(Cause::lensModel) + 1;

[[nodiscard]] std::string_view keyOf(Cause cause);
/// The cause of a key; empty where there is none.
[[nodiscard]] std::optional<Cause> causeOf(std::string_view key);

/// What was found to be wrong, where, and what to do.
struct Finding {
    Cause cause = Cause::modelDoesNotFit;
    std::string view; ///< name of the pose; empty where it is of no single one
    std::string file; ///< name of the image in it; empty likewise
    std::string why;
    std::string remedy;
    bool operator==(const Finding&) const = default;
};

/// "capture_1, graycode_07.png: why; remedy", with as much of the place as there is.
[[nodiscard]] std::string sentenceOf(const Finding& finding);

/// A capture that cannot be trusted.
class CaptureRefused : public DataError {
public:
    explicit CaptureRefused(Finding finding);
    [[nodiscard]] const Finding& finding() const noexcept { return finding_; }

private:
    Finding finding_;
};

} // namespace lumorph

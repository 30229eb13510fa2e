#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <QString>

#include "app/studio/base/step_tone.h"
#include "app/studio/calibration/calibration_setup.h"
#include "app/studio/calibration/error_plan.h"
#include "app/studio/calibration/pose_pictures.h"
#include "calibration/report/calibration_record.h"
#include "calibration/solve/next_pose.h"
#include "calibration/solve/observations.h"
#include "calibration/solve/procam_calibration.h"
#include "core/scene/installation_store.h"

namespace lumorph::studio {

/// Fewer poses cannot be solved.
inline constexpr int kFewestPoses = 3;

/// One pose of the board, as far as it is known.
struct CalibrationPose {
    std::string name;
    std::shared_ptr<const PosePictures> pictures; ///< null where nothing could be read
    std::shared_ptr<const ViewObservations> seen; ///< null where it was refused
    std::vector<Finding> warnings;
    std::optional<Finding> refusal;
    bool leftOut = false; ///< by the user
    [[nodiscard]] bool counts() const noexcept { return seen && !refusal && !leftOut; }
};

/// A place in a picture and how far what was seen there is from where the solution puts it, pixels.
struct Residual {
    cv::Point2d at, error;
};

/// How well one pose fits.
struct PoseResiduals {
    std::string name;
    std::vector<Residual> camera;    ///< corners, camera pixels
    std::vector<Residual> projector; ///< decoded points, projector pixels
};

/// What was solved.
struct CalibrationResult {
    ProcamCalibration solved;
    std::vector<PoseResiduals> residuals; ///< by view of the solution
    std::string date;                     ///< ISO 8601 in UTC
    CalibrationSetup setup;               ///< it was made with
    bool isSimulated = false;             ///< of the virtual lab's images
    /// 95 % of light lands within this on the boards, millimetres, by views that were held out; empty with too few.
    std::optional<double> heldOutMillimetres;
    std::optional<ErrorPlan> plan; ///< on table and device; empty while nobody knows where the table is
    std::optional<NextPose> next;  ///< that would help most
    /// 95 % of light lands within this where the device stands: the larger of what the errors of all parameters make of
    /// it and of what held-out views show. Empty with too few poses.
    [[nodiscard]] std::optional<double> millimetres() const;
    /// In the lab, where the truth is known: how far it truly lands beside, root mean square, millimetres.
    std::optional<double> trueMillimetres;
};

/// Where the calibration stands: a plain value.
struct CalibrationState {
    enum class Work { none, reading, capturing, solving };
    CalibrationSetup setup;
    std::vector<CalibrationPose> poses;
    std::optional<Finding> refusal;                  ///< of the capture as a whole
    std::shared_ptr<const CalibrationResult> result; ///< of the poses that count
    Work work = Work::none;
    double fraction = 0.0;    ///< of the work
    QString stage;            ///< in words
    QString trouble;          ///< what failed apart from the capture: a camera that is gone, a folder that is empty
    std::string flatPose;     ///< name of the pose in which the board lay flat on the table
    bool isReadWhole = false; ///< all poses of the folder; else reading ended at a refusal, or was cancelled
    QString arriving;         ///< what is not yet whole of what comes into the folder, in words; empty: nothing
    bool isImported = false;  ///< the result came from a file, without poses to look at
    std::filesystem::path savedIn;        ///< folder of the images of the poses; empty while there are none
    std::optional<EarlierPoses> earlier;  ///< that one can go on with
    int unsaved = 0;                      ///< poses whose images are only in memory
    std::vector<std::string> askedBeside; ///< what the room holds, while it asks (SimulatedQuestion); else empty
    bool isResultInRoom = false;          ///< the room has the figures of the result
    std::string roomDate;                 ///< of the measurement that the room's projector has now; empty: none
    bool isRoomSimulated = false;         ///< that was the virtual lab's
    [[nodiscard]] int counting() const;
    [[nodiscard]] bool isSolved() const noexcept { return result != nullptr && !refusal; }
    [[nodiscard]] bool isUsed() const noexcept { return result && isResultInRoom; }
};

/// One step of the sequence.
struct CalibrationStep {
    enum class How { notBegun, needsYou, running, good, doubtful, refused };
    QString id, title;
    How how = How::notBegun;
    QString words; ///< where it stands, and why
    bool operator==(const CalibrationStep&) const = default;
};
[[nodiscard]] std::vector<CalibrationStep> stepsOf(const CalibrationState& state);
/// "Good", "Needs you", ...
[[nodiscard]] QString howWords(CalibrationStep::How how);

/// What is to be done next: one sentence, why, and the one button.
struct NextStep {
    enum class Do {
        nothing,
        chooseFolder,
        read,
        photograph,
        photographAgain,
        solve,
        use,
        stop,
        exchangeSides,
        leaveOut
    };
    using Tone = StepTone;
    Do what = Do::nothing;
    Tone tone = Tone::quiet;
    QString title, text;
    QString button; ///< empty: there is nothing to press
    bool operator==(const NextStep&) const = default;
};
[[nodiscard]] NextStep nextOf(const CalibrationState& state);

/// A finding in the studio's words: what happened where, and what to do, without words of the command line.
struct FindingWords {
    QString title, text, remedy;
};
[[nodiscard]] FindingWords wordsOf(const Finding& finding);
/// The same as a doubt beside a result: what only who was there can tell is asked, not stated.
[[nodiscard]] FindingWords wordsOfDoubt(const Finding& finding);

/// Reasons why a result is to be doubted, the gravest first; none: it is good.
[[nodiscard]] std::vector<Finding> doubtsOf(const CalibrationResult& result);
/// What was passed over, and what was found to be another board than said: no doubt of the result.
[[nodiscard]] std::vector<Finding> remarksOf(const CalibrationResult& result);

/// What is kept of it beside the installation: date, figures, inputs.
[[nodiscard]] InstallationVersion versionOf(const CalibrationState& state, const Installation& installation);

/// The result as it is kept and exchanged.
[[nodiscard]] CalibrationRecord recordOf(const CalibrationResult& result);

/// Poses have come or gone since it was solved.
[[nodiscard]] bool isOld(const CalibrationState& state);
/// Of the next pose that is photographed: the first that is not there, or is taken again.
[[nodiscard]] int freeNumber(const CalibrationState& state);

/// What the poses that count tell together.
[[nodiscard]] std::vector<ViewObservations> countingViews(const CalibrationState& state);

} // namespace lumorph::studio

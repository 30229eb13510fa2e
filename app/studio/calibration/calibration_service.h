#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <QImage>
#include <QObject>
#include <QPointF>
#include <QSize>

#include "app/studio/base/jobs.h"
#include "app/studio/base/notices.h"
#include "app/studio/base/settings.h"
#include "app/studio/calibration/calibration_state.h"
#include "app/studio/calibration/folder_watch.h"
#include "app/studio/calibration/simulated_question.h"
#include "app/studio/document/job_slots.h"
#include "app/studio/document/studio_document.h"
#include "calibration/capture/pattern_display.h"
#include "calibration/capture/picture_light.h"
#include "calibration/capture/pose_capture.h"
#include "calibration/report/report_page.h"

class QTimer;

namespace lumorph {
struct ReadCapture;
}

namespace lumorph::studio {

class CaptureBench;
class PoseStore;

/// What the camera sees now.
struct LiveSight {
    QImage picture;               ///< null while there is none
    QSize camera;                 ///< its pixels, in which all points are told
    std::vector<QPointF> corners; ///< of the board; empty where it is not found
    std::vector<QPointF> ghost;   ///< where the board should be next, its corners in turn; empty: no matter
    QString words;                ///< what it shows, or why there is none
    PictureLight light;           ///< how it is exposed, and how sharp
    double sharpest = 0.0;        ///< that was seen since the camera was opened
};

/// A calibration of projector and camera, step by step, without widgets: what is chosen, what was photographed or read,
/// what came out, and what is to be done next. What takes long runs as a job. Lives in the window's thread.
class CalibrationService : public QObject {
    Q_OBJECT
public:
    /// Opens what shows patterns on the installed projector of this number; throws DeviceError with what to do. Called
    /// in the window's thread; deleted there too.
    using DisplayOpener = std::function<std::unique_ptr<PatternDisplay>(std::size_t projector)>;
    /// Puts a measured installation into the document, as a step of undo and a version; false where that failed.
    using VersionTaker = std::function<bool(const CalibrationState& state, const Installation& installation)>;

    CalibrationService(Settings& settings, StudioDocument& document, Jobs& jobs, Notices& notices,
                       CameraOpener openCamera, DisplayOpener openDisplay, VersionTaker take,
                       QObject* parent = nullptr);
    ~CalibrationService() override;

    [[nodiscard]] const CalibrationState& state() const noexcept { return state_; }
    [[nodiscard]] const LiveSight& live() const noexcept { return live_; }
    /// Number of the room's projector that is calibrated.
    [[nodiscard]] std::size_t projector() const;

    /// In sight or not: only then the camera is looked through.
    void setActive(bool active);
    /// If false, camera and projector are released as soon as nothing is being photographed.
    void setHolding(bool holds);
    /// Another way, board, folder ...: poses that were made with other ones go. Of the board's spacing only what is
    /// said has changed: it is solved again.
    void setSetup(const CalibrationSetup& setup);
    void setWay(CaptureWay way);

    /// Does what `nextOf` says. `chooseFolder` is the window's: nothing happens.
    void doNext();
    void photograph();
    /// Photographs until there are as many poses as wanted; the lab alone can, since nobody has to move the board.
    void photographRest();
    void solve();
    void cancel();
    void setLeftOut(const std::string& pose, bool leftOut);
    void beginAnew();
    /// Reads the poses that were photographed before the studio ended (`CalibrationState::earlier`); more can follow.
    void goOnWithEarlier();
    /// Tries again to save the images of poses that are only in memory, and brings all into the folder that is chosen.
    void savePoses();
    void setFlatPose(const std::string& pose);
    /// Puts the result into the room: a step of undo.
    void use();
    /// Writes the result by the file's ending: .json, .yaml, .yml. A notice says what went wrong.
    void exportTo(const std::filesystem::path& file);
    /// Writes a report of result or refusal, with these pictures beside those of the poses: .html or .pdf.
    void reportTo(const std::filesystem::path& file, std::vector<ReportPicture> pictures);
    /// Takes the result of another time or program in place of poses and result. A notice says what went wrong; that of
    /// an earlier file goes.
    void importFrom(const std::filesystem::path& file);
    /// What would stand in the room; throws InvalidInput where it cannot.
    [[nodiscard]] Installation roomOfResult() const;

signals:
    void changed();     ///< of the state
    void liveChanged(); ///< of the live sight

private:
    struct Mailbox;
    struct SavedPoses;
    struct TakenPose;
    [[nodiscard]] static SavedPoses saveTo(const std::filesystem::path& parent, PoseStore& store,
                                           std::shared_ptr<const CapturedPose> pose, const Progress& progress);
    class Looker;
    /// Images of a folder; of poses that were read already only where it is read `anew`.
    void read(bool anew = true);
    void takeRead(ReadCapture capture);
    /// Poses that were photographed or copied into the folder meanwhile, or are others now.
    [[nodiscard]] bool takeArrived(const FolderWatch::Contents& arrived);
    void setSpacing(double spacing);
    void openBench();
    /// The room's projector has other pixels since the bench was opened.
    [[nodiscard]] bool isBenchOutdated() const;
    void tellNoProjector();
    void look();
    void letGo();
    void takeSight(const std::shared_ptr<CaptureBench>& from, LiveSight sight, const std::string& trouble);
    void clearResults();
    void withdrawVerdicts();
    void poll();
    void endWork();
    void takePose(CalibrationPose pose);
    void chooseFlat();
    void takeSaved(const SavedPoses& saved);
    void forgetPoses();
    void offerEarlier();
    void setTrouble(const std::exception& error);
    void followDocument();
    void takeImport(const std::filesystem::path& file, CalibrationRecord record);
    [[nodiscard]] bool isInRoom() const;
    void takeResult(CalibrationResult result);
    [[nodiscard]] RoomPlacement placement() const;
    [[nodiscard]] std::optional<BoardPoints> flatPoints() const;
    [[nodiscard]] std::optional<NextPose> wanted() const;
    [[nodiscard]] cv::Rect lit() const;

    Settings& settings_;
    StudioDocument& document_;
    Notices& notices_;
    CameraOpener openCamera_;
    DisplayOpener openDisplay_;
    VersionTaker take_;
    CalibrationState state_;
    SimulatedQuestion question_; ///< of the result
    LiveSight live_;
    std::shared_ptr<CaptureBench> bench_;
    glm::ivec2 benchPixels_{0};        ///< of the projector, when it was opened
    std::shared_ptr<PoseStore> store_; ///< of the poses of this calibration
    QString saveTrouble_;              ///< subject of the notice about it
    QString importTrouble_;            ///< subject of the notice about the file that was to be imported last
    std::shared_ptr<Mailbox> mailbox_; ///< of the work that runs
    JobSlots jobs_;
    QTimer* liveTimer_;
    bool active_ = false;
    bool isHolding_ = true;
    bool isOpening_ = false; ///< the bench
    bool isAsked_ = false;   ///< a photograph, while it was opened
    bool isLooking_ = false;
    bool isStale_ = false;                ///< what is looked at has changed meanwhile: another look follows
    bool isFlatChosen_ = false;           ///< by the user; else it is the first pose
    bool rest_ = false;                   ///< the poses that are missing follow by themselves
    int benchTry_ = 0;                    ///< counts, so that a bench that comes too late is not taken
    std::unique_ptr<FolderWatch> watch_;  ///< of a folder that was read
    std::vector<std::string> incomplete_; ///< poses in it that are still being photographed
    std::vector<Finding> passedOver_;     ///< what lies beside the poses in their folder
    std::unique_ptr<Looker> looker_;      ///< last: it refers to the rest
};

} // namespace lumorph::studio

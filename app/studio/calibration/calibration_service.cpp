#include "app/studio/calibration/calibration_service.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <span>
#include <stop_token>
#include <thread>
#include <utility>
#include <variant>

#include <QCoreApplication>
#include <QDateTime>
#include <QGuiApplication>
#include <QScreen>
#include <QTimer>
#include <opencv2/imgproc.hpp>

#include "app/studio/calibration/calibration_work.h"
#include "app/studio/calibration/capture_bench.h"
#include "app/studio/calibration/pose_store.h"
#include "app/studio/calibration/report_pdf.h"
#include "calibration/doctor/capture_calibration.h"
#include "calibration/doctor/sequence_check.h"
#include "calibration/lab/true_room.h"
#include "calibration/report/calibration_file.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/scene/measured_sigma.h"

namespace lumorph::studio {
namespace {

constexpr auto kPlace = "calibrate"; // of jobs and notices
constexpr int kLiveMilliseconds = 60;
constexpr int kSolvedBetween = 4; // poses from which on it is solved after each
constexpr double kMetresPerUnit = 0.001;
constexpr double kTable = 0.2; // metres around the origin, where the lab tells the truth

QString openingTitle(CaptureWay way) {
    return way == CaptureWay::lab ? CalibrationService::tr("Setting up the lab")
                                  : CalibrationService::tr("Opening the camera");
}

/// Whether the studio has a picture of that size itself.
bool isSizeOfScreen(cv::Size size) {
    return std::ranges::any_of(QGuiApplication::screens(), [size](const QScreen* screen) {
        const QSizeF pixels = screen->devicePixelRatio() * QSizeF(screen->size());
        return cv::Size(qRound(pixels.width()), qRound(pixels.height())) == size;
    });
}

/// What is as white as a camera can tell, in red: there may be more light than the picture says.
cv::Mat withClippedTint(const cv::Mat& grey) {
    static const cv::Scalar kRed(60, 70, 235);
    cv::Mat tinted;
    cv::cvtColor(grey, tinted, cv::COLOR_GRAY2BGR);
    tinted.setTo(kRed, grey >= PictureLight::kClipped);
    return tinted;
}

} // namespace

/// What a worker hands over while it works; read in the window's thread.
struct CalibrationService::Mailbox {
    std::mutex mutex;
    std::vector<CalibrationPose> poses;
    cv::Mat shot;
    int index = 0, count = 0;
    void take(CalibrationPose pose) {
        const std::scoped_lock lock(mutex);
        poses.push_back(std::move(pose));
    }
};

/// What stood in the way of saving the images of the poses.
struct CalibrationService::SavedPoses {
    std::optional<Notice> trouble;
};

struct CalibrationService::TakenPose {
    CalibrationPose pose;
    std::optional<SavedPoses> saved; ///< none where the pose was refused
};

/// Looks through the camera beside the window, one look at a time; the newest order wins.
class CalibrationService::Looker {
public:
    using Look = std::function<void(const Progress&)>;
    Looker() : thread_([this](const std::stop_token& stop) { run(stop); }) {}
    void look(Look look) {
        const std::scoped_lock lock(mutex_);
        next_ = std::move(look);
        wake_.notify_one();
    }

private:
    void run(const std::stop_token& stop) {
        while (true) {
            Look look;
            {
                std::unique_lock lock(mutex_);
                if (!wake_.wait(lock, stop, [this] { return next_ != nullptr; })) return;
                look = std::exchange(next_, nullptr);
            }
            look(Progress({}, stop));
        }
    }

    std::mutex mutex_;
    std::condition_variable_any wake_;
    Look next_;
    std::jthread thread_; ///< last, so that it has ended before the rest goes
};

CalibrationService::CalibrationService(Settings& settings, StudioDocument& document, Jobs& jobs, Notices& notices,
                                       CameraOpener openCamera, DisplayOpener openDisplay, VersionTaker take,
                                       QObject* parent)
    : QObject(parent), settings_(settings), document_(document), notices_(notices), openCamera_(std::move(openCamera)),
      openDisplay_(std::move(openDisplay)), take_(std::move(take)), jobs_(*this, jobs, notices),
      liveTimer_(new QTimer(this)), looker_(std::make_unique<Looker>()) {
    state_.setup = keptSetup(settings, keptWay(settings));
    forgetPoses();
    offerEarlier();
    liveTimer_->setSingleShot(true);
    liveTimer_->setInterval(kLiveMilliseconds);
    connect(liveTimer_, &QTimer::timeout, this, [this] { look(); });
    connect(&jobs, &Jobs::progressed, this, [this, &jobs](int id) {
        for (const Jobs::Status& status : jobs.running())
            if (status.id == id && status.title == openingTitle(CaptureWay::lab) && !bench_) {
                live_.words = status.title + QString(", %1 %").arg(100.0 * status.fraction, 0, 'f', 0);
                emit liveChanged();
            } else if (status.id == id && status.place == kPlace && state_.work != CalibrationState::Work::none) {
                state_.fraction = status.fraction;
                state_.stage = status.stage;
                if (!state_.stage.isEmpty()) state_.stage[0] = state_.stage[0].toUpper();
                poll();
            }
    });
    followDocument();
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::installation) followDocument();
    });
}

CalibrationService::~CalibrationService() = default;

void CalibrationService::setActive(bool active) {
    active_ = active;
    if (!active) return liveTimer_->stop();
    if (!bench_ && isLive(state_.setup.way)) return openBench();
    look();
}

void CalibrationService::setHolding(bool holds) {
    isHolding_ = holds;
    if (!holds) letGo();
}

/// Other measurements look through the same camera, and the projector has its show back.
void CalibrationService::letGo() {
    liveTimer_->stop();
    if (state_.setup.way != CaptureWay::camera || state_.work == CalibrationState::Work::capturing || !bench_) return;
    looker_->look(
        [bench = std::exchange(bench_, nullptr)](const Progress&) mutable { bench.reset(); }); // takes a while
    isLooking_ = false;
    live_ = {};
    emit liveChanged();
}

std::size_t CalibrationService::projector() const {
    // The room may have lost projectors since one was chosen.
    return state_.setup.installed < document_.state().installation->projectors.size() ? state_.setup.installed : 0;
}

void CalibrationService::setWay(CaptureWay way) {
    if (way != state_.setup.way) setSetup(keptSetup(settings_, way));
}

void CalibrationService::setSetup(const CalibrationSetup& setup) {
    if (setup == state_.setup) return;
    const bool onlyMore = [&] { // nothing that the poses so far were made with
        CalibrationSetup same = setup;
        same.poses = state_.setup.poses;
        same.saved = state_.setup.saved;
        same.board.spacing = state_.setup.board.spacing;
        same.board.marker = state_.setup.board.marker;
        return same == state_.setup &&
               (setup.poses == same.poses || (setup.poses > same.poses && setup.way != CaptureWay::lab));
    }();
    const bool isElsewhere = setup.saved != state_.setup.saved;
    const bool isOtherBoard = setup.board != state_.setup.board;
    const bool isUnread = state_.poses.empty() || (setup.way == CaptureWay::folder && !state_.isReadWhole);
    const bool isAnew = !onlyMore || (isOtherBoard && isUnread);
    if (!isAnew && isOtherBoard) setSpacing(setup.board.spacing);
    state_.setup = setup;
    keepSetup(settings_, setup);
    if (isAnew)
        beginAnew();
    else if (isElsewhere && (!state_.savedIn.empty() || state_.unsaved > 0))
        savePoses();
    if (!isAnew && isOtherBoard) {
        if (state_.counting() >= kFewestPoses && problemOf(setup).isEmpty()) solve();
        look();
    }
    emit changed();
}

/// The board's corners lie farther apart, or less far; where they were seen stays. The lab's board stays as it is, as a
/// printed one does.
void CalibrationService::setSpacing(double spacing) {
    cancel();
    clearResults();
    const double scale = spacing / state_.setup.board.spacing;
    for (CalibrationPose& pose : state_.poses) {
        if (!pose.seen) continue;
        ViewObservations seen = *pose.seen;
        for (cv::Point3d& point : seen.corners.board) point *= scale;
        pose.seen = std::make_shared<const ViewObservations>(std::move(seen));
    }
}

void CalibrationService::beginAnew() {
    cancel();
    jobs_.stop("open");
    isOpening_ = isAsked_ = isLooking_ = false;
    ++benchTry_;
    bench_ = nullptr;
    forgetPoses();
    state_.flatPose.clear();
    isFlatChosen_ = false;
    clearResults();
    offerEarlier();
    followDocument();
    live_ = {};
    if (active_ && isLive(state_.setup.way)) openBench();
    emit changed();
    emit liveChanged();
}

/// Those that come now get a folder of their own.
void CalibrationService::forgetPoses() {
    jobs_.stop("save");
    if (state_.setup.way == CaptureWay::camera && state_.savedIn == unfinishedFolder(settings_))
        keepUnfinished(settings_, {});
    watch_ = nullptr;
    incomplete_.clear();
    state_.arriving.clear();
    store_ = std::make_shared<PoseStore>(isSimulatedWay(state_.setup));
    state_.poses.clear();
    passedOver_.clear();
    state_.isReadWhole = false;
    state_.savedIn.clear();
    state_.unsaved = 0;
    state_.earlier.reset();
}

/// What a camera photographed before the studio ended, and nobody used yet.
void CalibrationService::offerEarlier() {
    state_.earlier.reset();
    if (state_.setup.way == CaptureWay::camera && state_.poses.empty()) state_.earlier = earlierPoses(settings_);
}

void CalibrationService::goOnWithEarlier() {
    if (!state_.earlier || !state_.poses.empty() || state_.work != CalibrationState::Work::none) return;
    const auto& projectors = document_.state().installation->projectors;
    if (projector() >= projectors.size()) return tellNoProjector();
    const EarlierPoses earlier = *std::exchange(state_.earlier, std::nullopt);
    withdrawVerdicts();
    CalibrationSetup setup = state_.setup;
    setup.folder = earlier.folder;
    setup.order.clear();
    const glm::ivec2 size = projectors[projector()].camera.size;
    setup.projector = {size.x, size.y};
    state_.work = CalibrationState::Work::reading;
    state_.stage = tr("Looking for images");
    mailbox_ = std::make_shared<Mailbox>();
    jobs_.runWith<OrFinding<ReadCapture>>(
        "read", kPlace, tr("Reading the poses of %1").arg(earlier.when),
        [setup, box = mailbox_](const Progress& progress) {
            return readFolder(
                setup, {}, [&](CalibrationPose pose) { box->take(std::move(pose)); }, progress);
        },
        [this, folder = earlier.folder](const OrFinding<ReadCapture>& read) {
            poll();
            endWork();
            store_ = std::make_shared<PoseStore>(isSimulatedWay(state_.setup), folder);
            state_.savedIn = folder;
            if (const auto* finding = std::get_if<Finding>(&read); finding && finding->view.empty())
                state_.refusal = *finding;
            else if (state_.counting() >= kSolvedBetween || state_.counting() >= state_.setup.poses)
                solve();
            look();
            emit changed();
        },
        [this](const std::exception& error) {
            setTrouble(error);
            offerEarlier();
        });
    emit changed();
}

void CalibrationService::clearResults() {
    state_.result = nullptr;
    state_.isImported = false;
    state_.isResultInRoom = false;
    withdrawVerdicts();
}

/// What was said of the poses so far, before there are others; the result stays until there is a better one.
void CalibrationService::withdrawVerdicts() {
    question_.withdraw();
    state_.askedBeside.clear();
    state_.refusal.reset();
    state_.trouble.clear();
}

void CalibrationService::doNext() {
    switch (const NextStep next = nextOf(state_); next.what) {
    case NextStep::Do::read:
        return read(state_.refusal.has_value() || state_.poses.empty());
    case NextStep::Do::photograph:
    case NextStep::Do::photographAgain:
        return photograph();
    case NextStep::Do::solve:
        return solve();
    case NextStep::Do::use:
        return use();
    case NextStep::Do::stop:
        return cancel();
    case NextStep::Do::exchangeSides: {
        CalibrationSetup setup = state_.setup;
        std::swap(setup.projector.width, setup.projector.height);
        setSetup(setup);
        return read();
    }
    case NextStep::Do::leaveOut: {
        for (const CalibrationPose& pose : state_.poses)
            if (pose.refusal && !pose.leftOut) return setLeftOut(pose.name, true);
        if (state_.refusal) setLeftOut(state_.refusal->view, true);
        return;
    }
    case NextStep::Do::chooseFolder:
    case NextStep::Do::nothing:
        return;
    }
}

void CalibrationService::cancel() {
    for (const char* slot : {"read", "capture", "solve"}) jobs_.stop(slot);
    rest_ = isAsked_ = false;
    endWork();
    emit changed();
}

void CalibrationService::endWork() {
    state_.work = CalibrationState::Work::none;
    state_.stage.clear();
    state_.fraction = 0.0;
    mailbox_ = nullptr;
}

void CalibrationService::setTrouble(const std::exception& error) {
    endWork();
    rest_ = false;
    const Notice notice = noticeOf(error);
    QStringList parts;
    for (const QString& part : {notice.subject, notice.why, notice.remedy})
        if (!part.isEmpty()) parts << part;
    state_.trouble = parts.join(": ");
    emit changed();
}

void CalibrationService::takePose(CalibrationPose pose) {
    auto& poses = state_.poses;
    const auto same = std::ranges::find(poses, pose.name, &CalibrationPose::name);
    if (same != poses.end())
        *same = std::move(pose);
    else
        poses.push_back(std::move(pose));
    std::ranges::sort(poses, isNamedBefore, &CalibrationPose::name);
    chooseFlat();
}

/// The first that counts, unless the user has said another.
void CalibrationService::chooseFlat() {
    if (isFlatChosen_) return;
    const auto first = std::ranges::find_if(state_.poses, [](const CalibrationPose& one) { return one.counts(); });
    state_.flatPose = first == state_.poses.end() ? std::string() : first->name;
}

/// What a worker has put into the mailbox so far.
void CalibrationService::poll() {
    if (mailbox_) {
        std::vector<CalibrationPose> poses;
        cv::Mat shot;
        {
            const std::scoped_lock lock(mailbox_->mutex);
            poses.swap(mailbox_->poses);
            std::swap(shot, mailbox_->shot);
            if (mailbox_->count > 0 && state_.work == CalibrationState::Work::capturing)
                state_.stage = tr("Pattern %1 of %2").arg(mailbox_->index + 1).arg(mailbox_->count);
        }
        for (CalibrationPose& pose : poses) takePose(std::move(pose));
        if (!shot.empty()) {
            live_.picture = pictureOfMat(shot);
            live_.camera = {shot.cols, shot.rows};
            live_.corners.clear();
            live_.words = state_.stage;
            emit liveChanged();
        }
    }
    emit changed();
}

void CalibrationService::read(bool anew) {
    cancel();
    clearResults();
    state_.isReadWhole = false;
    if (anew) state_.arriving.clear(), incomplete_.clear();
    if (anew || !watch_)
        watch_ = std::make_unique<FolderWatch>(
            state_.setup.folder, [this](const FolderWatch::Contents& arrived) { return takeArrived(arrived); });
    std::erase_if(state_.poses, [&](const CalibrationPose& pose) { return !pose.leftOut && (anew || !pose.seen); });
    if (anew)
        for (CalibrationPose& pose : state_.poses) pose.seen = nullptr; // read when it is put back in
    std::vector<std::string> without = incomplete_;                     // left out, or read before
    for (const CalibrationPose& pose : state_.poses) without.push_back(pose.name);
    state_.work = CalibrationState::Work::reading;
    state_.stage = tr("Looking for images");
    mailbox_ = std::make_shared<Mailbox>();
    const auto work = [setup = state_.setup, without, box = mailbox_](const Progress& progress) {
        return readFolder(
            setup, without, [&](CalibrationPose pose) { box->take(std::move(pose)); }, progress);
    };
    jobs_.runWith<OrFinding<ReadCapture>>(
        "read", kPlace, tr("Reading the images"), work,
        [this](OrFinding<ReadCapture> read) {
            poll();
            endWork();
            if (const auto* finding = std::get_if<Finding>(&read)) {
                if (finding->view.empty()) state_.refusal = *finding;
                emit changed();
                return;
            }
            takeRead(std::get<ReadCapture>(std::move(read)));
        },
        [this](const std::exception& error) { setTrouble(error); });
    emit changed();
}

bool CalibrationService::takeArrived(const FolderWatch::Contents& arrived) {
    if (state_.work != CalibrationState::Work::none || state_.isImported || !problemOf(state_.setup).isEmpty())
        return false;
    const auto wanted = static_cast<int>(orderOf(state_.setup).images.size());
    bool isWhole = false;
    for (const auto& [name, content] : arrived) {
        std::erase(incomplete_, name);
        if (content.files < wanted) {
            incomplete_.push_back(name);
            state_.arriving = tr("%1 has %2 of %3 photographs so far.")
                                  .arg(QString::fromStdString(name))
                                  .arg(content.files)
                                  .arg(wanted);
            continue;
        }
        isWhole = true;
        for (CalibrationPose& pose : state_.poses)
            if (pose.name == name) pose.seen = nullptr; // photographed again
    }
    if (incomplete_.empty()) state_.arriving.clear();
    if (isWhole)
        read(false);
    else
        emit changed();
    return true;
}

void CalibrationService::takeRead(ReadCapture capture) {
    state_.isReadWhole = true;
    passedOver_ = std::move(capture.warnings); // the poses have their own
    std::erase_if(passedOver_, [](const Finding& one) { return one.cause != Cause::passedOver; });
    solve();
}

void CalibrationService::tellNoProjector() {
    rest_ = false;
    state_.trouble = tr("The room has no projector. Add one in the Scene workspace.");
    emit changed();
}

void CalibrationService::openBench() {
    CalibrationSetup setup = state_.setup;
    setup.installed = projector();
    if (setup.way == CaptureWay::camera && setup.camera.empty()) return;
    const auto room = document_.state().installation;
    if (projector() >= room->projectors.size()) return tellNoProjector();
    std::shared_ptr<PatternDisplay> display;
    if (setup.way == CaptureWay::camera) {
        try {
            // Deleted in the window's thread, whoever lets go of it last.
            display = std::shared_ptr<PatternDisplay>(openDisplay_(projector()).release(), [](PatternDisplay* shown) {
                QMetaObject::invokeMethod(
                    qApp, [shown] { delete shown; }, Qt::QueuedConnection);
            });
        } catch (const std::exception& error) {
            return setTrouble(error);
        }
    }
    live_.words = openingTitle(setup.way);
    isOpening_ = true;
    benchPixels_ = room->projectors[projector()].camera.size;
    const int attempt = ++benchTry_;
    jobs_.runWith<std::shared_ptr<CaptureBench>>(
        "open", kPlace, openingTitle(setup.way),
        [setup, room, display, open = openCamera_](const Progress& progress) {
            return setup.way == CaptureWay::lab ? openLabBench(setup, *room, progress)
                                                : openCameraBench(setup, open, display, progress);
        },
        [this, attempt](std::shared_ptr<CaptureBench> bench) {
            if (attempt != benchTry_) return;
            bench_ = std::move(bench);
            isOpening_ = false;
            state_.trouble.clear();
            if (isAsked_) return photograph();
            look();
            emit changed();
        },
        [this](const std::exception& error) {
            isOpening_ = false;
            if (isAsked_) cancel();
            setTrouble(error);
        });
    emit liveChanged();
}

bool CalibrationService::isBenchOutdated() const {
    const auto& projectors = document_.state().installation->projectors;
    return (bench_ || isOpening_) && projector() < projectors.size() &&
           projectors[projector()].camera.size != benchPixels_;
}

void CalibrationService::look() {
    isStale_ = isLooking_;
    if (!isHolding_) return letGo();
    if (!active_ || !bench_ || isLooking_ || state_.work == CalibrationState::Work::capturing) return;
    isLooking_ = true;
    const int pose = freeNumber(state_);
    looker_->look([this, bench = bench_, board = state_.setup.board, pose, wanted = wanted(),
                   lit = lit()](const Progress& progress) {
        LiveSight sight;
        std::string trouble;
        try {
            const std::scoped_lock lock(bench->mutex);
            const cv::Mat picture = bench->look(progress);
            sight.camera = {picture.cols, picture.rows};
            sight.light = lightOf(picture);
            sight.picture = pictureOfMat(sight.light.clipped > 0.0 ? withClippedTint(picture) : picture);
            sight.corners = liveCorners(picture, board);
            bench->setBoard(board);
            bench->setWanted(wanted ? std::optional(wanted->cameraFromBoard) : std::nullopt);
            for (const cv::Point2d& point : wanted ? wanted->outline : bench->ghost(pose, lit))
                sight.ghost.emplace_back(point.x, point.y);
        } catch (const std::exception& error) {
            trouble = error.what();
        }
        QMetaObject::invokeMethod(
            this,
            [this, bench, sight = std::move(sight), trouble = std::move(trouble)]() mutable {
                takeSight(bench, std::move(sight), trouble);
            },
            Qt::QueuedConnection);
    });
}

/// The pose that would help most, once enough is known to tell; the first poses follow a plan.
std::optional<NextPose> CalibrationService::wanted() const {
    if (!state_.result || state_.isImported || state_.setup.way == CaptureWay::folder) return std::nullopt;
    if (isOld(state_)) return std::nullopt; // the pose that was helpful is there
    return state_.result->next;
}

/// Where the projector's light was seen so far.
cv::Rect CalibrationService::lit() const {
    cv::Rect all;
    for (const CalibrationPose& pose : state_.poses)
        if (pose.counts() && pose.pictures) all |= pose.pictures->lit;
    return all;
}

void CalibrationService::takeSight(const std::shared_ptr<CaptureBench>& from, LiveSight sight,
                                   const std::string& trouble) {
    if (from != bench_) return;
    isLooking_ = false;
    if (state_.work == CalibrationState::Work::capturing) return;
    if (!trouble.empty()) {
        bench_ = nullptr;
        state_.trouble = QString::fromStdString(trouble);
        live_ = {};
        emit liveChanged();
        emit changed();
        return;
    }
    sight.words = sight.corners.empty() ? tr("No board in sight") : tr("Board in sight");
    sight.sharpest = std::max(live_.sharpest, sight.light.sharpness);
    live_ = std::move(sight);
    if (bench_->isLive() && active_) liveTimer_->start();
    if (isStale_) look();
    emit liveChanged();
}

void CalibrationService::photographRest() {
    rest_ = state_.setup.way == CaptureWay::lab;
    photograph();
}

void CalibrationService::photograph() {
    const bool rest = rest_;
    const auto helpful = wanted();
    cancel();
    rest_ = rest;
    const std::string contradicted = state_.refusal ? state_.refusal->view : std::string();
    std::erase_if(state_.poses, [&](const CalibrationPose& pose) {
        return pose.refusal.has_value() || (!contradicted.empty() && pose.name == contradicted);
    });
    if (state_.isImported || !contradicted.empty())
        clearResults();
    else
        withdrawVerdicts();
    if (projector() >= document_.state().installation->projectors.size()) return tellNoProjector();
    if (isBenchOutdated()) {
        beginAnew();
        rest_ = rest;
    }
    if (!bench_) {
        if (!isOpening_) openBench();
        isAsked_ = isOpening_; // done once it is open
        if (isAsked_) {
            state_.work = CalibrationState::Work::capturing;
            state_.stage = openingTitle(state_.setup.way);
        }
        return emit changed();
    }
    state_.work = CalibrationState::Work::capturing;
    state_.stage = tr("Waiting for the camera");
    mailbox_ = std::make_shared<Mailbox>();
    const int number = freeNumber(state_);
    const auto room = document_.state().installation;
    const glm::ivec2 size = room->projectors.at(projector()).camera.size;
    const auto work = [bench = bench_, store = store_, setup = state_.setup, number, size, helpful,
                       box = mailbox_](const Progress& progress) -> TakenPose {
        const std::scoped_lock lock(bench->mutex);
        bench->setBoard(setup.board);
        bench->setWanted(helpful ? std::optional(helpful->cameraFromBoard) : std::nullopt);
        const auto onShot = [&](const Shot& shot) {
            const std::scoped_lock boxLock(box->mutex);
            box->shot = shot.image;
            box->index = shot.index;
            box->count = shot.count;
        };
        CapturedPose captured = bench->capture(number, onShot, progress.part(0.0, 0.7));
        const auto refusedBy = [&](Finding finding) {
            // A projector of another size, and such, is of the whole capture; here it shows in this pose.
            if (finding.view.empty()) finding.view = captured.name;
            return TakenPose{poseRefusedBy(finding, brightestOf(captured.images)), std::nullopt};
        };
        if (captured.findings.refusal) return refusedBy(*captured.findings.refusal);
        {
            const std::scoped_lock boxLock(box->mutex);
            box->count = 0; // all are photographed: from here on the stage is told
        }
        progress.report(0.75, "Reading the patterns");
        const cv::Size projector(size.x, size.y);
        const CapturedView view{captured.name, {captured.files.begin(), captured.files.end()}};
        try {
            const CaptureOrder order = parsePattern(setup.pattern, projector);
            if (const auto wrong = checkCounts({view}, order)) throw CaptureRefused(*wrong);
            const ReadPose read = readPose(view, captured.images, setup.board, order);
            CalibrationPose pose = poseOf(captured.name, read, projector);
            pose.warnings.insert(pose.warnings.end(), captured.findings.warnings.begin(),
                                 captured.findings.warnings.end());
            return {std::move(pose), saveTo(setup.saved, *store, std::make_shared<CapturedPose>(std::move(captured)),
                                            progress.part(0.85, 1.0))};
        } catch (const CaptureRefused& refused) {
            return refusedBy(refused.finding());
        }
    };
    jobs_.runWith<TakenPose>(
        "capture", kPlace, tr("Photographing a pose"), work,
        [this](TakenPose taken) {
            endWork();
            CalibrationPose& pose = taken.pose;
            if (taken.saved) takeSaved(*taken.saved);
            const bool refused = pose.refusal.has_value();
            takePose(std::move(pose));
            emit changed();
            if (refused) {
                rest_ = false;
                look();
            } else if (state_.counting() >= state_.setup.poses) {
                rest_ = false;
                look();
                solve();
            } else if (rest_) {
                photograph();
            } else {
                look();
                if (state_.counting() >= kSolvedBetween) solve(); // for the pose that helps most next
            }
        },
        [this](const std::exception& error) { setTrouble(error); });
    emit changed();
}

/// A disk that refuses does not spoil the pose.
CalibrationService::SavedPoses CalibrationService::saveTo(const std::filesystem::path& parent, PoseStore& store,
                                                          std::shared_ptr<const CapturedPose> pose,
                                                          const Progress& progress) {
    try {
        store.save(parent, std::move(pose), progress);
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        return {noticeOf(error)};
    }
    return {};
}

void CalibrationService::takeSaved(const SavedPoses& saved) {
    state_.savedIn = store_->folder();
    state_.unsaved = store_->unsaved();
    if (state_.setup.way == CaptureWay::camera) keepUnfinished(settings_, state_.savedIn);
    if (!saveTrouble_.isEmpty()) notices_.dismiss(kPlace, saveTrouble_);
    saveTrouble_.clear();
    if (!saved.trouble) return;
    Notice notice = *saved.trouble;
    notice.level = Notice::Level::warning;
    notice.why += tr("; the calibration goes on, its images stay in memory until they can be saved");
    notice.actions = {{tr("Save again"), [this] { savePoses(); }}};
    saveTrouble_ = notice.subject;
    notices_.post(kPlace, std::move(notice));
}

void CalibrationService::savePoses() {
    jobs_.run<SavedPoses>(
        "save", kPlace, tr("Saving the poses"),
        [store = store_, parent = state_.setup.saved](const Progress& progress) {
            return saveTo(parent, *store, nullptr, progress);
        },
        [this](const SavedPoses& saved) {
            takeSaved(saved);
            emit changed();
        });
}

void CalibrationService::solve() {
    jobs_.stop("solve");
    withdrawVerdicts();
    ReadCapture capture;
    capture.views = countingViews(state_);
    for (const CalibrationPose& pose : state_.poses) { // some may have been read long before the others
        if (!pose.counts() || !pose.pictures) continue;
        const cv::Size size(pose.pictures->camera.width(), pose.pictures->camera.height());
        if (!capture.camera.empty() && size != capture.camera) {
            clearResults();
            state_.refusal = Finding{Cause::imageSize, pose.name, "", "its images have another size than those before",
                                     "give images of one camera with one setting"};
            emit changed();
            return;
        }
        capture.camera = size;
    }
    capture.warnings = passedOver_;
    for (const CalibrationPose& pose : state_.poses)
        if (pose.counts()) addWarnings(pose.warnings, capture.warnings);
    if (capture.views.size() < static_cast<std::size_t>(kFewestPoses)) {
        clearResults();
        state_.refusal = Finding{Cause::tooFewViews, "", "",
                                 std::to_string(capture.views.size()) + " poses count, but three are needed",
                                 "add poses of the board, tilted differently; six are good"};
        emit changed();
        return;
    }
    if (state_.setup.way != CaptureWay::folder && projector() >= document_.state().installation->projectors.size())
        return tellNoProjector();
    state_.work = CalibrationState::Work::solving;
    state_.stage = tr("Working out camera and projector");
    cv::Size size = state_.setup.projector;
    if (state_.setup.way != CaptureWay::folder) {
        const glm::ivec2 installed = document_.state().installation->projectors.at(projector()).camera.size;
        size = {installed.x, installed.y};
    }
    using Result = std::shared_ptr<const CalibrationResult>;
    const SolveTask task{std::move(capture),
                         size,
                         state_.setup,
                         flatPoints(),
                         document_.state().installation,
                         placement(),
                         state_.setup.way != CaptureWay::folder || isSizeOfScreen(size)};
    jobs_.runWith<OrFinding<Result>>(
        "solve", kPlace, tr("Working out camera and projector"),
        [task](const Progress& progress) { return solveCapture(task, progress); },
        [this](OrFinding<Result> solved) {
            endWork();
            clearResults();
            if (const auto* finding = std::get_if<Finding>(&solved)) {
                state_.refusal = *finding;
            } else {
                takeResult(*std::get<Result>(solved));
            }
            emit changed();
        },
        [this](const std::exception& error) { setTrouble(error); });
    emit changed();
}

void CalibrationService::setLeftOut(const std::string& pose, bool leftOut) {
    const auto found = std::ranges::find(state_.poses, pose, &CalibrationPose::name);
    if (found == state_.poses.end() || found->leftOut == leftOut) return;
    cancel();
    found->leftOut = leftOut;
    clearResults();
    if (state_.flatPose == pose && leftOut) isFlatChosen_ = false;
    chooseFlat();
    // Of a folder, reading ended at the first refusal, and what was left out then was not read.
    if (state_.setup.way == CaptureWay::folder && (!state_.isReadWhole || (!leftOut && !found->seen)))
        read(false);
    else if (state_.counting() >= kFewestPoses)
        solve();
    emit changed();
}

void CalibrationService::setFlatPose(const std::string& pose) {
    if (pose == state_.flatPose) return;
    isFlatChosen_ = true;
    state_.flatPose = pose;
    followDocument();
    emit changed();
    if (!state_.result) return;
    using Plan = std::optional<ErrorPlan>;
    jobs_.runWith<Plan>(
        "plan", kPlace, tr("Working out where light can be trusted"),
        [result = state_.result, flat = flatPoints(), room = document_.state().installation,
         placement = placement()](const Progress& progress) {
            return planOf(result->solved, flat, result->setup.board, *room, placement, progress);
        },
        [this, of = state_.result](Plan plan) {
            if (of != state_.result) return;
            CalibrationResult result = *of;
            result.plan = std::move(plan);
            takeResult(std::move(result));
            emit changed();
        },
        [this](const std::exception& error) { setTrouble(error); });
}

RoomPlacement CalibrationService::placement() const {
    RoomPlacement placement;
    placement.projector = projector();
    placement.metresPerUnit = kMetresPerUnit;
    placement.tableView = state_.flatPose;
    return placement;
}

std::optional<BoardPoints> CalibrationService::flatPoints() const {
    const auto pose = std::ranges::find(state_.poses, state_.flatPose, &CalibrationPose::name);
    if (pose == state_.poses.end() || !pose->counts()) return std::nullopt;
    return pose->seen->corners;
}

void CalibrationService::takeResult(CalibrationResult result) {
    if (bench_ && bench_->truth() && !state_.isImported) {
        try {
            RoomPlacement place = placement();
            place.date = result.date;
            const Installation room =
                withCalibration(*document_.state().installation, result.solved, result.setup.board, place);
            if (const auto error =
                    lightError(room.projectors[projector()].camera, bench_->truth()->projectors.front().camera, kTable))
                result.trueMillimetres = 1000.0 * *error;
        } catch (const Error&) { // told when it is to be used
        }
    }
    state_.result = std::make_shared<const CalibrationResult>(std::move(result));
    followDocument();
    look(); // the outline of the next pose is another one now
}

Installation CalibrationService::roomOfResult() const {
    if (!state_.result) throw InvalidInput("calibration", "there is no result", "photograph the board, or read a file");
    RoomPlacement place = placement();
    place.date = state_.result->date;
    if (state_.isImported) {
        const Installation& before = *document_.state().installation;
        Installation room = withImport(before, state_.result->solved, state_.result->setup.board, place);
        if (state_.result->isSimulated) markSimulated(before, room);
        return room;
    }
    Installation room =
        withCalibration(*document_.state().installation, state_.result->solved, state_.result->setup.board, place);
    if (state_.setup.way == CaptureWay::camera && !room.cameras.empty())
        room.cameras.front().address = state_.setup.camera;
    if (state_.result->plan && projector() < room.projectors.size()) {
        // The radius that holds 95 of 100, as the root mean square of a distance in a plane.
        constexpr double kRmsOfMost = 0.5777;
        Origin& lens = room.projectors[projector()].lens;
        lens.method = withSigma(lens.method, {1e-3 * kRmsOfMost * state_.result->plan->mean, 0.0, 0.0});
    }
    if (state_.result->isSimulated) markSimulated(*document_.state().installation, room);
    return room;
}

void CalibrationService::exportTo(const std::filesystem::path& file) {
    if (!state_.result) return;
    jobs_.run<bool>(
        "export", kPlace, tr("Writing the calibration"),
        [record = recordOf(*state_.result), file](const Progress&) {
            writeCalibration(record, file);
            return true;
        },
        [](bool) {});
}

void CalibrationService::reportTo(const std::filesystem::path& file, std::vector<ReportPicture> pictures) {
    CalibrationReport report;
    report.pictures = std::move(pictures);
    if (state_.result) {
        report.record = recordOf(*state_.result);
        report.millimetres = state_.result->millimetres();
        if (state_.result->plan && std::isfinite(state_.result->plan->worst)) report.where = "where the device stands";
    }
    report.refusal = state_.refusal;
    for (const CalibrationPose& pose : state_.poses) {
        if (!state_.result && pose.refusal && !pose.leftOut && !report.refusal) report.refusal = pose.refusal;
        if (!pose.counts() || !pose.pictures) continue;
        report.observations.push_back(*pose.seen);
        report.sights.push_back(pose.pictures->grey);
    }
    if (isOld(state_)) { // then they are not those of the figures
        report.observations.clear();
        report.sights.clear();
    }
    jobs_.run<bool>(
        "report", kPlace, tr("Writing the report"),
        [report = std::move(report), file](const Progress&) {
            const std::string page = reportPage(report);
            if (file.extension() == ".pdf")
                writeReportPdf(page, file);
            else
                writeFileAtomically(file, std::as_bytes(std::span(page)));
            return true;
        },
        [](bool) {});
}

void CalibrationService::importFrom(const std::filesystem::path& file) {
    cancel();
    if (!importTrouble_.isEmpty()) notices_.dismiss(kPlace, importTrouble_);
    importTrouble_.clear();
    KnownSizes sizes;
    const Installation& room = *document_.state().installation;
    if (projector() < room.projectors.size()) {
        const glm::ivec2 installed = room.projectors[projector()].camera.size;
        sizes.projector = {installed.x, installed.y};
    }
    if (!room.cameras.empty()) sizes.camera = {room.cameras.front().camera.size.x, room.cameras.front().camera.size.y};
    jobs_.runWith<CalibrationRecord>(
        "import", kPlace, tr("Reading a calibration"),
        [file, sizes](const Progress&) { return inMillimetres(readCalibration(file, sizes)); },
        [this, file](CalibrationRecord record) { takeImport(file, std::move(record)); },
        [this](const std::exception& error) {
            const Notice notice = noticeOf(error);
            importTrouble_ = notice.subject;
            notices_.post(kPlace, notice);
        });
}

void CalibrationService::takeImport(const std::filesystem::path& file, CalibrationRecord record) {
    forgetPoses();
    clearResults();
    CalibrationResult result;
    result.setup = state_.setup;
    try {
        if (!record.source.board.empty()) result.setup.board = parseCalibrationBoard(record.source.board);
    } catch (const Error&) { // of another program; the board then only names a scale
    }
    result.setup.way = CaptureWay::folder;
    result.setup.folder = file;
    result.isSimulated = record.source.isSimulated;
    result.solved = std::move(record.result);
    result.heldOutMillimetres = heldOutMillimetresOf(result.solved);
    // Other programs write dates in their own way, or none.
    const QDateTime when = QDateTime::fromString(QString::fromStdString(record.source.date), Qt::ISODate);
    if (when.isValid()) result.date = when.toUTC().toString(Qt::ISODate).toStdString();
    const std::vector<std::string> views = tableViewsOf(result.solved);
    state_.flatPose = views.empty() ? std::string() : views.front();
    state_.isImported = true;
    takeResult(std::move(result));
    emit changed();
}

void CalibrationService::use() {
    if (!state_.isSolved()) return;
    const bool asks = state_.result->isSimulated && question_.asks(*document_.state().installation);
    state_.askedBeside = question_.asked();
    if (asks) {
        emit changed();
        return;
    }
    try {
        if (take_(state_, roomOfResult())) {
            if (state_.setup.way == CaptureWay::camera) keepUnfinished(settings_, {});
            state_.trouble.clear();
            followDocument();
        }
    } catch (const std::exception& error) {
        setTrouble(error);
    }
    emit changed();
}

/// Whether the room has the figures of the result, whenever and by whom they were put there.
bool CalibrationService::isInRoom() const {
    if (!state_.result) return false;
    try {
        return hasSameFigures(*document_.state().installation, roomOfResult(),
                              !state_.result->solved.projector.size.empty(),
                              state_.result->solved.projector.size.empty() ? 0 : projector());
    } catch (const Error&) { // told when it is to be used
        return false;
    }
}

/// Undo takes a calibration out of the room, redo puts it back.
void CalibrationService::followDocument() {
    if (isBenchOutdated() && state_.work == CalibrationState::Work::none) return beginAnew();
    const auto& projectors = document_.state().installation->projectors;
    std::string room;
    if (projector() < projectors.size() && projectors[projector()].lens.isCalibrated())
        room = projectors[projector()].lens.date;
    const bool isSimulated = !room.empty() && projectors[projector()].lens.way == Origin::Way::simulated;
    const bool used = isInRoom();
    if (used == state_.isResultInRoom && room == state_.roomDate && isSimulated == state_.isRoomSimulated) return;
    state_.isResultInRoom = used;
    state_.roomDate = room;
    state_.isRoomSimulated = isSimulated;
    emit changed();
}

} // namespace lumorph::studio

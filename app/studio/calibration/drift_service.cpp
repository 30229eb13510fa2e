#include "app/studio/calibration/drift_service.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <tuple>
#include <utility>

#include <QTimer>

#include "calibration/capture/capture_camera.h"
#include "calibration/lab/check_lab.h"
#include "calibration/verify/verify_lab.h"
#include "core/base/error.h"

namespace lumorph::studio {

namespace {

constexpr auto kNoticePlace = "calibrate";
constexpr int kSmallPicture = 640; // pixels across: a watch looks no closer
constexpr int kSmallCamera = 320;

/// A picture of the window as one of a projector's size.
Image sentImage(const QImage& picture, glm::ivec2 size) {
    if (picture.isNull()) return {};
    const QImage scaled = picture.scaled(size.x, size.y, Qt::IgnoreAspectRatio, Qt::SmoothTransformation)
                              .convertToFormat(QImage::Format_RGBA8888);
    Image image(size);
    for (int y = 0; y < size.y; ++y)
        std::copy_n(scaled.constScanLine(y), 4 * static_cast<std::size_t>(size.x),
                    reinterpret_cast<std::uint8_t*>(&image.at(0, y)));
    return image;
}

/// Views of the feed, as long as somebody watches.
class FeedSource : public SentShowSource {
public:
    explicit FeedSource(ShowFeed& feed) : feed_(feed) {}
    ~FeedSource() override { FeedSource::rest(); }
    FeedSource(const FeedSource&) = delete;
    FeedSource& operator=(const FeedSource&) = delete;

    std::optional<SentShow> now() override {
        const DrawnShow& drawn = feed_.newest();
        want(drawn.frame ? drawn.frame->installation->projectors.size() : 1);
        if (!drawn.frame || !drawn.match) return std::nullopt;
        SentShow show{drawn.frame->rig, drawn.frame->installation, {}, drawn.match->commandedStrokes};
        for (const int id : ids_) {
            show.pictures.push_back(feed_.picture(id));
            if (show.pictures.back().isNull()) return std::nullopt; // not drawn yet
        }
        return show;
    }
    void rest() override {
        for (const int id : ids_) feed_.drop(id);
        ids_.clear();
    }

private:
    void want(std::size_t projectors) {
        if (ids_.size() == projectors) return;
        rest();
        for (std::size_t i = 0; i < projectors; ++i) {
            ids_.push_back(feed_.add());
            ShowView view;
            view.kind = ShowView::Kind::projector;
            view.projector = i;
            feed_.want(ids_.back(), view, {kSmallPicture, kSmallPicture});
        }
    }

    ShowFeed& feed_;
    std::vector<int> ids_;
};

} // namespace

std::unique_ptr<SentShowSource> sentShowOf(ShowFeed& feed) { return std::make_unique<FeedSource>(feed); }

ShowCamera labShowCamera(Installation truth) {
    CalibratedCamera& eye = truth.cameras.at(0).camera;
    eye = withSize(eye, {kSmallCamera, kSmallCamera * eye.size.y / std::max(1, eye.size.x)});
    struct Bend {
        std::shared_ptr<const Rig> rig;
        std::vector<double> strokes;
        std::unique_ptr<CheckLab> lab;
    };
    return [truth = std::move(truth), bend = std::make_shared<Bend>()](const ShowLook& look, const SentShow& show,
                                                                       const Progress& progress) {
        if (!bend->lab || bend->rig != show.rig || bend->strokes != show.strokes) {
            CheckLabOptions options;
            options.isLinear = false;
            bend->lab = std::make_unique<CheckLab>(truth, *show.rig, show.strokes, options);
            bend->rig = show.rig;
            bend->strokes = show.strokes;
        }
        progress.throwIfCancelled();
        return bend->lab->photograph(look.sent);
    };
}

ShowCamera machineShowCamera(const std::string& address) {
    auto camera = std::make_shared<std::unique_ptr<CaptureCamera>>();
    return [address, camera](const ShowLook&, const SentShow&, const Progress& progress) {
        if (!*camera) *camera = openCaptureCamera(address);
        try {
            return (*camera)->grab(progress);
        } catch (const DeviceError&) {
            camera->reset(); // plugged in again it is another
            throw;
        }
    };
}

/// The thread of the watch: it takes one picture for each task. Only this thread opens, uses and closes cameras.
class DriftService::Watcher {
public:
    explicit Watcher(DriftService& owner)
        : owner_(owner), thread_([this](const std::stop_token& stop) { run(stop); }) {}

    struct Task {
        int session = 0;
        double seconds = 0.0;
        bool isForDrift = false;
        SentShow show;
        ShowCamera camera; ///< with the first of its session
    };
    void give(Task task) {
        {
            const std::lock_guard lock(mutex_);
            task_ = std::move(task);
        }
        ready_.notify_one();
    }
    /// Starts another session: results of earlier sessions are dropped, and their camera is closed.
    void begin(int session) {
        {
            const std::lock_guard lock(mutex_);
            wanted_ = session;
        }
        ready_.notify_one();
    }

private:
    void run(const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        while (ready_.wait(lock, stop, [this] { return task_ || (camera_ && wanted_ != ofCamera_); })) {
            std::optional<Task> task = std::exchange(task_, std::nullopt);
            const int wanted = wanted_;
            lock.unlock();
            if (wanted != ofCamera_) camera_ = nullptr;
            if (task) perform(*std::move(task), wanted, Progress({}, stop));
            lock.lock();
        }
        lock.unlock();
        camera_ = nullptr;
    }

    void perform(Task task, int wanted, const Progress& progress) {
        std::optional<DriftReport> drift;
        OutputReport output;
        if (task.camera) {
            camera_ = std::move(task.camera);
            ofCamera_ = task.session;
        }
        try {
            if (task.session == wanted) std::tie(drift, output) = look(task, progress);
        } catch (const Cancelled&) {
            return; // the service is at its end
        } catch (const std::exception& error) {
            output = {OutputReport::State::blind, error.what()};
        }
        QMetaObject::invokeMethod(
            &owner_, [&owner = owner_, session = task.session, drift, output] { owner.take(session, drift, output); },
            Qt::QueuedConnection);
    }

    std::pair<std::optional<DriftReport>, OutputReport> look(const Task& task, const Progress& progress) {
        const bool isOther = task.session != session_ || rig_ != task.show.rig || room_ != task.show.room;
        if (isOther) begin(task);
        ShowLook look{task.seconds, {}, {}, {}};
        for (std::size_t i = 0; i < room_->projectors.size(); ++i) {
            progress.throwIfCancelled();
            look.sent.push_back(i < task.show.pictures.size()
                                    ? sentImage(task.show.pictures[i], room_->projectors[i].camera.size)
                                    : Image());
        }
        look.strokes = standingStrokes(*room_, *rig_, task.show.strokes, StrokesFrom::anywhere);
        try {
            look.photograph = camera_(look, task.show, progress);
        } catch (const Cancelled&) {
            throw;
        } catch (const std::exception&) {
            look.photograph.release(); // both watches say that the camera gives nothing
        }
        std::optional<DriftReport> drift;
        if (task.isForDrift) drift = drift_->look(look, progress);
        return {drift, output_->look(look, progress)};
    }

    void begin(const Task& task) {
        const Installation room = withLabCamera(*task.show.room);
        drift_ = std::make_unique<DriftWatch>(*task.show.rig, room);
        output_ = std::make_unique<OutputWatch>(*task.show.rig, room);
        session_ = task.session; // last: what could not be begun is tried again
        rig_ = task.show.rig;
        room_ = task.show.room;
    }

    DriftService& owner_;
    ShowCamera camera_; ///< the thread's, as all that follows up to the mutex
    int ofCamera_ = -1; ///< its session
    int session_ = -1;
    std::shared_ptr<const Rig> rig_;
    std::shared_ptr<const Installation> room_;
    std::unique_ptr<DriftWatch> drift_;
    std::unique_ptr<OutputWatch> output_;
    std::mutex mutex_; ///< of what follows
    std::condition_variable_any ready_;
    std::optional<Task> task_;
    int wanted_ = 0;      ///< session
    std::jthread thread_; ///< last: it uses the rest
};

DriftService::DriftService(std::unique_ptr<SentShowSource> show, ShowCameraChooser choose, Notices& notices,
                           std::function<void()> check, QObject* parent)
    : QObject(parent), show_(std::move(show)), choose_(std::move(choose)), notices_(notices), check_(std::move(check)),
      timer_(new QTimer(this)), watcher_(std::make_unique<Watcher>(*this)) {
    clock_.start();
    timer_->setInterval(kLookMilliseconds);
    connect(timer_, &QTimer::timeout, this, [this] { look(1e-3 * static_cast<double>(clock_.elapsed())); });
}

DriftService::~DriftService() = default;

bool DriftService::isWatching() const noexcept { return timer_->isActive(); }

void DriftService::setWatching(bool on) {
    watcher_->begin(++session_); // results of earlier looks are dropped
    looks_ = 0;
    drift_ = {};
    output_ = {};
    tell();
    on ? timer_->start() : timer_->stop();
    if (!on) show_->rest();
    camera_ = nullptr; // never opened
    if (on) choose();
    emit changed();
}

void DriftService::choose() {
    if (std::exchange(chosen_, session_) != session_) camera_ = choose_();
}

void DriftService::look(double seconds) {
    if (isLooking_) return;
    std::optional<SentShow> show = show_->now();
    if (!show || !show->rig || !show->room || show->room->projectors.empty()) return;
    isLooking_ = true;
    choose();
    watcher_->give(
        {session_, seconds, looks_++ % kLooksADrift == 0, std::move(*show), std::exchange(camera_, nullptr)});
}

void DriftService::take(int session, std::optional<DriftReport> drift, OutputReport output) {
    isLooking_ = false;
    if (session != session_) return;
    if (drift) drift_ = std::move(*drift);
    output_ = std::move(output);
    tell();
    emit changed();
}

void DriftService::tell() {
    const bool isDark = output_.state == OutputReport::State::black || output_.state == OutputReport::State::frozen;
    post(isDark, Notice::Level::error, tr("Output of the projector"), output_.sentence,
         tr("see to it, then check the room"));
    post(drift_.state == DriftReport::State::moved, Notice::Level::warning, tr("Calibration of the room"),
         drift_.sentence, tr("a check takes a minute, and gives the correction"));
}

void DriftService::post(bool isThere, Notice::Level level, const QString& subject, const std::string& why,
                        const QString& remedy) {
    if (!isThere) {
        if (told_.erase(subject) > 0) notices_.dismiss(kNoticePlace, subject);
        return;
    }
    if (told_.contains(subject)) return; // said once; millimetres that tremble are no news
    told_[subject] = why;
    Notice notice;
    notice.level = level;
    notice.subject = subject;
    notice.why = QString::fromStdString(why);
    notice.remedy = remedy;
    notice.actions = {{tr("Check the room"), check_}};
    notices_.post(kNoticePlace, std::move(notice));
}

} // namespace lumorph::studio

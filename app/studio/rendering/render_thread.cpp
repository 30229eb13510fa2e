#include "app/studio/rendering/render_thread.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <vector>

#include <QTimer>

#include "app/studio/rendering/frame_drawer.h"
#include "app/studio/rendering/gl_thread.h"
#include "app/studio/rendering/show_drawer.h"
#include "core/base/error.h"
#include "core/base/image.h"

namespace lumorph::studio {
namespace {

using Clock = std::chrono::steady_clock;

struct PictureJob {
    FrameRequest request;
    std::function<void(QImage, QString)> done;
};

QString reasonOf(const std::exception& error) { return QString::fromUtf8(error.what()); }

/// After a frame of the show failed, frames are left out for so long: making the renderer anew takes time.
constexpr std::chrono::seconds kShowPause{1};

/// How long after the driver's reset, and after each attempt that failed, drawing is begun anew.
constexpr std::chrono::seconds kAnew{1};

/// The longest rest between two frames; the window still follows what its user does.
constexpr std::chrono::milliseconds kLongestRest{250};

struct ContextLost {};

QString resetReason() {
    return QStringLiteral("The graphics driver was reset. Drawing begins anew by itself; if this comes again and "
                          "again, update the driver, or start Lumorph with LIBGL_ALWAYS_SOFTWARE=1.");
}

} // namespace

struct RenderThread::Data {
    explicit Data(RenderThread& whole) : owner(whole) {
        again.setSingleShot(true);
        QObject::connect(&again, &QTimer::timeout, &owner, [this] { startAnew(); });
    }

    bool stillQuality = true; // the window thread's alone

    /// In the render thread, the context being current.
    struct Drawers {
        FrameDrawer frames;
        ShowDrawer show;
    };

    // In the render thread:
    void run();
    void serve();
    void tell(std::optional<QString> why);
    void step(Drawers& drawers, std::unique_lock<std::mutex>& lock);
    [[nodiscard]] bool showIsNext() const;
    /// Draw or collect; what is thrown becomes a complaint.
    void serveFrames(const std::function<void()>& draw);
    void serveShow(const std::function<void()>& draw);
    void deliverShow(const ShowPace::Work& work, DrawnShow frame);
    void drawFrame(FrameDrawer& drawer, const FrameSchedule::Work& work);
    void drawPicture(FrameDrawer& drawer, const PictureJob& job);
    void deliver(const FrameSchedule::Work& work, DrawnFrame frame);
    void sleep(std::unique_lock<std::mutex>& lock);
    /// After a frame that took so long, as `share` demands.
    void rest(std::unique_lock<std::mutex>& lock, Clock::duration took);
    /// Throws ContextLost; what was drawn until then is worth nothing.
    void checkContext() const;
    void count(const Drawers& drawers);
    bool shallGiveUp() {
        const std::lock_guard lock(mutex);
        return stop || pressing();
    }
    [[nodiscard]] bool pressing() const { return schedule.pressing() || pace.pressing(); }

    void fail(const QString& why); ///< after a reset it is tried again
    void failLost();

    // In the window's thread:
    void start();
    void startAnew();

    RenderThread& owner;
    mutable std::mutex mutex;
    std::condition_variable wake;
    // Guarded by the mutex.
    FrameSchedule schedule;
    std::deque<PictureJob> pictures;
    std::map<int, DrawnFrame> frames;
    std::vector<int> forgotten;
    ShowPace pace;
    std::optional<DrawnShow> shown;
    Clock::time_point showAgain; ///< after it failed
    bool showsTurn = true;       ///< viewports and the show take turns
    double share = 1.0;          ///< of its time that may go into drawing
    std::optional<QString> failure;
    bool stop = false;

    std::atomic<std::size_t> objects{0};
    std::atomic<std::size_t> errors{0};
    std::atomic<bool> lost{false}; ///< by a reset, until drawing goes on
    QTimer again;                  ///< of the window's thread
    GlDriver driver;               ///< of the render thread only
    QString lastComplaint;         ///< likewise
    QString lastShowComplaint;     ///< likewise
    std::unique_ptr<GlThread> thread;
};

void RenderThread::Data::start() {
    // The thread before has to be gone: it may still speak of its failure.
    thread.reset();
    failure.reset();
    thread = std::make_unique<GlThread>([this] { run(); }, [this](const QString& why) { fail(why); });
}

void RenderThread::Data::fail(const QString& why) {
    tell(why);
    if (lost)
        QMetaObject::invokeMethod(
            &owner, [this] { again.start(kAnew); }, Qt::QueuedConnection);
}

void RenderThread::Data::tell(std::optional<QString> why) {
    {
        const std::lock_guard lock(mutex);
        failure = std::move(why);
    }
    // In the window's thread: whoever connects right after making a RenderThread receives it, however fast the driver
    // is.
    QMetaObject::invokeMethod(
        &owner, [this] { emit owner.ready(); }, Qt::QueuedConnection);
}

// A show that runs all day comes back by itself.
void RenderThread::Data::startAnew() {
    if (lost && owner.failure()) start();
}

void RenderThread::Data::run() {
    try {
        serve();
    } catch (const ContextLost&) {
        failLost();
    } catch (const std::exception& error) {
        // A reset is often noticed by what waits for the card.
        if (contextLost(driver))
            failLost();
        else
            fail(reasonOf(error));
    }
}

void RenderThread::Data::failLost() {
    lost = true;
    fail(resetReason());
}

void RenderThread::Data::serve() {
    tell(std::nullopt);
    driver = currentDriver();
    Drawers drawers{
        {driver, [this](const FrameSchedule::Work& work, DrawnFrame frame) { deliver(work, std::move(frame)); }},
        {driver, [this](const ShowPace::Work& work, DrawnShow frame) { deliverShow(work, std::move(frame)); }}};
    std::unique_lock lock(mutex);
    while (!stop) step(drawers, lock);
}

bool RenderThread::Data::showIsNext() const { return pace.pressing() && (showsTurn || !schedule.pressing()); }

void RenderThread::Data::step(Drawers& drawers, std::unique_lock<std::mutex>& lock) {
    for (const int viewport : std::exchange(forgotten, {})) drawers.frames.forget(viewport);
    const auto now = Clock::now();
    // Frames on the screen come before pictures, those before full quality.
    if (!pressing() && !pictures.empty()) {
        const PictureJob job = std::move(pictures.front());
        pictures.pop_front();
        lock.unlock();
        drawPicture(drawers.frames, job);
    } else if (const auto show = showIsNext() ? pace.nextMoving() : std::nullopt) {
        showsTurn = false;
        lock.unlock();
        serveShow([&] { drawers.show.draw(*show); });
        // The show may go on without a pause: what viewports have begun is not to wait for one.
        serveFrames([&] { drawers.frames.collect(); });
    } else if (const auto work = schedule.next(now)) {
        showsTurn = true;
        lock.unlock();
        drawFrame(drawers.frames, *work);
        serveShow([&] { drawers.show.collect(); });
    } else if (const auto still = pace.nextStill(now)) {
        lock.unlock();
        serveShow([&] { drawers.show.draw(*still); });
    } else {
        lock.unlock();
        serveFrames([&] { drawers.frames.collect(); });
        serveShow([&] { drawers.show.collect(); });
        count(drawers);
        lock.lock();
        sleep(lock);
        return;
    }
    count(drawers);
    lock.lock();
    rest(lock, Clock::now() - now);
}

void RenderThread::Data::rest(std::unique_lock<std::mutex>& lock, Clock::duration took) {
    if (share < 1.0)
        wake.wait_for(lock,
                      std::min<Clock::duration>(
                          kLongestRest, std::chrono::duration_cast<Clock::duration>(took * (1.0 / share - 1.0))),
                      [this] { return stop || !pictures.empty(); });
}

void RenderThread::Data::sleep(std::unique_lock<std::mutex>& lock) {
    const auto wanted = [&] { return stop || pressing() || !pictures.empty() || !forgotten.empty(); };
    auto until = schedule.nextAt();
    if (const auto still = pace.stillAt()) until = until ? std::min(*until, *still) : *still;
    if (until)
        wake.wait_until(lock, *until, wanted);
    else
        wake.wait(lock, wanted);
}

void RenderThread::Data::serveFrames(const std::function<void()>& draw) {
    try {
        draw();
    } catch (const std::exception& error) {
        checkContext();
        const QString why = reasonOf(error);
        if (why != std::exchange(lastComplaint, why)) emit owner.broke(why);
    }
}

void RenderThread::Data::serveShow(const std::function<void()>& draw) {
    try {
        draw();
    } catch (const std::exception& error) {
        checkContext();
        const QString why = reasonOf(error);
        {
            const std::lock_guard lock(mutex);
            showAgain = Clock::now() + kShowPause;
            pace.forget();
        }
        if (why != std::exchange(lastShowComplaint, why)) emit owner.showBroke(why);
    }
}

void RenderThread::Data::deliverShow(const ShowPace::Work& work, DrawnShow frame) {
    checkContext();
    lastShowComplaint.clear();
    const std::lock_guard lock(mutex);
    pace.finished(work, frame.ms.total);
    // Told once for all frames that wait to be taken.
    const bool told = shown.has_value();
    shown = std::move(frame);
    if (!told) emit owner.showDrawn();
}

void RenderThread::Data::drawFrame(FrameDrawer& drawer, const FrameSchedule::Work& work) {
    serveFrames([&] {
        if (drawer.draw(work, [this] { return shallGiveUp(); })) return;
        const std::lock_guard lock(mutex);
        schedule.givenUp(work);
    });
}

void RenderThread::Data::drawPicture(FrameDrawer& drawer, const PictureJob& job) {
    QImage image;
    QString why;
    try {
        image = drawer.picture(job.request);
    } catch (const std::exception& error) {
        why = reasonOf(error);
    }
    const bool gone = contextLost(driver);
    if (gone) {
        image = {};
        why = resetReason();
    }
    QMetaObject::invokeMethod(
        &owner, [done = job.done, image, why] { done(image, why); }, Qt::QueuedConnection);
    if (gone) throw ContextLost{};
}

void RenderThread::Data::deliver(const FrameSchedule::Work& work, DrawnFrame frame) {
    checkContext();
    lastComplaint.clear();
    const std::lock_guard lock(mutex);
    schedule.finished(work, frame.milliseconds);
    if (!schedule.knows(work.viewport)) return;
    // Told once for all frames that wait to be taken.
    const bool told = !frames.insert_or_assign(work.viewport, std::move(frame)).second;
    if (!told) emit owner.drawn(work.viewport);
}

void RenderThread::Data::checkContext() const {
    if (contextLost(driver)) throw ContextLost{};
}

void RenderThread::Data::count(const Drawers& drawers) {
    checkContext();
    lost = false;
    objects = drawers.frames.objectCount() + drawers.show.objectCount();
    errors += FrameDrawer::takeErrors();
}

RenderThread::RenderThread(QObject* parent) : QObject(parent), data_(std::make_unique<Data>(*this)) { data_->start(); }

RenderThread::~RenderThread() {
    {
        const std::lock_guard lock(data_->mutex);
        data_->stop = true;
    }
    data_->wake.notify_all();
    data_->thread.reset();
}

std::optional<QString> RenderThread::failure() const {
    const std::lock_guard lock(data_->mutex);
    return data_->failure;
}

void RenderThread::retry() {
    if (failure()) data_->start();
}

int RenderThread::newViewport() { return ++viewports_; }

void RenderThread::setStillQuality(bool on) { data_->stillQuality = on; }

void RenderThread::request(int viewport, FrameRequest request) {
    if (!request.scene || request.pixels.isEmpty()) return;
    request.refine = request.refine && data_->stillQuality;
    request.pixels = request.pixels.boundedTo({kMaxImageSide, kMaxImageSide});
    {
        const std::lock_guard lock(data_->mutex);
        data_->schedule.request(viewport, std::move(request), Clock::now());
    }
    data_->wake.notify_one();
}

void RenderThread::setShare(double share) {
    const std::lock_guard lock(data_->mutex);
    data_->share = std::clamp(share, 0.01, 1.0);
}

void RenderThread::forget(int viewport) {
    {
        const std::lock_guard lock(data_->mutex);
        data_->schedule.forget(viewport);
        data_->frames.erase(viewport);
        data_->forgotten.push_back(viewport);
    }
    data_->wake.notify_one();
}

void RenderThread::picture(FrameRequest request, std::function<void(QImage, QString)> done) {
    QString refused;
    if (const auto why = failure())
        refused = *why;
    else if (!request.scene)
        refused = QStringLiteral("There is nothing to draw yet.");
    if (!refused.isEmpty()) {
        QMetaObject::invokeMethod(
            this, [done = std::move(done), refused] { done({}, refused); }, Qt::QueuedConnection);
        return;
    }
    {
        const std::lock_guard lock(data_->mutex);
        data_->pictures.push_back({std::move(request), std::move(done)});
    }
    data_->wake.notify_one();
}

void RenderThread::requestShow(ShowRequest request) {
    std::erase_if(request.views, [](const WantedView& wanted) { return wanted.pixels.isEmpty(); });
    for (WantedView& wanted : request.views) wanted.pixels = wanted.pixels.boundedTo({kMaxImageSide, kMaxImageSide});
    request.refine = request.refine && data_->stillQuality;
    const bool nothing = request.views.empty() || !request.match || !request.match->scene || !request.match->assets;
    {
        const std::lock_guard lock(data_->mutex);
        if (nothing) {
            data_->pace.forget();
            data_->shown.reset();
        } else if (Clock::now() >= data_->showAgain) {
            data_->pace.request(std::move(request), Clock::now());
        }
    }
    data_->wake.notify_one();
}

std::optional<DrawnShow> RenderThread::takeShow() {
    const std::lock_guard lock(data_->mutex);
    return std::exchange(data_->shown, std::nullopt);
}

std::size_t RenderThread::objectCount() const { return data_->objects; }
std::size_t RenderThread::errorCount() const { return data_->errors; }

std::optional<DrawnFrame> RenderThread::takeFrame(int viewport) {
    const std::lock_guard lock(data_->mutex);
    const auto found = data_->frames.find(viewport);
    if (found == data_->frames.end()) return std::nullopt;
    DrawnFrame frame = std::move(found->second);
    data_->frames.erase(found);
    return frame;
}

} // namespace lumorph::studio

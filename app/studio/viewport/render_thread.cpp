#include "app/studio/viewport/render_thread.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <vector>

#include "app/studio/viewport/frame_drawer.h"
#include "app/studio/viewport/gl_thread.h"
#include "core/base/error.h"
#include "core/render/image.h"

namespace lumorph::studio {
namespace {

using Clock = std::chrono::steady_clock;

struct PictureJob {
    FrameRequest request;
    std::function<void(QImage, QString)> done;
};

QString reasonOf(const std::exception& error) { return QString::fromUtf8(error.what()); }

} // namespace

struct RenderThread::Data {
    explicit Data(RenderThread& whole) : owner(whole) {}

    bool stillQuality = true; // the window thread's alone

    // In the render thread:
    void run();
    void serve();
    void tell(std::optional<QString> why);
    void step(FrameDrawer& drawer, std::unique_lock<std::mutex>& lock);
    void drawFrame(FrameDrawer& drawer, const FrameSchedule::Work& work);
    void drawPicture(FrameDrawer& drawer, const PictureJob& job);
    void deliver(const FrameSchedule::Work& work, DrawnFrame frame);
    void sleep(std::unique_lock<std::mutex>& lock);
    void complain(const QString& why);
    void count(const FrameDrawer& drawer);
    bool shallGiveUp() {
        const std::lock_guard lock(mutex);
        return stop || schedule.pressing();
    }

    void start(); ///< in the window's thread

    RenderThread& owner;
    mutable std::mutex mutex;
    std::condition_variable wake;
    // Guarded by the mutex.
    FrameSchedule schedule;
    std::deque<PictureJob> pictures;
    std::map<int, DrawnFrame> frames;
    std::vector<int> forgotten;
    std::optional<QString> failure;
    bool stop = false;

    std::atomic<std::size_t> objects{0};
    std::atomic<std::size_t> errors{0};
    QString lastComplaint; ///< of the render thread only
    std::unique_ptr<GlThread> thread;
};

void RenderThread::Data::start() {
    // The thread before has to be gone: it may still speak of its failure.
    thread.reset();
    thread = std::make_unique<GlThread>([this] { run(); }, [this](const QString& why) { tell(why); });
}

void RenderThread::Data::tell(std::optional<QString> why) {
    {
        const std::lock_guard lock(mutex);
        failure = std::move(why);
    }
    emit owner.ready();
}

void RenderThread::Data::run() {
    try {
        serve();
    } catch (const std::exception& error) {
        tell(reasonOf(error));
    }
}

void RenderThread::Data::serve() {
    tell(std::nullopt);
    FrameDrawer drawer(currentDriver(),
                       [this](const FrameSchedule::Work& work, DrawnFrame frame) { deliver(work, std::move(frame)); });
    std::unique_lock lock(mutex);
    while (!stop) step(drawer, lock);
}

void RenderThread::Data::step(FrameDrawer& drawer, std::unique_lock<std::mutex>& lock) {
    for (const int viewport : std::exchange(forgotten, {})) drawer.forget(viewport);
    // Frames on the screen come before pictures, those before full quality.
    if (!schedule.pressing() && !pictures.empty()) {
        const PictureJob job = std::move(pictures.front());
        pictures.pop_front();
        lock.unlock();
        drawPicture(drawer, job);
    } else if (const auto work = schedule.next(Clock::now())) {
        lock.unlock();
        drawFrame(drawer, *work);
    } else {
        lock.unlock();
        drawer.collect();
        count(drawer);
        lock.lock();
        sleep(lock);
        return;
    }
    count(drawer);
    lock.lock();
}

void RenderThread::Data::sleep(std::unique_lock<std::mutex>& lock) {
    const auto wanted = [&] { return stop || schedule.pressing() || !pictures.empty() || !forgotten.empty(); };
    if (const auto until = schedule.nextAt())
        wake.wait_until(lock, *until, wanted);
    else
        wake.wait(lock, wanted);
}

void RenderThread::Data::drawFrame(FrameDrawer& drawer, const FrameSchedule::Work& work) {
    try {
        if (drawer.draw(work, [this] { return shallGiveUp(); })) return;
        const std::lock_guard lock(mutex);
        schedule.givenUp(work);
    } catch (const std::exception& error) {
        complain(reasonOf(error));
    }
}

void RenderThread::Data::drawPicture(FrameDrawer& drawer, const PictureJob& job) {
    QImage image;
    QString why;
    try {
        image = drawer.picture(job.request);
    } catch (const std::exception& error) {
        why = reasonOf(error);
    }
    QMetaObject::invokeMethod(
        &owner, [done = job.done, image, why] { done(image, why); }, Qt::QueuedConnection);
}

void RenderThread::Data::deliver(const FrameSchedule::Work& work, DrawnFrame frame) {
    lastComplaint.clear();
    const std::lock_guard lock(mutex);
    schedule.finished(work, frame.milliseconds);
    if (!schedule.knows(work.viewport)) return;
    // Told once for all frames that wait to be taken.
    const bool told = !frames.insert_or_assign(work.viewport, std::move(frame)).second;
    if (!told) emit owner.drawn(work.viewport);
}

void RenderThread::Data::complain(const QString& why) {
    if (why == lastComplaint) return;
    lastComplaint = why;
    emit owner.broke(why);
}

void RenderThread::Data::count(const FrameDrawer& drawer) {
    objects = drawer.objectCount();
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

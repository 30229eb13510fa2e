#include "app/workspaces/field/fit_certificate.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <utility>

#include "core/base/thread_priority.h"
#include "core/mdf/placement.h"
#include "core/mdf/refine.h"

namespace lumorph::studio {

namespace {

constexpr int kRestMilliseconds = 400;
constexpr Microseconds kSlice{50'000};        ///< between looks at whether it is still wanted
constexpr Microseconds kReportEvery{200'000}; ///< between two bounds that are shown
constexpr Microseconds kLongest{30'000'000};
constexpr Microseconds kLongestBetween{5'000'000}; ///< for strokes between the levels

/// As the loop has them.
BitColumns voxelsOf(const MatchFrame& frame) {
    Target placed;
    placePoints(*frame.targetPositions, frame.deviceFromTarget, placed.mesh.positions);
    placed.mesh.triangles = frame.target->solid.mesh.triangles;
    placed.closed = frame.target->solid.closed;
    BitColumns bits;
    if (frame.relief && frame.field->relief) {
        voxelizeRelief(*frame.field->relief, placed.mesh.positions, placed.mesh.triangles, bits);
    } else {
        SolidVoxelizer voxelizer;
        voxelizeTarget(frame.field->field.frame, placed, voxelizer, bits);
    }
    return bits;
}

} // namespace

/// Its thread and the newest question.
class FitCertificate::Worker {
public:
    /// `tell` runs in the worker's thread, with the frame that was asked about.
    explicit Worker(std::function<void(const std::shared_ptr<const MatchFrame>&, const Known&)> tell)
        : tell_(std::move(tell)), thread_([this](const std::stop_token& stop) { run(stop); }) {}
    ~Worker() {
        thread_.request_stop();
        ask({});
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Empty: it rests.
    void ask(std::shared_ptr<const MatchFrame> frame) {
        {
            const std::lock_guard lock(mutex_);
            asked_ = std::move(frame);
            unwanted_.request_stop();
        }
        wake_.notify_one();
    }

private:
    void run(const std::stop_token& stop) {
        giveWayToOthers();
        while (true) {
            std::shared_ptr<const MatchFrame> frame;
            std::stop_token unwanted;
            {
                std::unique_lock lock(mutex_);
                wake_.wait(lock, stop, [this] { return asked_ != nullptr; });
                if (stop.stop_requested()) return;
                frame = std::exchange(asked_, nullptr);
                unwanted_ = {};
                unwanted = unwanted_.get_token();
            }
            certify(frame, unwanted);
        }
    }

    void certify(const std::shared_ptr<const MatchFrame>& frame, const std::stop_token& unwanted) {
        try {
            Certifier certifier(frame->field->coverage, {.oneThread = true});
            BitColumns target = voxelsOf(*frame);
            certifier.start(target, frame->wanted);
            const SteadyClock clock;
            const Microseconds end = clock.now() + kLongest;
            Microseconds told = clock.now();
            Known known;
            while (!known.certificate.done && clock.now() < end) {
                known.certificate = certifier.tighten(kSlice, clock, unwanted);
                if (unwanted.stop_requested()) return;
                if (!known.certificate.done && clock.now() < told + kReportEvery) continue;
                told = clock.now();
                tell_(frame, known);
            }
            target &= frame->field->coverage.domain();
            const Microseconds last = clock.now() + kLongestBetween;
            known.betweenLevels = iouBetweenLevels(frame->field->coverage, target, known.certificate.best,
                                                   [&] { return unwanted.stop_requested() || clock.now() >= last; });
            if (!unwanted.stop_requested()) tell_(frame, known);
        } catch (const std::exception&) { // no bound is shown then
        }
    }

    std::function<void(const std::shared_ptr<const MatchFrame>&, const Known&)> tell_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::shared_ptr<const MatchFrame> asked_;
    std::stop_source unwanted_;
    std::jthread thread_; // the last: it uses the others
};

FitCertificate::FitCertificate(StudioLoop& loop) : loop_(loop) {
    still_.setSingleShot(true);
    still_.setInterval(kRestMilliseconds);
    connect(&still_, &QTimer::timeout, this, &FitCertificate::begin);
    connect(&loop, &StudioLoop::framed, this, &FitCertificate::look);
}

FitCertificate::~FitCertificate() = default;

void FitCertificate::setActive(bool active) {
    if (std::exchange(active_, active) == active) return;
    if (!active) forget();
    look();
}

void FitCertificate::look() {
    const auto& frame = loop_.frame();
    Question now;
    if (active_ && frame && frame->matched && frame->driver != Driver::program && frame->target && frame->field &&
        frame->targetPositions && frame->wanted.size() == frame->field->coverage.rig().actuatorCount())
        now = {frame->field, frame->target, frame->targetPositions, frame->deviceFromTarget, frame->relief};
    if (now == asked_) return;
    forget();
    asked_ = std::move(now);
    if (asked_.field) still_.start();
}

void FitCertificate::forget() {
    still_.stop();
    asked_ = {};
    if (worker_) worker_->ask({});
    if (!std::exchange(known_, std::nullopt)) return;
    emit changed();
}

void FitCertificate::begin() {
    const auto& frame = loop_.frame();
    if (!worker_)
        worker_ = std::make_unique<Worker>([this](const std::shared_ptr<const MatchFrame>& of, const Known& found) {
            QMetaObject::invokeMethod(
                this,
                [this, of, found] {
                    if (Question{of->field, of->target, of->targetPositions, of->deviceFromTarget, of->relief} !=
                        asked_)
                        return;
                    known_ = found;
                    emit changed();
                },
                Qt::QueuedConnection);
        });
    worker_->ask(frame);
}

QString certificateText(const std::optional<FitCertificate::Known>& known, double iou) {
    constexpr double kTells = 0.995; // a bound of 1 says nothing
    constexpr double kLost = 0.005;
    if (!known) return {};
    const Certificate& certificate = known->certificate;
    // Rounded up: what is said holds.
    const auto up = [](double value) {
        return QString::number(std::clamp(std::ceil(100.0 * value - 1e-9) / 100.0, 0.0, 1.0), 'f', 2);
    };
    if (certificate.upperBound > kTells && !certificate.done && !known->betweenLevels)
        return FitCertificate::tr("Looking for how much better it could be...");
    const double gap = certificate.upperBound - iou;
    QString text =
        gap <= 1e-9
            ? FitCertificate::tr("No state of this device fits better.")
            : FitCertificate::tr("At most %1 from the best possible: no state of this device reaches more than %2.")
                  .arg(up(gap), up(certificate.upperBound));
    const double lost = known->betweenLevels ? *known->betweenLevels - certificate.quality.iou() : 0.0;
    if (lost > kLost) text += " " + FitCertificate::tr("%1 are lost to the steps between levels.").arg(lost, 0, 'f', 2);
    return text;
}

} // namespace lumorph::studio

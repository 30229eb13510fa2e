#include "app/studio/output/pattern_screen.h"

#include <condition_variable>
#include <mutex>
#include <string>

#include <QPointer>

#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr std::chrono::milliseconds kLookAgain{20};
constexpr std::chrono::seconds kMostWaiting{5};

QImage imageOf(const cv::Mat& picture) {
    const auto format = picture.channels() == 1 ? QImage::Format_Grayscale8 : QImage::Format_BGR888;
    return QImage(picture.data, picture.cols, picture.rows, static_cast<qsizetype>(picture.step), format)
        .convertToFormat(QImage::Format_RGB32);
}

} // namespace

/// What both threads know.
struct PatternScreen::Shared {
    std::mutex mutex;
    std::condition_variable changed;
    quint64 wanted = 0, shown = 0; ///< tickets
    std::string problem;           ///< why nothing can be shown any more
    std::string subject;
    cv::Size size;
};

/// The window's thread.
class PatternScreen::Receiver : public QObject {
public:
    Receiver(std::shared_ptr<Shared> shared, ProjectorWindow& window) : shared_(std::move(shared)), window_(&window) {
        connect(&window, &ProjectorWindow::calibrationShown, this, [this](quint64 ticket) {
            const std::scoped_lock lock(shared_->mutex);
            shared_->shown = std::max(shared_->shown, ticket);
            shared_->changed.notify_all();
        });
        const auto gone = [this] { tell(tr("its window was closed: open it again").toStdString()); };
        connect(&window, &ProjectorWindow::closed, this, gone);
        connect(&window, &QObject::destroyed, this, gone);
    }
    ~Receiver() override { put({}, 0); }

    void put(const QImage& picture, quint64 ticket) {
        if (!window_ && !picture.isNull()) tell(tr("its window was closed: open it again").toStdString());
        if (!window_) return;
        if (!picture.isNull())
            if (const QString problem = window_->calibrationProblem(); !problem.isEmpty()) {
                tell(problem.toStdString());
                return;
            }
        window_->setCalibrationPicture(picture, ticket);
    }

private:
    void tell(std::string problem) {
        const std::scoped_lock lock(shared_->mutex);
        shared_->problem = std::move(problem);
        shared_->changed.notify_all();
    }

    std::shared_ptr<Shared> shared_;
    QPointer<ProjectorWindow> window_;
};

PatternScreen::PatternScreen(ProjectorOutputs& outputs, std::size_t projector) : shared_(std::make_shared<Shared>()) {
    shared_->subject = "projector " + std::to_string(projector + 1);
    ProjectorWindow* window = outputs.window(projector);
    if (window == nullptr)
        throw DeviceError(shared_->subject, "its picture is not shown", "open it on the projector's screen");
    if (const QString problem = window->calibrationProblem(); !problem.isEmpty())
        throw DeviceError(shared_->subject, "cannot show patterns pixel by pixel", problem.toStdString());
    shared_->size = {window->projectorSize().width(), window->projectorSize().height()};
    receiver_ = std::make_unique<Receiver>(shared_, *window);
}

PatternScreen::~PatternScreen() = default;

cv::Size PatternScreen::size() const { return shared_->size; }

void PatternScreen::show(const cv::Mat& picture, const Progress& progress) {
    checkPicture(picture, shared_->size);
    std::unique_lock lock(shared_->mutex);
    shared_->problem.clear();
    const quint64 ticket = ++shared_->wanted;
    QMetaObject::invokeMethod(
        receiver_.get(),
        [receiver = receiver_.get(), image = imageOf(picture), ticket] { receiver->put(image, ticket); },
        Qt::QueuedConnection);
    const auto until = std::chrono::steady_clock::now() + kMostWaiting;
    while (shared_->shown < ticket) {
        if (!shared_->problem.empty())
            throw DeviceError(shared_->subject, "a pattern cannot be shown", shared_->problem);
        progress.throwIfCancelled();
        if (std::chrono::steady_clock::now() > until)
            throw DeviceError(shared_->subject, "a pattern does not come to the screen",
                              "see that its window is not covered, minimised or on another desktop");
        shared_->changed.wait_for(lock, kLookAgain);
    }
}

void PatternScreen::clear() {
    QMetaObject::invokeMethod(
        receiver_.get(), [receiver = receiver_.get()] { receiver->put({}, 0); }, Qt::QueuedConnection);
}

} // namespace lumorph::studio

#include "app/studio/base/jobs.h"

#include <atomic>
#include <mutex>
#include <utility>

#include <QElapsedTimer>
#include <QTimer>

#include "core/base/thread_priority.h"

namespace lumorph::studio {

namespace {

constexpr qint64 kReportMilliseconds = 33;

} // namespace

struct Jobs::Job {
    Status status;
    std::function<void(std::any)> done;
    std::function<void(const std::exception&)> failed;
    bool cancelled = false;
    QElapsedTimer sinceReport;

    /// What the worker says about itself; read in the window's thread.
    struct Said {
        std::mutex mutex;
        double fraction = 0.0;
        std::string stage;
        std::atomic<bool> posted = false;
    };
    std::shared_ptr<Said> said = std::make_shared<Said>();
    std::jthread thread; ///< last, so that it has ended before the rest goes
};

Jobs::Jobs(QObject* parent) : QObject(parent) {}

Jobs::~Jobs() {
    // All are asked to stop before the first is waited for.
    for (auto& [id, job] : jobs_) job->thread.request_stop();
    jobs_.clear();
}

Jobs::Id Jobs::start(const QString& place, const QString& title, std::function<std::any(const Progress&)> work,
                     std::function<void(std::any)> done, std::function<void(const std::exception&)> failed) {
    for (const Status& status : running())
        if (status.place == place && status.title == title) cancel(status.id);
    const Id id = next_++;
    auto job = std::make_unique<Job>();
    job->status = {id, title, place, 0.0, {}};
    job->done = std::move(done);
    job->failed = std::move(failed);
    Job& started = *jobs_.emplace(id, std::move(job)).first->second;
    const auto report = [this, id, said = started.said](double fraction, std::string_view stage) {
        {
            const std::scoped_lock lock(said->mutex);
            said->fraction = fraction;
            said->stage = stage;
        }
        if (!said->posted.exchange(true)) QMetaObject::invokeMethod(this, [this, id] { poll(id); });
    };
    started.thread = std::jthread([this, id, report, work = std::move(work)](const std::stop_token& stop) {
        giveWayToOthers(); // the window comes first
        std::any result;
        std::exception_ptr error;
        try {
            result = work(Progress(report, stop));
        } catch (...) {
            error = std::current_exception();
        }
        QMetaObject::invokeMethod(
            this, [this, id, result = std::move(result), error]() mutable { end(id, std::move(result), error); },
            Qt::QueuedConnection);
    });
    emit this->started(id);
    return id;
}

void Jobs::poll(Id id) {
    const auto found = jobs_.find(id);
    if (found == jobs_.end() || found->second->cancelled) return;
    Job& job = *found->second;
    const qint64 wait = job.sinceReport.isValid() ? kReportMilliseconds - job.sinceReport.elapsed() : 0;
    if (wait > 0) { // the newest word is kept and told then
        QTimer::singleShot(static_cast<int>(wait), this, [this, id] { poll(id); });
        return;
    }
    job.sinceReport.start();
    job.said->posted = false;
    {
        const std::scoped_lock lock(job.said->mutex);
        job.status.fraction = job.said->fraction;
        job.status.stage = QString::fromStdString(job.said->stage);
    }
    emit progressed(id);
}

void Jobs::cancel(Id id) {
    const auto found = jobs_.find(id);
    if (found == jobs_.end() || found->second->cancelled) return;
    // The worker ends when it notices; waiting for it here would hold up the window.
    found->second->cancelled = true;
    found->second->thread.request_stop();
    emit finished(id);
}

void Jobs::end(Id id, std::any result, const std::exception_ptr& error) {
    const auto found = jobs_.find(id);
    if (found == jobs_.end()) return;
    // Out of the list before anything is handed over: a handler may start and cancel jobs, this one too.
    const std::unique_ptr<Job> job = std::move(found->second);
    jobs_.erase(found);
    if (job->cancelled) return;
    try {
        if (error) std::rethrow_exception(error);
        job->done(std::move(result));
    } catch (const Cancelled&) { // the work found a reason of its own to stop
    } catch (const std::exception& thrown) {
        job->failed(thrown);
    }
    emit finished(id);
}

std::vector<Jobs::Status> Jobs::running() const {
    std::vector<Status> running;
    for (const auto& [id, job] : jobs_)
        if (!job->cancelled) running.push_back(job->status);
    return running;
}

} // namespace lumorph::studio

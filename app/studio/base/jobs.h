#pragma once

#include <any>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <thread>
#include <vector>

#include <QObject>
#include <QString>

#include "core/base/progress.h"

namespace lumorph::studio {

/// Long work beside the window: each job runs in a thread of its own, reports how far it is, can be cancelled, and
/// hands its result to the window's thread. Nothing is handed over after a cancel.
class Jobs : public QObject {
    Q_OBJECT
public:
    using Id = int;
    struct Status {
        Id id = 0;
        QString title;         ///< what the user sees, such as "Building the field"
        QString place;         ///< as in Notices
        double fraction = 0.0; ///< negative: nobody knows the end
        QString stage;
    };

    explicit Jobs(QObject* parent = nullptr);
    ~Jobs() override; ///< cancels and waits

    /// `work` runs beside the window; then `done` or, with what it threw, `failed` runs in the window's thread. A job
    /// of the same place and title that still runs is cancelled first.
    template <class Result>
    Id run(const QString& place, const QString& title, std::function<Result(const Progress&)> work,
           std::function<void(Result)> done,
           std::function<void(const std::exception&)> failed) { // NOLINT(performance-unnecessary-value-param): moved
        return start(
            place, title, [work = std::move(work)](const Progress& progress) { return std::any(work(progress)); },
            [done = std::move(done)](std::any result) { done(std::any_cast<Result>(std::move(result))); },
            std::move(failed));
    }

    void cancel(Id id);
    [[nodiscard]] std::vector<Status> running() const;

signals:
    void started(int id);
    void progressed(int id); ///< at most some 30 times a second a job
    void finished(int id);   ///< done, failed or cancelled

private:
    Id start(const QString& place, const QString& title, std::function<std::any(const Progress&)> work,
             std::function<void(std::any)> done, std::function<void(const std::exception&)> failed);
    void poll(Id id);
    void end(Id id, std::any result, const std::exception_ptr& error);

    struct Job;
    std::map<Id, std::unique_ptr<Job>> jobs_;
    Id next_ = 1;
};

} // namespace lumorph::studio

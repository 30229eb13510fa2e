#pragma once

#include <exception>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include <QObject>
#include <QPointer>
#include <QString>

#include "app/studio/base/jobs.h"
#include "app/studio/base/notices.h"

namespace lumorph::studio {

/// Jobs of one owner by slots: of a slot only the newest job runs. When the owner has gone nothing is handed over.
class JobSlots {
public:
    JobSlots(QObject& owner, Jobs& jobs, Notices& notices) : owner_(&owner), jobs_(jobs), notices_(notices) {}
    ~JobSlots() {
        for (const auto& [slot, id] : slots_) jobs_.cancel(id);
    }
    JobSlots(const JobSlots&) = delete;
    JobSlots& operator=(const JobSlots&) = delete;

    /// A job that fails by a notice at its place.
    template <class Result>
    void run(const QString& slot, const QString& place, const QString& title,
             std::function<Result(const Progress&)> work, std::function<void(Result)> done,
             std::vector<Notice::Action> remedies = {}) {
        runWith<Result>(slot, place, title, std::move(work), std::move(done),
                        [this, alive = owner_, place, remedies = std::move(remedies)](const std::exception& error) {
                            if (alive) fail(place, error, remedies);
                        });
    }
    template <class Result>
    void runWith(const QString& slot, const QString& place, const QString& title,
                 std::function<Result(const Progress&)> work, std::function<void(Result)> done,
                 std::function<void(const std::exception&)> failed) {
        stop(slot);
        slots_[slot] = jobs_.run<Result>(
            place, title, std::move(work),
            [alive = owner_, done = std::move(done)](Result result) {
                if (alive) done(std::move(result));
            },
            [alive = owner_, failed = std::move(failed)](const std::exception& error) {
                if (alive) failed(error);
            });
    }
    void stop(const QString& slot) {
        if (const auto old = slots_.find(slot); old != slots_.end()) jobs_.cancel(old->second);
    }
    void fail(const QString& place, const std::exception& error, std::vector<Notice::Action> actions = {}) {
        Notice notice = noticeOf(error);
        notice.actions = std::move(actions);
        notices_.post(place, std::move(notice));
    }

private:
    QPointer<QObject> owner_;
    Jobs& jobs_;
    Notices& notices_;
    std::map<QString, Jobs::Id> slots_;
};

} // namespace lumorph::studio

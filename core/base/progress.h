#pragma once

#include <functional>
#include <stop_token>
#include <string_view>
#include <utility>

#include "core/base/error.h"

namespace lumorph {

/// Tells how far a long job is and whether its user wants it stopped. Cheap to copy; safe to call
/// from any thread as long as the report function is.
class Progress {
public:
    /// Called with a fraction in [0, 1], or a negative one where nobody knows the end, and a short name of the stage.
    using Report = std::function<void(double fraction, std::string_view stage)>;

    Progress() = default;
    explicit Progress(Report report, std::stop_token stop = {}) : report_(std::move(report)), stop_(std::move(stop)) {}

    void report(double fraction, std::string_view stage) const {
        if (report_) report_(fraction, stage);
    }
    /// For a part of the job: its 0 and 1 are `from` and `to` here.
    [[nodiscard]] Progress part(double from, double to) const {
        if (!report_) return Progress({}, stop_);
        return Progress([report = report_, from,
                         to](double fraction, std::string_view stage) { report(from + fraction * (to - from), stage); },
                        stop_);
    }
    [[nodiscard]] bool cancelled() const noexcept { return stop_.stop_requested(); }
    /// Throws Cancelled once the user has asked for it.
    void throwIfCancelled() const {
        if (cancelled()) throw Cancelled();
    }

private:
    Report report_;
    std::stop_token stop_;
};

} // namespace lumorph

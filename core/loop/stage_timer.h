#pragma once

#include "core/base/clock.h"

namespace lumorph {

/// Adds the milliseconds of its life to a figure.
class StageTimer {
public:
    StageTimer(const Clock& clock, double& milliseconds)
        : clock_(clock), milliseconds_(milliseconds), start_(clock.now()) {}
    ~StageTimer() { milliseconds_ += 1e-3 * static_cast<double>((clock_.now() - start_).count()); }
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

private:
    const Clock& clock_;
    double& milliseconds_;
    Microseconds start_;
};

} // namespace lumorph

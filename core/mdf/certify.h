#pragma once

#include <cstddef>
#include <memory>
#include <stop_token>
#include <string>

#include "core/base/clock.h"
#include "core/base/units.h"
#include "core/mdf/coverage.h"

namespace lumorph {

/// What is known of the best fit that a rig can reach on a target.
struct Certificate {
    double upperBound = 1.0; ///< no state of the rig's grid of levels has a larger IoU
    State best;              ///< the best state known
    FitQuality quality;      ///< of it
    bool exact = false;      ///< no state is better than `best`
    bool done = false;       ///< more time would tell no more
    std::size_t boxes = 0;   ///< boxes of states bounded so far
    std::string note;        ///< a sentence where only a trivial bound was possible, else empty

    [[nodiscard]] double gap() const noexcept { return upperBound - quality.iou(); }
};

struct CertifyOptions {
    /// Actuators that move the same triangles are tabulated up to so many joint states, and bounded by boxes beyond.
    std::size_t mostTabulated = 2000;
    bool oneThread = false; ///< works in the calling thread alone, else on all cores
};

/// Bounds the IoU that any state of a rig can reach on a target, ever tighter while it is given time.
///
/// IoU <= lambda where both - lambda x overfill <= lambda x wanted. That is a sum over columns of voxels, for each
/// lambda: columns that few actuators reach are tabulated and joined exactly (PieceTables; Dinkelbach, On nonlinear
/// fractional programming, 1967), the others bounded over boxes of states (VolumeBounds, BoxBound) that are halved,
/// the one with the largest bound first (branch and bound). A box of a few states is evaluated. The coverage must
/// outlive it; one object for each thread.
class Certifier {
public:
    explicit Certifier(const Coverage& coverage, CertifyOptions options = {});
    ~Certifier();
    Certifier(Certifier&&) noexcept;
    Certifier& operator=(Certifier&&) noexcept;

    /// Takes up a target and a state for it. `target` has the frame's shape; voxels inside the body are ignored.
    /// Throws InvalidInput when target or state do not fit the coverage.
    void start(const BitColumns& target, const State& state);
    /// Goes on for so long, or until all is known or `stop` is requested; looks at both at least every 50 ms on devices
    /// of the bundled ones' size. Called again and again, short budgets do what a long one does.
    Certificate tighten(Microseconds budget, const Clock& clock, const std::stop_token& stop = {});

private:
    class Search;
    std::unique_ptr<Search> search_;
};

} // namespace lumorph

#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/verify/drift_watch.h"
#include "calibration/verify/show_prediction.h"

namespace lumorph {

struct OutputWatchOptions {
    std::size_t camera = 0;
    int width = 160;       ///< of the pictures that are compared, pixels
    double window = 4.0;   ///< seconds between pictures whose difference tells whether the output still changes
    double patience = 2.0; ///< seconds for which something must be wrong
};

struct OutputReport {
    enum class State {
        watching, ///< nothing is known yet
        shown,    ///< what is sent is seen
        black,    ///< light should be there, and is not
        frozen,   ///< what is sent changes, what is seen does not
        blind     ///< it cannot tell: the camera gives nothing, or the content is dark
    };
    State state = State::watching;
    std::string sentence;
};
[[nodiscard]] const char* wordOf(OutputReport::State state);

/// Watches whether what is sent comes out of the projectors: black or frozen output is told within ten seconds, as
/// looks come every two seconds. Content that is dark or does not change is no fault. One thread at a time.
class OutputWatch {
public:
    /// Throws InvalidInput for a room without that camera or without a projector.
    OutputWatch(const Rig& rig, const Installation& believed, const OutputWatchOptions& options = {});

    /// Throws as `DriftWatch::look`.
    const OutputReport& look(const ShowLook& show, const Progress& progress = {});
    [[nodiscard]] const OutputReport& report() const noexcept { return report_; }

private:
    /// A look as the means of small squares that projectors light.
    struct Blocks {
        double seconds = 0.0;
        std::vector<double> strokes;
        std::vector<double> predicted, seen;
    };
    /// How what is seen hangs together with what was predicted, over the blocks.
    struct Match {
        double alike = 0.0; ///< correlation
        double gain = 0.0;  ///< grey levels a unit of predicted light
        double predictedSpread = 0.0, seenSpread = 0.0, seenMean = 0.0;
    };

    [[nodiscard]] std::optional<Blocks> blocksOf(const ShowLook& show, const Progress& progress);
    [[nodiscard]] static Match matchOf(const Blocks& blocks);
    [[nodiscard]] bool isBlack(const Match& match) const;
    [[nodiscard]] std::optional<bool> isFrozen(const Blocks& now) const;
    void conclude(OutputReport::State seen, double now);

    OutputWatchOptions options_;
    ShowPrediction prediction_;
    double gain_ = 0.0; ///< as healthy looks had it; 0: there was none yet
    std::deque<Blocks> history_;
    OutputReport::State suspect_ = OutputReport::State::watching;
    double suspectSince_ = 0.0;
    OutputReport report_;
};

} // namespace lumorph

#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/verify/check_pass.h"
#include "calibration/verify/moved_part.h"
#include "core/base/image.h"
#include "core/base/progress.h"

namespace lumorph {

/// A glance at the show while it runs.
struct ShowLook {
    double seconds = 0.0;        ///< by any clock that goes forward
    cv::Mat photograph;          ///< 8-bit grey or BGR; empty: the camera gives none
    std::vector<Image> sent;     ///< what the projectors showed then, one each, of its size
    std::vector<double> strokes; ///< where the actuators are believed to have stood
};

struct DriftWatchOptions {
    std::size_t camera = 0;
    int width = 320;           ///< of the pictures that are compared, pixels
    double memory = 15.0;      ///< seconds by which evidence fades to a third
    double alarm = 1.75e-3;    ///< metres beside which a part has moved
    double patience = 10.0;    ///< seconds for which that must last
    double blindFrom = 0.6e-3; ///< metres: where a projector's drift is known no better, nothing is said
};

/// What a watch says.
struct DriftReport {
    enum class State {
        watching, ///< it has not seen enough yet
        good,
        moved,
        blind ///< it cannot tell; `obstacle` says why
    };
    State state = State::watching;
    std::optional<NoVerdict> obstacle;
    std::string part;                     ///< what has moved, as `nameOf` names it
    std::vector<std::string> couldAlsoBe; ///< what the show does not tell from it
    double beside = 0.0, sigma = 0.0;     ///< metres, of the best explanation, moved or not
    int cells = 0;                        ///< places of the last look at which a shift was measured
    std::string sentence;
};

/// Watches whether the light of a running show lies where it belongs: what the camera sees is compared with what the
/// believed room predicts of the sent pictures, in small cells; brightness does not matter, cells before which
/// somebody stands are left out, and evidence is gathered over looks. It needs nothing of the show but that its
/// pictures have some structure. One thread at a time.
class DriftWatch {
public:
    /// Throws InvalidInput for a room without that camera or without a projector.
    DriftWatch(const Rig& rig, const Installation& believed, const DriftWatchOptions& options = {});
    ~DriftWatch();
    DriftWatch(DriftWatch&&) noexcept;
    DriftWatch& operator=(DriftWatch&&) noexcept;

    /// One more look, usually every five to ten seconds. Throws InvalidInput for pictures of another size than the
    /// room's projectors have, or strokes that are none; a photograph is never thrown at. Cancelled between its
    /// parts: then the watch is of no use any more.
    const DriftReport& look(const ShowLook& show, const Progress& progress = {});
    [[nodiscard]] const DriftReport& report() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph

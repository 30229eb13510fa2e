#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "calibration/decode/calibration_board.h"
#include "calibration/decode/refusal.h"
#include "calibration/patterns/capture_order.h"

namespace lumorph {

/// What the shots of one pose showed until now.
struct ShotFindings {
    std::optional<Finding> refusal; ///< the pose is of no use
    std::vector<Finding> warnings;
};

/// Looks at the shots of one pose as they come. A pattern and its inverse, or the steps of a phase set, make the same
/// even light whatever they show; so each complete set tells whether the light is even (else a frame is late, doubled
/// or missing, or somebody stepped in), as bright as before (else the exposure drifts), and where the corners of all
/// that is seen lie (else something moved). Needs no calibration.
class ShotCheck {
public:
    /// `name` of the pose stands in findings; `board`: what is looked for in the first even light, and where exposure
    /// counts. Nothing: all that the projector lights.
    ShotCheck(const CaptureOrder& order, std::string name, std::optional<CalibrationBoard> board = {});
    ~ShotCheck();
    ShotCheck(ShotCheck&&) noexcept;
    ShotCheck& operator=(ShotCheck&&) noexcept;

    /// White and black before the pose, 8-bit grey: with them the very first set can be judged as well. Optional.
    void lookAtLight(const cv::Mat& white, const cv::Mat& black);
    /// The next shot, 8-bit grey, and the name of its file. What is found is added to `findings`.
    void look(const cv::Mat& image, const std::string& file);
    /// After the last: that none is missing, and what needs all of them: mirrored pictures, the projector's size.
    void finish();

    [[nodiscard]] const ShotFindings& findings() const noexcept;
    /// The first even light, 8-bit grey; empty before.
    [[nodiscard]] cv::Mat evenLight() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Whether the projector warps or scales what it is sent (keystone, overscan, a size that is not its own), from photos
/// of a checkerboard of single pixels, the same inverted, all white and all black. What is scaled is mixed before it
/// becomes light: in places grey, elsewhere not, and darker than the light of half of the pixels. Nothing where the two
/// checkerboards add up to white and black, or where there is too little light to tell.
[[nodiscard]] std::optional<Finding> checkScaling(const cv::Mat& checkerboard, const cv::Mat& inverse,
                                                  const cv::Mat& white, const cv::Mat& black);

} // namespace lumorph

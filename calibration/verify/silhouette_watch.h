#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "calibration/verify/show_prediction.h"

namespace lumorph {

/// How far the device lies beside where it is believed to, sliding and turning on what it stands on. Where it is flat
/// light does not tell, but its outline and its folds do: there the picture would change if it moved.
class SilhouetteWatch {
public:
    /// `width` as of ShowPrediction.
    SilhouetteWatch(const Rig& rig, const Installation& believed, int width, std::size_t camera, double memory);

    /// Adds a look: the picture that was predicted and the one that was seen, of one size, unblurred. `usualGain`: grey
    /// levels a unit of light.
    void look(double seconds, const CoarseShow& sent, std::span<const double> strokes, const cv::Mat1f& predicted,
              const cv::Mat1f& seen, double usualGain);
    /// Without a look, evidence fades all the same.
    void fadeTo(double seconds);

    struct Result {
        double beside = 0.0; ///< metres, root mean square over the device
        double sigma = 1.0;  ///< standard deviation of it
        double looks = 0.0;  ///< that count
    };
    [[nodiscard]] Result result() const;

private:
    /// One square of the picture: what it says of the device's turn about its vertical axis (as metres at its rim),
    /// and of its shift along its x and z.
    struct Square {
        Eigen::Matrix3d information;
        Eigen::Vector3d motion;
    };
    [[nodiscard]] std::vector<Square> squaresOf(const std::vector<cv::Mat1f>& changes, const cv::Mat1f& predicted,
                                                const cv::Mat1f& seen, double usualGain) const;

    double memory_;
    double rim_;                            ///< metres: at which a turn is as far as a shift
    std::vector<ShowPrediction> displaced_; ///< forth and back, of each of the three
    Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Zero();
    Eigen::Vector3d vector_ = Eigen::Vector3d::Zero();
    double looks_ = 0.0, squares_ = 0.0, weights_ = 0.0, last_ = 0.0;
};

} // namespace lumorph

#include "calibration/verify/silhouette_watch.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Dense>
#include <glm/gtc/matrix_transform.hpp>
#include <opencv2/imgproc.hpp>

namespace lumorph {

namespace {

constexpr double kStep = 0.003;      // metres by which the device is displaced to see what changes
constexpr double kOutlineBlur = 2.0; // pixels: so that an edge is as wide as it may move
constexpr int kSquareSide = 16;      // pixels
constexpr double kTellsLevels = 1.5; // grey levels a millimetre, in the strongest pixel of a square
constexpr double kOutlineExplains = 0.6;
constexpr double kBlurredNoise = 40.0;                     // pixels that share their noise
constexpr double kSurestSquare = 0.5e-3, kBelieved = 0.03; // metres
constexpr double kOutlineFreedom = 3.0;
constexpr int kOutlineSteps = 8;

/// The room with its device turned (as far as `step` at its rim) or shifted along one of its axes.
Installation displacedRoom(Installation room, int which, double step, double rim) {
    const glm::dmat4 motion = which == 0 ? glm::rotate(glm::dmat4(1.0), step / rim, glm::dvec3(0.0, 1.0, 0.0))
                                         : glm::translate(glm::dmat4(1.0), which == 1 ? glm::dvec3(step, 0.0, 0.0)
                                                                                      : glm::dvec3(0.0, 0.0, step));
    room.worldFromDevice = glm::mat4(glm::dmat4(room.worldFromDevice) * motion);
    return room;
}

/// Root mean square distance of the device's places from its vertical axis.
double rimOf(const Rig& rig) {
    double sum = 0.0;
    for (const glm::vec3& p : rig.restMesh().positions) sum += static_cast<double>(p.x * p.x + p.z * p.z);
    return std::max(1e-3, std::sqrt(sum / static_cast<double>(rig.restMesh().positions.size())));
}

cv::Mat1f softened(const cv::Mat1f& picture) {
    cv::Mat1f soft;
    cv::GaussianBlur(picture, soft, {}, kOutlineBlur);
    return soft;
}

double strongest(const cv::Mat1f& change) {
    double low = 0.0, high = 0.0;
    cv::minMaxLoc(change, &low, &high);
    return std::max(-low, high);
}

} // namespace

SilhouetteWatch::SilhouetteWatch(const Rig& rig, const Installation& believed, int width, std::size_t camera,
                                 double memory)
    : memory_(memory), rim_(rimOf(rig)) {
    for (int which = 0; which < 3; ++which)
        for (const double step : {kStep, -kStep})
            displaced_.emplace_back(rig, displacedRoom(believed, which, step, rim_), width, camera);
}

void SilhouetteWatch::fadeTo(double seconds) {
    const double share = std::exp(-std::max(0.0, seconds - last_) / memory_);
    last_ = seconds;
    matrix_ *= share;
    vector_ *= share;
    for (double* sum : {&looks_, &squares_, &weights_}) *sum *= share;
}

/// Least squares of each square over brightness, offset and the three motions.
std::vector<SilhouetteWatch::Square> SilhouetteWatch::squaresOf(const std::vector<cv::Mat1f>& changes,
                                                                const cv::Mat1f& predicted, const cv::Mat1f& seen,
                                                                double usualGain) const {
    using Vector5 = Eigen::Matrix<double, 5, 1>;
    std::vector<Square> squares;
    const double tells = 1e3 * kTellsLevels / std::max(1e-9, usualGain);
    for (int y = 0; y + kSquareSide <= seen.rows; y += kSquareSide)
        for (int x = 0; x + kSquareSide <= seen.cols; x += kSquareSide) {
            const cv::Rect place(x, y, kSquareSide, kSquareSide);
            const auto strong = [&](const cv::Mat1f& change) { return strongest(change(place)) > tells; };
            if (std::ranges::none_of(changes, strong)) continue;
            Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
            Vector5 right = Vector5::Zero();
            double sum = 0.0, squared = 0.0;
            for (int row = y; row < y + kSquareSide; ++row)
                for (int column = x; column < x + kSquareSide; ++column) {
                    Vector5 line;
                    for (std::size_t i = 0; i < 3; ++i)
                        line[static_cast<Eigen::Index>(i)] = static_cast<double>(changes[i](row, column));
                    line[3] = static_cast<double>(predicted(row, column));
                    line[4] = 1.0;
                    const auto value = static_cast<double>(seen(row, column));
                    normal += line * line.transpose();
                    right += value * line;
                    sum += value;
                    squared += value * value;
                }
            const double count = place.area();
            const Vector5 found = (normal + 1e-9 * Eigen::Matrix<double, 5, 5>::Identity()).ldlt().solve(right);
            const double left = std::max(1e-2, (squared - found.dot(right)) / (count - 5.0));
            const double variance = squared / count - (sum / count) * (sum / count);
            if (!(found[3] > 0.3 * usualGain) || left > (1.0 - kOutlineExplains) * variance) continue; // a hand
            const Eigen::Matrix2d light = normal.bottomRightCorner<2, 2>();
            const Eigen::Matrix3d alone = normal.topLeftCorner<3, 3>() - normal.topRightCorner<3, 2>() *
                                                                             light.inverse() *
                                                                             normal.bottomLeftCorner<2, 3>();
            const Eigen::Matrix3d told = found[3] * found[3] * alone / (kBlurredNoise * left) +
                                         Eigen::Matrix3d::Identity() / (kBelieved * kBelieved);
            const Eigen::Matrix3d sure = kSurestSquare * kSurestSquare * Eigen::Matrix3d::Identity();
            squares.push_back({(told.inverse() + sure).inverse(), found.head<3>() / found[3]});
        }
    return squares;
}

void SilhouetteWatch::look(double seconds, const CoarseShow& sent, std::span<const double> strokes,
                           const cv::Mat1f& predicted, const cv::Mat1f& seen, double usualGain) {
    fadeTo(seconds);
    std::vector<cv::Mat1f> changes;
    for (std::size_t i = 0; i < displaced_.size(); i += 2) {
        const cv::Mat1f forth = displaced_[i].predict(sent, strokes), back = displaced_[i + 1].predict(sent, strokes);
        changes.push_back(softened((forth - back) / (2.0 * kStep)));
    }
    const std::vector<Square> squares = squaresOf(changes, softened(predicted), softened(seen), usualGain);
    Eigen::Vector3d motion = Eigen::Vector3d::Zero();
    for (int step = 0; step <= kOutlineSteps; ++step) {
        Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity() / (kBelieved * kBelieved);
        Eigen::Vector3d vector = Eigen::Vector3d::Zero();
        double left = 0.0, all = 0.0;
        for (const Square& square : squares) {
            const Eigen::Vector3d off = square.motion - motion;
            const double distance = off.dot(square.information * off);
            const double weight = (kOutlineFreedom + 3.0) / (kOutlineFreedom + distance);
            matrix += weight * square.information;
            vector += weight * (square.information * square.motion);
            left += weight * distance;
            all += weight;
        }
        motion = matrix.ldlt().solve(vector);
        if (step < kOutlineSteps) continue;
        matrix_ += matrix;
        vector_ += vector;
        squares_ += left;
        weights_ += all;
        looks_ += squares.empty() ? 0.0 : 1.0;
    }
}

/// Looks repeat one another's errors: together they count as one.
SilhouetteWatch::Result SilhouetteWatch::result() const {
    if (!(looks_ > 0.0)) return {};
    const double excess = std::max(1.0, squares_ / std::max(1e-9, 3.0 * weights_));
    const Eigen::Matrix3d covariance = excess * looks_ * matrix_.inverse();
    const Eigen::Vector3d motion = matrix_.inverse() * vector_;
    const double beside = motion.norm();
    const double variance = beside > 0.0 ? motion.dot(covariance * motion) / (beside * beside) : covariance.trace();
    return {beside, std::sqrt(std::max(0.0, variance)), looks_};
}

} // namespace lumorph

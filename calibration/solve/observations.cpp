#include "calibration/solve/observations.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace lumorph {

namespace {

constexpr double kDecodedShare = 0.6; // of a square
constexpr double kFewWhole = 0.1;     // of all squares, without an unknown pixel
constexpr double kFlat = 0.35;        // projector pixels
constexpr int kSmallestSquare = 4;    // camera pixels

/// One decoded camera pixel, relative to the middle of its square.
struct SquarePixel {
    double u, v, column, row;
};

/// Coordinates as a plane over a square: at its middle, and the root mean square of what does not fit.
struct SquareFit {
    cv::Vec3d column, row;
    double residual = 0.0;
};

SquareFit fitOf(const std::vector<SquarePixel>& pixels) {
    cv::Matx33d normal = cv::Matx33d::zeros();
    cv::Vec3d columns, rows;
    for (const SquarePixel& p : pixels) {
        const cv::Vec3d a(1.0, p.u, p.v);
        normal += a * a.t();
        columns += p.column * a;
        rows += p.row * a;
    }
    const cv::Matx33d inverse = normal.inv();
    SquareFit fit{inverse * columns, inverse * rows, 0.0};
    double sum = 0.0;
    for (const SquarePixel& p : pixels) {
        const cv::Vec3d a(1.0, p.u, p.v);
        const double c = p.column - fit.column.dot(a);
        const double r = p.row - fit.row.dot(a);
        sum += c * c + r * r;
    }
    fit.residual = std::sqrt(sum / (2.0 * static_cast<double>(pixels.size())));
    return fit;
}

double middleOf(std::vector<SquarePixel>& pixels, double SquarePixel::*value) {
    const auto middle = pixels.begin() + static_cast<std::ptrdiff_t>(pixels.size() / 2);
    std::ranges::nth_element(pixels, middle, {}, value);
    return (*middle).*value;
}

/// Leaves out codes that lie far from the rest.
void dropStrays(std::vector<SquarePixel>& pixels, double reach) {
    const double column = middleOf(pixels, &SquarePixel::column);
    const double row = middleOf(pixels, &SquarePixel::row);
    std::erase_if(pixels, [&](const SquarePixel& p) {
        return std::abs(p.column - column) > reach || std::abs(p.row - row) > reach;
    });
}

/// How many projector pixels a square may span: the board's whole span, scaled, with room for tilt.
double reachOf(const DecodedView& view, const cv::Mat1b& inside, int side) {
    std::vector<float> steps;
    for (int y = 0; y + side < inside.rows; y += side)
        for (int x = 0; x + side < inside.cols; x += side) {
            if (inside(y, x) == 0) continue;
            const float across = std::abs(view.column(y, x + side) - view.column(y, x)) +
                                 std::abs(view.column(y + side, x) - view.column(y, x));
            const float down =
                std::abs(view.row(y, x + side) - view.row(y, x)) + std::abs(view.row(y + side, x) - view.row(y, x));
            if (std::isfinite(across + down)) steps.push_back(std::max(across, down));
        }
    if (steps.empty()) return 0.0;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::ranges::nth_element(steps, middle);
    return 2.0 * *middle + 2.0;
}

} // namespace

std::vector<ProjectorPoint> projectorPointsOn(const DecodedView& view, const std::vector<cv::Point2d>& boardPoints,
                                              int most) {
    std::vector<cv::Point> outline, all;
    for (const cv::Point2d& point : boardPoints) all.emplace_back(cvRound(point.x), cvRound(point.y));
    cv::convexHull(all, outline);
    cv::Mat1b inside = cv::Mat1b::zeros(view.column.size());
    cv::fillConvexPoly(inside, outline, cv::Scalar(255));
    const int side =
        std::max(kSmallestSquare, static_cast<int>(std::lround(std::sqrt(cv::contourArea(outline) / most))));
    const double reach = reachOf(view, inside, side);
    const auto pointsOf = [&](double share) {
        std::vector<ProjectorPoint> points;
        std::vector<SquarePixel> pixels;
        for (int top = 0; top + side <= inside.rows; top += side)
            for (int left = 0; left + side <= inside.cols; left += side) {
                const cv::Point2d middle(left + 0.5 * (side - 1), top + 0.5 * (side - 1));
                pixels.clear();
                int within = 0;
                for (int y = top; y < top + side; ++y)
                    for (int x = left; x < left + side; ++x) {
                        if (inside(y, x) == 0) continue;
                        ++within;
                        if (view.confidence(y, x) > 0.0F)
                            pixels.push_back({x - middle.x, y - middle.y, view.column(y, x), view.row(y, x)});
                    }
                const double least = kDecodedShare * side * side;
                if (static_cast<double>(pixels.size()) < std::max(least, share * within)) continue;
                dropStrays(pixels, reach);
                if (static_cast<double>(pixels.size()) < least) continue;
                const SquareFit fit = fitOf(pixels);
                if (fit.residual < kFlat) points.push_back({middle, {fit.column[0], fit.row[0]}});
            }
        return points;
    };
    // A square of which a pixel is unknown lies at an edge, where the others are worth less; a board that is tilted far
    // has hardly any other.
    std::vector<ProjectorPoint> points = pointsOf(1.0);
    const double squares = cv::contourArea(outline) / (side * side);
    if (static_cast<double>(points.size()) < kFewWhole * squares) points = pointsOf(0.0);
    return points;
}

} // namespace lumorph

#include "app/studio/calibration/pose_pictures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QColor>
#include <opencv2/imgproc.hpp>

namespace lumorph::studio {
namespace {

constexpr int kWidest = 960;
constexpr int kLineEvery = 64; // projector pixels
constexpr int kHues = 300;     // degrees from the first to the last: the ends differ
constexpr QRgb kUnknown = qRgb(24, 26, 30);

cv::Size shownSize(cv::Size size) {
    if (size.width <= kWidest) return size;
    return {kWidest, std::max(1, size.height * kWidest / size.width)};
}

/// Codes are not blended: between two columns lies no other.
QImage coordinatePicture(const cv::Mat1f& coordinate, const cv::Mat1f& confidence, int length, cv::Size shown) {
    cv::Mat1f values, trust;
    cv::resize(coordinate, values, shown, 0, 0, cv::INTER_NEAREST);
    cv::resize(confidence, trust, shown, 0, 0, cv::INTER_NEAREST);
    QImage picture(shown.width, shown.height, QImage::Format_RGB32);
    for (int y = 0; y < shown.height; ++y) {
        auto* line = reinterpret_cast<QRgb*>(picture.scanLine(y));
        for (int x = 0; x < shown.width; ++x) {
            const float value = values(y, x);
            if (!std::isfinite(value) || trust(y, x) <= 0.0F) {
                line[x] = kUnknown;
                continue;
            }
            const double share = std::clamp(static_cast<double>(value) / length, 0.0, 1.0);
            const bool isLine = static_cast<int>(value) % kLineEvery < 3;
            line[x] = QColor::fromHsv(static_cast<int>(kHues * share), 190, isLine ? 120 : 235).rgb();
        }
    }
    return picture;
}

/// Around the known pixels but the outermost: stray ones lie anywhere.
cv::Rect litArea(const cv::Mat1f& confidence) {
    constexpr double kStray = 0.02; // of the pixels, at each side
    cv::Mat known;
    cv::compare(confidence, 0.0, known, cv::CMP_GT);
    const auto between = [&](int axis) {
        cv::Mat counts; // of the known, a column or a row each
        cv::reduce(known / 255, counts, axis, cv::REDUCE_SUM, CV_64F);
        const double stray = kStray * cv::sum(counts)[0];
        int first = 0, last = static_cast<int>(counts.total()) - 1;
        for (double sum = 0.0; first < last && (sum += counts.at<double>(first)) <= stray;) ++first;
        for (double sum = 0.0; last > first && (sum += counts.at<double>(last)) <= stray;) --last;
        return std::pair(first, last);
    };
    const auto [left, right] = between(0);
    const auto [top, bottom] = between(1);
    return right > left && bottom > top ? cv::Rect(left, top, right - left + 1, bottom - top + 1) : cv::Rect();
}

QImage greyPicture(const cv::Mat1b& grey) {
    QImage picture(grey.cols, grey.rows, QImage::Format_Grayscale8);
    for (int y = 0; y < grey.rows; ++y) std::copy_n(grey.ptr(y), grey.cols, picture.scanLine(y));
    return picture;
}

} // namespace

QImage pictureOfMat(const cv::Mat& image) {
    if (image.empty()) return {};
    cv::Mat small, grey;
    cv::resize(image, small, shownSize(image.size()), 0, 0, cv::INTER_AREA);
    if (small.channels() == 1) {
        small.convertTo(grey, CV_8U);
        return greyPicture(grey);
    }
    QImage picture(small.cols, small.rows, QImage::Format_RGB888);
    cv::Mat rgb(small.rows, small.cols, CV_8UC3, picture.bits(), static_cast<std::size_t>(picture.bytesPerLine()));
    cv::cvtColor(small, rgb, cv::COLOR_BGR2RGB);
    return picture;
}

PosePictures picturesOf(const DecodedView& decoded, cv::Size projector) {
    PosePictures pictures;
    pictures.camera = {decoded.white.cols, decoded.white.rows};
    const cv::Size shown = shownSize(decoded.white.size());
    pictures.lit = litArea(decoded.confidence);
    pictures.grey = decoded.white;
    pictures.white = pictureOfMat(decoded.white);
    pictures.columns = coordinatePicture(decoded.column, decoded.confidence, projector.width, shown);
    pictures.rows = coordinatePicture(decoded.row, decoded.confidence, projector.height, shown);
    cv::Mat1f trust;
    cv::resize(decoded.confidence, trust, shown, 0, 0, cv::INTER_AREA);
    cv::Mat1b grey;
    trust.convertTo(grey, CV_8U, 255.0);
    pictures.confidence = greyPicture(grey);
    return pictures;
}

} // namespace lumorph::studio

#include "calibration/capture/pattern_display.h"

#include <cstdio>
#include <span>
#include <string>
#include <system_error>

#include <opencv2/imgproc.hpp>

#include "calibration/lab/board_lab.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/image.h"

namespace lumorph {

namespace {

std::string sizeWords(cv::Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

class FileDisplay final : public PatternDisplay {
public:
    FileDisplay(std::filesystem::path folder, cv::Size size) : folder_(std::move(folder)), size_(size) {
        std::error_code failed;
        std::filesystem::create_directories(folder_, failed);
        if (failed) throwWriteError(folder_, failed.value());
    }

    [[nodiscard]] cv::Size size() const override { return size_; }
    void show(const cv::Mat& picture, const Progress& progress) override {
        progress.throwIfCancelled();
        checkPicture(picture, size_);
        char name[32];
        std::snprintf(name, sizeof name, "pattern_%03d.png", shown_);
        cv::Mat colours;
        cv::cvtColor(picture, colours, picture.channels() == 1 ? cv::COLOR_GRAY2RGBA : cv::COLOR_BGR2RGBA);
        Image image({size_.width, size_.height});
        for (int y = 0; y < size_.height; ++y)
            for (int x = 0; x < size_.width; ++x) {
                const auto& pixel = colours.at<cv::Vec4b>(y, x);
                image.at(x, y) = {pixel[0], pixel[1], pixel[2], pixel[3]};
            }
        writePng(image, folder_ / name);
        ++shown_;
    }
    void clear() override {}

private:
    std::filesystem::path folder_;
    cv::Size size_;
    int shown_ = 0;
};

class LabDisplay final : public PatternDisplay {
public:
    explicit LabDisplay(BoardLab& lab) : lab_(lab) {}

    [[nodiscard]] cv::Size size() const override {
        const glm::ivec2 size = lab_.projector().camera.size;
        return {size.x, size.y};
    }
    void show(const cv::Mat& picture, const Progress& progress) override {
        progress.throwIfCancelled();
        checkPicture(picture, size());
        cv::Mat grey = picture;
        if (picture.channels() == 3) cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
        lab_.show(grey);
    }
    void clear() override { lab_.show(cv::Mat::zeros(size(), CV_8U)); }

private:
    BoardLab& lab_;
};

} // namespace

void checkPicture(const cv::Mat& picture, cv::Size size) {
    if (picture.type() != CV_8UC1 && picture.type() != CV_8UC3)
        throw InvalidInput("picture for the projector", "is neither 8-bit grey nor BGR", "convert it first");
    if (picture.size() != size)
        throw InvalidInput("picture for the projector",
                           "is " + sizeWords(picture.size()) + " pixels, the projector " + sizeWords(size),
                           "make the patterns for this projector's size");
}

std::unique_ptr<PatternDisplay> openFileDisplay(const std::filesystem::path& folder, cv::Size size) {
    return std::make_unique<FileDisplay>(folder, size);
}

std::unique_ptr<PatternDisplay> openLabDisplay(BoardLab& lab) { return std::make_unique<LabDisplay>(lab); }

} // namespace lumorph

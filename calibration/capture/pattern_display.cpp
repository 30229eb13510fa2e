#include "calibration/capture/pattern_display.h"

#include <string>

#include <opencv2/imgproc.hpp>

#include "calibration/lab/board_lab.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

std::string sizeWords(cv::Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

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

std::unique_ptr<PatternDisplay> openLabDisplay(BoardLab& lab) { return std::make_unique<LabDisplay>(lab); }

} // namespace lumorph

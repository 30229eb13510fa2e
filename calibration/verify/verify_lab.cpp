#include "calibration/verify/verify_lab.h"

#include <utility>

namespace lumorph {

LabDeviceBench::LabDeviceBench(const Rig& rig, Installation truth, std::uint32_t seed, CheckLabOptions pictures)
    : rig_(rig), truth_(std::move(truth)), seed_(seed), pictures_(std::move(pictures)),
      commanded_(rig.actuatorCount(), 0.0) {}

void LabDeviceBench::stand(std::span<const double> commanded, const Progress& /*progress*/) {
    commanded_.assign(commanded.begin(), commanded.end());
    lab_.reset();
}

std::vector<cv::Mat> LabDeviceBench::photograph(std::size_t projector, const CaptureOrder& order,
                                                const Progress& progress) {
    if (!lab_) lab_.emplace(truth_, rig_, commanded_, pictures_, seed_ + 101U * looks_++);
    std::vector<cv::Mat> images;
    for (const PatternImage& pattern : order.images) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(images.size()) / static_cast<double>(order.images.size()), "photographing");
        images.push_back(lab_->photograph(projector, drawPattern(pattern, order.projector)));
    }
    return images;
}

} // namespace lumorph

#include "calibration/verify/verify_lab.h"

#include <utility>

#include "core/base/error.h"

namespace lumorph {

Installation withLabCamera(Installation room) {
    if (room.projectors.empty()) throw InvalidInput("installation", "it has no projector", "add one in the studio");
    if (!room.cameras.empty()) return room;
    room.cameras.push_back({"Camera", "", defaultLabCamera(room.projectors.front().camera), {}, {}});
    return room;
}

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

VerifiedRoom measureVerifyInLab(const Rig& rig, const Installation& believed, const Installation& truth,
                                std::uint32_t seed, const Progress& progress, const VerifyLabOptions& options) {
    if (truth.projectors.size() != believed.projectors.size())
        throw InvalidInput("check in the lab", "the true room has another number of projectors", "give it as many");
    LabDeviceBench bench(rig, photographedRoom(withLabCamera(truth), options.cameraWidth), seed, options.pictures);
    const Installation before = withLabCamera(believed);
    VerifiedRoom result = verifyRoom(rig, before, bench, progress, options);
    markSimulated(before, result.installation);
    result.check.installation = result.installation;
    return result;
}

} // namespace lumorph

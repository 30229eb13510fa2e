#include "core/loop/item_fit_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumorph {

namespace {

constexpr Microseconds kTellEvery{100'000};
constexpr int kShareOfTime = 20; ///< judging may take one part in so many
constexpr int kAroundPoints = 64;
constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

std::vector<glm::vec2> middlesOf(const VoxelFrame& frame) {
    std::vector<glm::vec2> middles;
    for (int z = 0; z < frame.dimensions.z; ++z)
        for (int x = 0; x < frame.dimensions.x; ++x) {
            const glm::dvec3 centre = frame.centre(x, 0, z);
            middles.emplace_back(centre.x, centre.z);
        }
    return middles;
}

/// Over the frame's rectangle, made twice as long and wide.
std::vector<glm::vec2> pointsAround(const VoxelFrame& frame) {
    const Box box = frame.box();
    const glm::vec2 low(box.min.x, box.min.z), size(box.max.x - box.min.x, box.max.z - box.min.z);
    std::vector<glm::vec2> points;
    for (int j = 0; j < kAroundPoints; ++j)
        for (int i = 0; i < kAroundPoints; ++i)
            points.push_back(low + size * (2.0F * (glm::vec2(i, j) + 0.5F) / static_cast<float>(kAroundPoints) - 0.5F));
    return points;
}

} // namespace

void ItemFitStage::judge(const DrivingHeights::Source& source, double seconds,
                         const std::shared_ptr<const MatchField>& field, const Clock& clock, MatchFrame& frame) {
    if (fit_ && (fit_->item != source.item || field_ != field)) forget();
    current_ = !fit_ || frame.time - told_ >= std::max(kTellEvery, kShareOfTime * cost_);
    if (!current_) {
        frame.itemFit = fit_;
        return;
    }
    const Microseconds began = clock.now();
    use(field);
    columns_->use(source);
    around_->use(source);
    std::vector<float> heights(static_cast<std::size_t>(voxels_.written().columnCount()), kNoHeight);
    columns_->at(seconds, heights);
    fillColumns(heights);
    fit_ = fitOf(frame);
    fit_->item = source.item;
    heights.assign(aroundPoints_.size(), kNoHeight);
    around_->at(seconds, heights);
    fit_->shareBeyondFrame = shareBeyond(heights);
    frame.itemFit = fit_;
    told_ = frame.time;
    cost_ = clock.now() - began;
}

void ItemFitStage::use(const std::shared_ptr<const MatchField>& field) {
    if (field_ == field) return;
    const VoxelFrame& frame = field->field.frame;
    columns_.emplace(middlesOf(frame));
    aroundPoints_ = pointsAround(frame);
    around_.emplace(aroundPoints_);
    voxels_.written() = BitColumns(frame.dimensions);
    field_ = field;
}

void ItemFitStage::fillColumns(const std::vector<float>& heights) {
    const VoxelFrame& frame = field_->field.frame;
    BitColumns& bits = voxels_.written();
    bits.clear();
    for (int z = 0; z < frame.dimensions.z; ++z)
        for (int x = 0; x < frame.dimensions.x; ++x) {
            const float top = heights[bits.columnIndex(x, z)];
            for (int y = 0; y < frame.dimensions.y; ++y) {
                const double middle = frame.centre(x, y, z).y;
                if (middle > static_cast<double>(field_->field.restSurface) && middle < static_cast<double>(top))
                    bits.set(x, y, z);
            }
        }
    voxels_.keepDomain(field_);
}

/// Of the volume above the surface at rest, whatever lies beside the frame or above it.
double ItemFitStage::shareBeyond(const std::vector<float>& heights) const {
    const Box box = field_->field.frame.box();
    double whole = 0.0, inside = 0.0;
    for (std::size_t k = 0; k < heights.size(); ++k) {
        const double lift = static_cast<double>(heights[k] - field_->field.restSurface);
        if (!(lift > 0.0)) continue;
        whole += lift;
        const glm::vec2& p = aroundPoints_[k];
        const bool over = p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.z && p.y <= box.max.z;
        if (over) inside += std::min(lift, static_cast<double>(box.max.y - field_->field.restSurface));
    }
    return whole > 0.0 ? (whole - inside) / whole : 0.0;
}

ItemFit ItemFitStage::fitOf(const MatchFrame& frame) {
    const auto iouAt = [&](const std::vector<double>& strokes) {
        field_->coverage.coveredAt(strokes, covered_, scratch_);
        return voxels_.count() == 0 ? 0.0 : compareVolumes(covered_, voxels_.bits()).iou();
    };
    ItemFit fit;
    fit.iouWanted = iouAt(frame.wantedStrokes);
    fit.iouEstimated = iouAt(frame.estimatedStrokes);
    fit.volume = static_cast<double>(voxels_.count()) * field_->field.frame.voxelVolume();
    fit.shareUnreachable = voxels_.shareUnreachable();
    return fit;
}

} // namespace lumorph

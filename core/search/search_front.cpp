#include "core/search/search_front.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include <tbb/parallel_for.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

constexpr int kVoxelsAcross = 96; ///< on the longest side of what a front is judged in
constexpr std::size_t kTried = 3; ///< designs of a cost that are built, to take the best by their true volume

/// Matches a rig in a frame that holds all it reaches and all targets.
LibraryFit trueFit(const Rig& rig, const SearchTargets& targets, const Progress& progress) {
    LibraryFitOptions options;
    options.placing = TargetPlacing::asIs;
    options.space = rig.reach();
    options.space.include(targets.box);
    const glm::vec3 size = options.space.size();
    const float voxel = std::max({size.x, size.y, size.z}) / static_cast<float>(kVoxelsAcross);
    options.resolution = std::max(1, static_cast<int>(std::lround(std::min({size.x, size.y, size.z}) / voxel)));
    return LibraryMatcher(rig, targets.library, options, progress).fit(progress);
}

} // namespace

SearchTargets placeForSearch(const Rig& rig, const SheetDevice& sheet, std::vector<LibraryTarget> library,
                             TargetPlacing placing, const Progress& progress) {
    const double top = sheet.housing + kSheetAboveHousing + sheet.thickness;
    Box room;
    for (const glm::dvec2& p : sheet.outline) room.include(glm::vec3(p.x, 0.0, p.y));
    const double shorter = static_cast<double>(std::min(room.size().x, room.size().z));
    room.include(
        glm::vec3(room.min.x, std::max(top + 0.5 * shorter, static_cast<double>(rig.reach().max.y)), room.min.z));
    const glm::vec3 size = room.size();
    const float voxel = std::max({size.x, size.y, size.z}) / static_cast<float>(kVoxelsAcross);
    const VoxelFrame frame =
        frameOf(room, std::max(1, static_cast<int>(std::lround(std::min({size.x, size.y, size.z}) / voxel))));
    BitColumns body;
    SolidVoxelizer voxelizer;
    voxelizer.voxelize(frame, rig.restMesh().positions, rig.restMesh().triangles, body);
    SearchTargets placedTargets;
    for (LibraryTarget& target : library) {
        progress.throwIfCancelled();
        const Placement placement = placeTarget(frame, static_cast<float>(top), body, target, placing);
        target.target.mesh = placed(target.target.mesh, placement);
        target.box = boundingBox(target.target.mesh.positions);
        placedTargets.box.include(target.box);
        placedTargets.targets.push_back(target.target);
    }
    placedTargets.library = std::move(library);
    return placedTargets;
}

std::vector<FrontDesign> buildFront(const SheetDesigns& designs, const DesignScorer& scorer, SearchCost cost,
                                    const SearchState& state, const SearchTargets& targets, const Progress& progress) {
    std::vector<const std::vector<ScoredDesign>*> costs;
    double fit = 0.0;
    for (const auto& [hundredths, kept] : state.best) {
        if (hundredths == 0 || kept.front().score.fit <= fit) continue;
        fit = kept.front().score.fit;
        costs.push_back(&kept);
    }
    std::vector<std::optional<FrontDesign>> built(costs.size());
    std::atomic<std::size_t> done{0};
    tbb::parallel_for(std::size_t{0}, costs.size(), [&](std::size_t k) {
        std::size_t tried = 0;
        for (const ScoredDesign& design : *costs[k]) {
            progress.throwIfCancelled();
            if (tried == kTried) break;
            try {
                SheetDevice device = designs.deviceOf(design.point);
                device.name += " " + std::to_string(device.bends.size());
                Rig rig = sheetRig(device, Progress());
                LibraryFit found = trueFit(rig, targets, progress.part(0.0, 0.0));
                ++tried;
                if (!built[k] || found.mean > built[k]->fit.mean)
                    built[k] =
                        FrontDesign{std::move(rig), scorer.priceOf(designs.flapsOf(design.point)), std::move(found)};
            } catch (const InvalidInput&) { // the next one is as good but for a little
            }
        }
        progress.report(static_cast<double>(++done) / static_cast<double>(costs.size()), "building the front");
    });
    std::vector<FrontDesign> front;
    for (std::optional<FrontDesign>& design : built)
        if (design) front.push_back(std::move(*design));
    const auto costOf = [&](const FrontDesign& design) {
        return cost == SearchCost::price ? design.price : static_cast<double>(design.rig.actuatorCount());
    };
    std::ranges::stable_sort(front, [&](const auto& a, const auto& b) { return costOf(a) < costOf(b); });
    std::vector<FrontDesign> best;
    for (FrontDesign& design : front)
        if (best.empty() || design.fit.mean > best.back().fit.mean) best.push_back(std::move(design));
    return best;
}

} // namespace lumorph

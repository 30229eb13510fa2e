#include "calibration/light/light_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "calibration/lab/lab_light.h"
#include "calibration/lab/lab_world.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kWhitest = 255.0;      // byte
constexpr double kFewCut = 0.02;        // of a patch's pixels
constexpr double kSheetSide = 0.12;     // metres
constexpr double kSheetMargin = 0.02;   // metres around it that are free of the device
constexpr double kSheetHeight = 0.0005; // metres above the table
constexpr double kSheetStep = 0.02;     // metres between places that are tried
constexpr int kPatch = 8;               // camera pixels along a side that must be even
constexpr int kPatchRim = 1;            // of them, left out on each side
constexpr double kEven = 1.08;          // brightest by dimmest place in a patch
constexpr double kSteepest = 0.25;      // of the light of the best lit patch: dimmer ones are slanted

/// Which projectors light all of a sheet around a place, one bit each; empty where it has no room.
std::optional<unsigned> lightOnSheet(const Lab& lab, const Installation& room, const CalibratedCamera& camera,
                                     const glm::dvec2& centre) {
    const glm::dvec3 up(0.0, 1.0, 0.0);
    unsigned reaching = ~0U;
    for (int i = -2; i <= 2; ++i)
        for (int j = -2; j <= 2; ++j) {
            const double reach = 0.5 * kSheetSide + kSheetMargin;
            const glm::dvec3 at(centre.x + 0.5 * i * reach, 0.0, centre.y + 0.5 * j * reach);
            if (std::abs(at.x) > 0.5 * room.tableSize.x || std::abs(at.z) > 0.5 * room.tableSize.y) return std::nullopt;
            const auto pixel = pixelOf(camera, at);
            if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x > camera.size.x - 1.0 ||
                pixel->y > camera.size.y - 1.0 || !lab.sees(at, up, positionOf(camera)))
                return std::nullopt;
            for (unsigned p = 0; p < room.projectors.size(); ++p)
                if (!room.projectors[p].enabled || !lab.lit(p, at, up)) reaching &= ~(1U << p);
        }
    reaching &= (1U << room.projectors.size()) - 1U;
    if (reaching == 0) return std::nullopt;
    return reaching;
}

/// Empty where its rays do not all see one surface in even light.
std::optional<LightPatch> patchAt(const LabSight& sight, std::size_t lamps, int left, int top) {
    LightPatch patch;
    std::vector<double> least(lamps, std::numeric_limits<double>::max()), most(lamps, 0.0), sums(lamps, 0.0);
    const auto rays = static_cast<std::size_t>(sight.samples * sight.samples);
    int surface = -2;
    double count = 0.0;
    for (int y = top; y < top + kPatch; ++y)
        for (int x = left; x < left + kPatch; ++x) {
            const auto pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(sight.size.x) + static_cast<std::size_t>(x);
            for (std::size_t ray = pixel * rays; ray < (pixel + 1) * rays; ++ray) {
                if (surface == -2) surface = sight.surfaces[ray];
                if (sight.surfaces[ray] != surface || surface < 0) return std::nullopt;
                count += 1.0;
                for (std::size_t lamp = 0; lamp < lamps; ++lamp) {
                    const auto share = static_cast<double>(sight.gleams[ray * lamps + lamp].share);
                    least[lamp] = std::min(least[lamp], share);
                    most[lamp] = std::max(most[lamp], share);
                    sums[lamp] += share;
                }
            }
        }
    bool isLit = false;
    for (std::size_t lamp = 0; lamp < lamps; ++lamp) {
        if (most[lamp] > kEven * least[lamp]) return std::nullopt;
        patch.shares.push_back(sums[lamp] / count);
        isLit = isLit || most[lamp] > 0.0;
    }
    if (!isLit) return std::nullopt;
    patch.surface = static_cast<LightSurface>(surface);
    patch.pixels = {left + kPatchRim, top + kPatchRim, kPatch - 2 * kPatchRim, kPatch - 2 * kPatchRim};
    const glm::dvec2 half = 0.5 * glm::dvec2(sight.size);
    patch.radius = glm::length(glm::dvec2(left, top) + 0.5 * kPatch - half) / glm::length(half);
    return patch;
}

} // namespace

Finding noRoomForSheet() {
    return {Cause::surfaceUnseen,
            "white sheet",
            {},
            "there is no room for it on the table where camera and projector both reach",
            "make room beside the device, or go on without it"};
}

CalibratedCamera lightCamera(const CalibratedCamera& camera, int width) {
    if (camera.size.x <= width) return camera;
    const double height = static_cast<double>(width) * camera.size.y / camera.size.x;
    return withSize(camera, {width, static_cast<int>(std::lround(height))});
}

LabWorld lightWorld(const Installation& room, const Rig& rig, const std::optional<WhiteSheet>& sheet) {
    LabWorld world;
    TriangleMesh device = rig.restMesh();
    for (glm::vec3& point : device.positions) point = glm::vec3(room.worldFromDevice * glm::vec4(point, 1.0F));
    world.surfaces = {{std::move(device), lightOfSrgb(room.deviceColor)},
                      {tableMesh(room.tableSize), lightOfSrgb(room.tableColor)}};
    if (sheet) {
        TriangleMesh paper{{sheet->begin(), sheet->end()}, {{0, 1, 2}, {0, 2, 3}}};
        world.surfaces.push_back({std::move(paper), glm::vec3(1.0F)});
    }
    for (const InstalledProjector& projector : room.projectors)
        world.projectors.push_back({projector, Image(projector.camera.size)});
    return world;
}

std::optional<WhiteSheet> placeForSheet(const Installation& room, const Rig& rig, const CalibratedCamera& camera) {
    const Lab lab(lightWorld(room, rig, std::nullopt));
    const glm::dvec3 device(room.worldFromDevice[3]);
    std::optional<glm::dvec2> best;
    double score = -std::numeric_limits<double>::max();
    const glm::dvec2 half = 0.5 * glm::dvec2(room.tableSize);
    for (double x = -half.x; x <= half.x; x += kSheetStep)
        for (double z = -half.y; z <= half.y; z += kSheetStep) {
            const glm::dvec2 at(x, z);
            const auto reaching = lightOnSheet(lab, room, camera, at);
            if (!reaching) continue;
            int projectors = 0;
            for (unsigned bits = *reaching; bits != 0; bits &= bits - 1U) ++projectors;
            const double worth = 10.0 * projectors - glm::distance(at, glm::dvec2(device.x, device.z));
            if (worth <= score) continue;
            score = worth;
            best = at;
        }
    if (!best) return std::nullopt;
    const auto corner = [&](double right, double front) {
        return glm::vec3(
            glm::dvec3(best->x + 0.5 * right * kSheetSide, kSheetHeight, best->y + 0.5 * front * kSheetSide));
    };
    return WhiteSheet{corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)};
}

std::vector<LightPatch> lightPatches(const Installation& room, const Rig& rig, const CalibratedCamera& camera,
                                     const std::optional<WhiteSheet>& sheet) {
    const LabSight sight = Lab(lightWorld(room, rig, sheet)).look(camera, 2);
    std::vector<LightPatch> patches;
    double most = 0.0;
    for (int top = 0; top + kPatch <= sight.size.y; top += kPatch)
        for (int left = 0; left + kPatch <= sight.size.x; left += kPatch) {
            auto patch = patchAt(sight, room.projectors.size(), left, top);
            if (!patch) continue;
            most = std::max(most, *std::ranges::max_element(patch->shares));
            patches.push_back(std::move(*patch));
        }
    std::erase_if(patches, [most](const LightPatch& patch) {
        return std::ranges::any_of(patch.shares,
                                   [most](double share) { return share > 0.0 && share < kSteepest * most; });
    });
    return patches;
}

std::vector<glm::dvec3> patchBytes(std::span<const LightPatch> patches, const cv::Mat& picture) {
    if (picture.type() != CV_8UC3 && picture.type() != CV_8UC1)
        throw InvalidInput("picture of the camera", "it does not have one or three channels of 8 bits",
                           "choose another format at the camera");
    std::vector<glm::dvec3> means;
    means.reserve(patches.size());
    for (const LightPatch& patch : patches) {
        if ((patch.pixels & cv::Rect({}, picture.size())) != patch.pixels)
            throw InvalidInput("picture of the camera", "it is smaller than the camera's", "take all of the same size");
        const cv::Mat seen = picture(patch.pixels);
        cv::Scalar mean = cv::mean(seen);
        // The device need not lie where it is believed to: across its edge one part is cut off, and the mean is not.
        const cv::Scalar cut = cv::mean(seen >= kWhitest);
        for (int channel = 0; channel < seen.channels(); ++channel)
            if (cut[channel] > kFewCut * 255.0) mean[channel] = kWhitest;
        means.push_back(picture.channels() == 1 ? glm::dvec3(mean[0]) : glm::dvec3(mean[0], mean[1], mean[2]));
    }
    return means;
}

} // namespace lumorph

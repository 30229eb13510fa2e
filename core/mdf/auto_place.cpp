#include "core/mdf/auto_place.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/mdf/placement_scorer.h"
#include "core/mdf/refine.h"
#include "core/mdf/relief.h"

namespace lumorph {

namespace {

constexpr std::size_t kCoarseClimbs = 24;
constexpr std::size_t kFineLooks = 10;
constexpr std::size_t kFineClimbs = 4;
constexpr std::size_t kAlternatives = 3;
constexpr Microseconds kFinalBudget{20'000};
constexpr double kSameLook = 0.7; ///< IoU of two placements' voxels from which on they look the same

/// A point of the search: the middle of the target's box stays in place while it is turned and scaled.
struct Pose {
    glm::quat turn{1.0F, 0.0F, 0.0F, 0.0F};
    double logScale = 0.0;
    glm::dvec3 middle{0.0};
};
constexpr std::size_t kAxes = 7;
/// Steps of the pattern search: turns about x, y and z (radians), logarithm of the scale, along x, y and z (metres).
using Steps = std::array<double, kAxes>;

struct Scored {
    double score = -1.0; ///< below 0: does not count
    Pose pose;
};

bool byScore(const Scored& a, const Scored& b) { return a.score > b.score; }

Pose stepped(Pose pose, std::size_t axis, double by) {
    if (axis < 3) {
        glm::vec3 about(0.0F);
        about[static_cast<int>(axis)] = 1.0F;
        pose.turn = glm::normalize(glm::angleAxis(static_cast<float>(by), about) * pose.turn);
    } else if (axis == 3) {
        pose.logScale += by;
    } else {
        pose.middle[static_cast<int>(axis) - 4] += by;
    }
    return pose;
}

double angleBetween(const glm::quat& a, const glm::quat& b) {
    return 2.0 * std::acos(std::min(1.0, std::abs(static_cast<double>(glm::dot(a, b)))));
}

/// All that take the axes to axes, then `count` spread evenly (M. Alexa, "Super-Fibonacci Spirals: Fast,
/// Low-Discrepancy Sampling of SO(3)", CVPR 2022).
std::vector<glm::quat> orientations(int count) {
    std::vector<glm::quat> all;
    const auto add = [&](const glm::quat& turn) {
        if (std::ranges::none_of(all, [&](const glm::quat& other) { return angleBetween(turn, other) < 0.05; }))
            all.push_back(turn);
    };
    constexpr auto kQuarter = static_cast<float>(0.5 * std::numbers::pi);
    for (int up = 0; up < 6; ++up)
        for (int heading = 0; heading < 4; ++heading) {
            const glm::vec3 about = up < 4 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
            const int quarters = up < 4 ? up : 2 * (up - 4) + 1;
            add(glm::angleAxis(kQuarter * static_cast<float>(heading), glm::vec3(0, 1, 0)) *
                glm::angleAxis(kQuarter * static_cast<float>(quarters), about));
        }
    constexpr int kHeadings = 12; // upright, as most models are made
    for (int k = 0; k < kHeadings; ++k)
        add(glm::angleAxis(static_cast<float>(2.0 * std::numbers::pi * k / kHeadings), glm::vec3(0, 1, 0)));
    constexpr double kPsi = 1.533751168755204288; // the real root of x^4 = x + 4
    for (int k = 0; k < count; ++k) {
        const double s = k + 0.5;
        const double r = std::sqrt(s / count), R = std::sqrt(1.0 - s / count);
        const double alpha = 2.0 * std::numbers::pi * s / std::numbers::sqrt2;
        const double beta = 2.0 * std::numbers::pi * s / kPsi;
        add(glm::quat(static_cast<float>(R * std::cos(beta)), static_cast<float>(r * std::sin(alpha)),
                      static_cast<float>(r * std::cos(alpha)), static_cast<float>(R * std::sin(beta))));
    }
    return all;
}

/// Of a plate its thickness, of other solids a part of their size, metres.
double meanThickness(const TriangleMesh& mesh) {
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a));
    }
    return area > 0.0 ? 2.0 * std::abs(signedVolume(mesh)) / area : 0.0;
}

/// The best that count and look different.
std::vector<PlacementCandidate> differentOf(std::vector<PlacementCandidate> all) {
    std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.iou > b.iou; });
    std::vector<PlacementCandidate> kept;
    for (PlacementCandidate& one : all) {
        if (one.iou < 0.0 || kept.size() == kAlternatives) break;
        if (std::ranges::none_of(kept, [&](const PlacementCandidate& other) {
                return intersectionOverUnion(one.wanted, other.wanted) > kSameLook;
            }))
            kept.push_back(std::move(one));
    }
    return kept;
}

class Placer {
public:
    Placer(const Field& field, const Coverage& coverage, const Voting& voting, const Target& target,
           const AutoPlaceOptions& options, const Progress& progress)
        : field_(field), coverage_(coverage), voting_(voting), target_(target), options_(options), progress_(progress),
          grid_(target, progress.part(0.0, 0.1)), scorer_(coverage, progress.part(0.1, 0.15)),
          thickness_(target.closed ? meanThickness(target.mesh) : INFINITY) {}

    AutoPlacement run() {
        const Pose fit = poseOf(fitPlacement(field_, grid_.box()));
        std::vector<Scored> found = distinct(coarseStarts(fit), kCoarseClimbs);
        const std::vector<Scored> starts(
            found.begin(), found.begin() + static_cast<std::ptrdiff_t>(std::min(found.size(), kFineClimbs)));
        const double coarse = scorer_.voxelSize();
        climbAll(found, {0.2, 0.2, 0.2, 0.12, 2.0 * coarse, coarse, 2.0 * coarse}, 3, 0.5,
                 [this](const Pose& pose) { return coarseScore(pose); });
        found = distinct(std::move(found), kFineLooks);
        found.insert(found.end(), starts.begin(), starts.end()); // where a climb went too far for the finer voxels
        found.push_back({0.0, fit});
        found.push_back({0.0, poseOf({})}); // a shape of the device itself, as it stands
        scoreAll(found, 0.55);
        found = distinct(std::move(found), kFineClimbs);
        const double fine = field_.frame.voxelSize;
        climbAll(found, {0.06, 0.06, 0.06, 0.05, 2.0 * fine, 2.0 * fine, 2.0 * fine}, 3, 0.6,
                 [this](const Pose& pose) { return fineScore(pose); });
        found.push_back({0.0, fit});
        return chosen(found);
    }

private:
    /// For one thread.
    struct Worker {
        explicit Worker(const Coverage& coverage) : refiner(coverage) {}
        PlacementScorer::Workspace coarse;
        Refiner refiner;
        Voting::Workspace voting;
        Votes votes;
        SolidVoxelizer voxelizer;
        BitColumns bits;
    };

    [[nodiscard]] Pose poseOf(const Placement& placement) const {
        return {placement.rotation(), std::log(placement.scale),
                glm::dvec3(glm::vec3(placement.deviceFromTarget() * glm::vec4(grid_.box().centre(), 1.0F)))};
    }
    [[nodiscard]] Placement placementOf(const Pose& pose) const {
        Placement placement{std::exp(pose.logScale), {}, glm::vec3(0.0F), pose.turn};
        placement.translation = glm::vec3(
            pose.middle - glm::dvec3(glm::vec3(placement.deviceFromTarget() * glm::vec4(grid_.box().centre(), 1.0F))));
        return placement;
    }

    /// Box around the target, turned, at scale 1.
    [[nodiscard]] Box extentOf(const glm::quat& turn) const {
        Box box;
        for (const glm::vec3& corner : grid_.hull()) box.include(turn * (corner - grid_.box().centre()));
        return box;
    }

    /// The scale at which the target, turned as it is, just fits the frame above the rest surface.
    [[nodiscard]] double fitScale(const Box& extent) const {
        const Box frame = field_.frame.box();
        const glm::vec3 room(frame.size().x, frame.max.y - field_.restSurface, frame.size().z);
        const glm::vec3 share = room / glm::max(extent.size(), glm::vec3(1e-12F));
        return static_cast<double>(std::min({share.x, share.y, share.z}));
    }

    /// Whether so much of the target stays where it counts. With a little room where only samples are looked at.
    [[nodiscard]] bool counts(const Pose& pose) const {
        const Box extent = extentOf(pose.turn);
        const double relative = std::exp(pose.logScale) / fitScale(extent);
        constexpr double kSlack = 1e-6;
        if (relative < options_.minScale * (1.0 - kSlack) || relative > options_.maxScale * (1.0 + kSlack))
            return false;
        if (std::exp(pose.logScale) * thickness_ < 0.5 * field_.frame.voxelSize) return false;
        const glm::mat4 deviceFromTarget = placementOf(pose).deviceFromTarget();
        const Box frame = field_.frame.box();
        std::size_t inFrame = 0;
        for (const glm::vec3& sample : grid_.samples()) {
            const glm::vec3 p(deviceFromTarget * glm::vec4(sample, 1.0F));
            if (p.x > frame.min.x && p.x < frame.max.x && p.z > frame.min.z && p.z < frame.max.z && p.y < frame.max.y)
                ++inFrame;
        }
        return static_cast<double>(inFrame) >= options_.minInFrame * static_cast<double>(grid_.samples().size());
    }

    [[nodiscard]] bool enoughInside(std::size_t voxels, double voxelVolume, const Pose& pose, double volume) const {
        return static_cast<double>(voxels) * voxelVolume >= options_.minInside * volume * std::exp(3.0 * pose.logScale);
    }

    double coarseScore(const Pose& pose) {
        progress_.throwIfCancelled();
        ++seen_;
        if (!counts(pose)) return -1.0;
        Worker& worker = workers_.local();
        const double score = scorer_.score(grid_, placementOf(pose).deviceFromTarget(), worker.coarse);
        constexpr double kMargin = 1.06;
        return enoughInside(worker.coarse.wanted.count(), std::pow(scorer_.voxelSize(), 3.0), pose,
                            kMargin * grid_.volume())
                   ? score
                   : -1.0;
    }

    double fineScore(const Pose& pose) {
        progress_.throwIfCancelled();
        ++seen_;
        if (!counts(pose)) return -1.0;
        Worker& worker = workers_.local();
        grid_.lookUp(field_.frame, placementOf(pose).deviceFromTarget(), worker.bits);
        worker.bits &= coverage_.domain();
        constexpr double kMargin = 1.01; // the grid's voxels are not quite the mesh's
        if (!enoughInside(worker.bits.count(), field_.frame.voxelVolume(), pose, kMargin * grid_.volume())) return -1.0;
        voting_.match(worker.bits, worker.votes, worker.voting);
        return worker.refiner.refine(worker.bits, worker.votes.state(), Microseconds{2500}, clock_).after.iou();
    }

    std::vector<Scored> coarseStarts(const Pose& fit) {
        const std::vector<glm::quat> turns = orientations(options_.orientations);
        std::vector<std::vector<Scored>> starts(turns.size());
        std::atomic<int> done{0};
        tbb::parallel_for(std::size_t{0}, turns.size(), [&](std::size_t k) {
            for (const Pose& start : startsAt(turns[k])) starts[k].push_back({coarseScore(start), start});
            tell(0.15, 0.4, ++done, static_cast<int>(turns.size()), "trying orientations");
        });
        std::vector<Scored> all{{coarseScore(fit), fit}};
        for (const std::vector<Scored>& some : starts) all.insert(all.end(), some.begin(), some.end());
        return all;
    }

    /// Over everything that moves and over each actuator's reach: as large as that is across, as large as fits into
    /// it, and between; standing on it, or sunk in until the top is as high as it rises.
    [[nodiscard]] std::vector<Pose> startsAt(const glm::quat& turn) const {
        const Box extent = extentOf(turn);
        const glm::vec3 size = glm::max(extent.size(), glm::vec3(1e-12F));
        const double fits = fitScale(extent);
        std::vector<Pose> starts;
        for (const Box& reach : scorer_.reaches()) {
            const glm::vec3 share = reach.size() / size;
            const auto across = static_cast<double>(std::min(share.x, share.z));
            const double within = std::min(across, static_cast<double>(share.y));
            double last = 0.0;
            for (const double wanted : {across, 0.75 * across, std::sqrt(across * within), within}) {
                const double scale = std::clamp(wanted, options_.minScale * fits, options_.maxScale * fits);
                if (std::abs(scale / std::max(last, 1e-12) - 1.0) < 0.05) continue;
                last = scale;
                const auto s = static_cast<float>(scale);
                const glm::vec3 centre = s * extent.centre(); // from the middle of the target's own box
                const float stands = reach.min.y - s * extent.min.y, tops = reach.max.y - s * extent.max.y;
                starts.push_back(
                    {turn, std::log(scale), {reach.centre().x - centre.x, stands, reach.centre().z - centre.z}});
                if (tops >= stands - 0.1F * reach.size().y) continue;
                starts.push_back(starts.back());
                starts.back().middle.y = static_cast<double>(tops);
                starts.push_back(starts.back());
                starts.back().middle.y = 0.5 * static_cast<double>(stands + tops);
            }
        }
        return starts;
    }

    /// Whether two starts lead to the same place.
    [[nodiscard]] bool areAlike(const Pose& one, const Pose& other) const {
        const double size = std::exp(one.logScale) * static_cast<double>(glm::length(grid_.box().size()));
        return angleBetween(one.turn, other.turn) < 0.35 && std::abs(one.logScale - other.logScale) < 0.2 &&
               glm::distance(one.middle, other.middle) < 0.12 * size;
    }

    /// The best of those that count, no two alike.
    [[nodiscard]] std::vector<Scored> distinct(std::vector<Scored> all, std::size_t most) const {
        std::ranges::stable_sort(all, byScore);
        std::vector<Scored> kept;
        for (const Scored& one : all) {
            if (one.score < 0.0 || kept.size() == most) break;
            if (std::ranges::none_of(kept, [&](const Scored& other) { return areAlike(one.pose, other.pose); }))
                kept.push_back(one);
        }
        return kept;
    }

    void scoreAll(std::vector<Scored>& all, double upTo) {
        std::atomic<int> done{0};
        tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t k) {
            all[k].score = fineScore(all[k].pose);
            tell(0.5, upTo, ++done, static_cast<int>(all.size()), "comparing places");
        });
    }

    /// Pattern searches from all: a step along each axis while that helps, then half the steps.
    template <typename Score>
    void climbAll(std::vector<Scored>& all, const Steps& steps, int halvings, double from, const Score& score) {
        std::atomic<int> done{0};
        tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t k) {
            climb(all[k], steps, halvings, score);
            tell(from - 0.1, from < 0.55 ? from : 0.9, ++done, static_cast<int>(all.size()), "improving places");
        });
    }

    template <typename Score> static void climb(Scored& at, Steps steps, int halvings, const Score& score) {
        for (int round = 0; round <= halvings;) {
            bool moved = false;
            for (std::size_t axis = 0; axis < kAxes; ++axis)
                for (const double sign : {1.0, -1.0}) {
                    const Pose next = stepped(at.pose, axis, sign * steps[axis]);
                    const double nextScore = score(next);
                    if (nextScore <= at.score + 1e-4) continue;
                    at = {nextScore, next};
                    moved = true;
                    break;
                }
            if (moved) continue;
            for (double& step : steps) step *= 0.5;
            ++round;
        }
    }

    void tell(double from, double to, int done, int all, const char* what) {
        progress_.throwIfCancelled();
        progress_.report(from + (to - from) * done / all, what);
    }

    /// With the voxels of its mesh; an IoU below 0 where it does not count.
    [[nodiscard]] PlacementCandidate candidateAt(const Pose& pose) {
        Worker& worker = workers_.local();
        PlacementCandidate made;
        made.placement = placementOf(pose);
        made.iou = -1.0;
        if (target_.closed) {
            const TriangleMesh mesh = placed(target_.mesh, made.placement);
            worker.voxelizer.voxelize(field_.frame, mesh.positions, mesh.triangles, made.wanted);
        } else { // winding numbers would take seconds each time
            grid_.lookUp(field_.frame, made.placement.deviceFromTarget(), made.wanted);
        }
        made.wanted &= coverage_.domain();
        const double volume = target_.closed ? std::abs(signedVolume(target_.mesh)) : grid_.volume();
        if (made.wanted.count() == 0 || !counts(pose) ||
            !enoughInside(made.wanted.count(), field_.frame.voxelVolume(), pose, volume))
            return made;
        voting_.match(made.wanted, worker.votes, worker.voting);
        const Refinement refined = worker.refiner.refine(made.wanted, worker.votes.state(), kFinalBudget, clock_);
        made.state = refined.state;
        made.iou = made.iouModel = refined.after.iou();
        return made;
    }

    /// The last of `found` is where the target fits.
    [[nodiscard]] AutoPlacement chosen(const std::vector<Scored>& found) {
        std::vector<PlacementCandidate> all(found.size());
        tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t k) { all[k] = candidateAt(found[k].pose); });
        AutoPlacement result;
        result.iouAtFit = std::max(0.0, all.back().iou);
        result.placementsSeen = seen_;
        result.alternatives = differentOf(std::move(all));
        if (!result.alternatives.empty()) result.iouPlain = result.alternatives.front().iou;
        return result;
    }

    const Field& field_;
    const Coverage& coverage_;
    const Voting& voting_;
    const Target& target_;
    const AutoPlaceOptions& options_;
    Progress progress_;
    TargetGrid grid_;
    PlacementScorer scorer_;
    double thickness_; ///< at scale 1; infinite for an open target, where it is unknown
    SteadyClock clock_;
    tbb::enumerable_thread_specific<Worker> workers_{[this] { return Worker(coverage_); }};
    std::atomic<int> seen_{0};
};

/// The target as a relief in every orientation along the axes.
std::vector<PlacementCandidate> reliefsOf(const Field& field, const Coverage& coverage, const Voting& voting,
                                          const Target& target, const Progress& progress) {
    const std::optional<ReliefRoom> found = reliefRoom(field);
    if (!found) return {};
    const ReliefRoom& room = *found;
    std::vector<PlacementCandidate> all(kReliefPlacements);
    tbb::parallel_for(0, kReliefPlacements, [&](int index) {
        progress.throwIfCancelled();
        PlacementCandidate& made = all[static_cast<std::size_t>(index)];
        made.placement = reliefPlacement(room, target.mesh, index);
        std::vector<glm::vec3> positions;
        placePoints(target.mesh.positions, made.placement.deviceFromTarget(), positions);
        voxelizeRelief(room, positions, target.mesh.triangles, made.wanted);
        made.wanted &= coverage.domain();
        Refiner refiner(coverage);
        const Refinement refined =
            refiner.refine(made.wanted, voting.match(made.wanted).state(), kFinalBudget, SteadyClock());
        made.state = refined.state;
        made.iou = made.wanted.count() > 0 ? refined.after.iou() : -1.0;
        SolidVoxelizer voxelizer;
        BitColumns plain;
        if (target.closed)
            voxelizer.voxelize(field.frame, positions, target.mesh.triangles, plain);
        else
            plain = made.wanted; // its inside is not known
        plain &= coverage.domain();
        made.iouModel = refiner.qualityOf(plain, made.state).iou();
    });
    // Face up, as people show heads on coins, unless another side is clearly better.
    constexpr double kFaceUp = 0.05;
    const double best = std::ranges::max_element(all, {}, &PlacementCandidate::iou)->iou;
    if (all.front().iou >= best - kFaceUp)
        std::erase_if(all, [&](const auto& one) { return one.iou > all.front().iou; });
    return differentOf(std::move(all));
}

} // namespace

AutoPlacement autoPlace(const Field& field, const Coverage& coverage, const Voting& voting, const Target& target,
                        const AutoPlaceOptions& options, const Progress& progress) {
    constexpr double kPoor = 0.3, kGain = 0.1;
    AutoPlacement result;
    const bool plain = options.relief != ReliefChoice::always;
    if (plain) result = Placer(field, coverage, voting, target, options, progress.part(0.0, 0.9)).run();
    if (!plain || (options.relief == ReliefChoice::automatic && result.iouPlain < kPoor)) {
        std::vector<PlacementCandidate> reliefs = reliefsOf(field, coverage, voting, target, progress);
        if (!reliefs.empty() && (!plain || reliefs.front().iou >= result.iouPlain + kGain)) {
            result.alternatives.insert(result.alternatives.begin(), std::make_move_iterator(reliefs.begin()),
                                       std::make_move_iterator(reliefs.end()));
            // The best relief, the best plain place, then another relief.
            if (result.alternatives.size() > kAlternatives) {
                if (reliefs.size() >= kAlternatives && plain)
                    std::swap(result.alternatives[1], result.alternatives[reliefs.size()]);
                result.alternatives.resize(kAlternatives);
            }
        }
    }
    if (!plain && result.alternatives.empty())
        throw InvalidInput("relief", "the device moves nothing above its rest surface", "use a rig that lifts");
    if (result.alternatives.empty())
        throw InvalidInput("target", "no placement shows enough of it: it is thinner than a voxel or has no volume",
                           "give a solid target, or build the field with a higher resolution");
    CoverageScratch scratch;
    for (PlacementCandidate& one : result.alternatives) coverage.covered(one.state, one.covered, scratch);
    const PlacementCandidate& best = result.alternatives.front();
    result.placement = best.placement;
    result.state = best.state;
    result.iou = best.iou;
    progress.report(1.0, "improving places");
    return result;
}

} // namespace lumorph

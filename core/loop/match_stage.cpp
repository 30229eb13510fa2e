#include "core/loop/match_stage.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/loop/stage_timer.h"

namespace lumorph {

namespace {

/// A target that has no voxel in the frame is not met by anything.
double iouOf(const FitQuality& quality, std::size_t targetVoxels) { return targetVoxels == 0 ? 0.0 : quality.iou(); }

/// Whether servos follow the voxels; else these are only compared with what the servos do.
bool followed(const MatchWish& wish) { return wish.driver == Driver::target || wish.driver == Driver::program; }

std::vector<LevelRange> levelsWithin(std::span<const StrokeRange> reach, int levels) {
    const auto nearest = [levels](double stroke) { return static_cast<int>(std::lround(stroke * (levels - 1))); };
    std::vector<LevelRange> ranges;
    for (const StrokeRange& range : reach) ranges.push_back({nearest(range.low), nearest(range.high)});
    return ranges;
}

} // namespace

void MatchStage::use(const std::shared_ptr<const MatchField>& field, std::span<const StrokeRange> reach) {
    std::vector<LevelRange> levels = field ? levelsWithin(reach, field->field.levels) : std::vector<LevelRange>();
    if (field == field_ && levels == reach_) return;
    reach_ = std::move(levels);
    if (field == field_) {
        if (matcher_) matcher_->keepWithin(reach_);
        votes_ = nullptr;
        return;
    }
    matcher_.reset();
    field_ = nullptr;
    if (field) {
        matcher_.emplace(field->coverage, field->voting);
        matcher_->keepWithin(reach_);
    }
    field_ = field;
    target_ = nullptr;
    votes_ = nullptr;
    decided_ = Decided::nothing;
    newVoxels_ = true;
    coveredState_.clear();
    reachedStrokes_.clear();
}

void MatchStage::match(const MatchWish& wish, const TargetVoxels& target, const std::shared_ptr<const void>& of,
                       bool newVoxels, const Clock& clock, MatchFrame& frame) {
    const bool other = newVoxels || target_ != of;
    newVoxels_ |= other;
    if (other) votes_ = nullptr;
    if (!votes_) vote(target, of, clock, frame.ms);
    decide(wish, target, clock, frame.ms);
    const FrameMatch& found = matcher_->found();
    frame.votes = votes_;
    frame.iouVoting = iouOf(found.votedQuality, target.count());
    if (!followed(wish)) return;
    frame.statesSeen = found.statesSeen;
    frame.wanted = found.wanted;
    frame.wantedStrokes.clear();
    const bool refined = wish.method == MatchMethod::refined;
    for (std::size_t i = 0; i < found.wanted.size(); ++i)
        frame.wantedStrokes.push_back(refined ? strokeOf(found.wanted[i], field_->field.levels)
                                              : std::clamp(votes_->actuators[i].stroke, 0.0, 1.0));
}

void MatchStage::vote(const TargetVoxels& target, const std::shared_ptr<const void>& of, const Clock& clock,
                      MatchTimes& ms) {
    const StageTimer timer(clock, ms.match);
    if (target_ != of) matcher_->forget();
    auto votes = std::make_shared<Votes>();
    matcher_->vote(target.bits(), *votes);
    decided_ = Decided::nothing;
    target_ = of;
    votes_ = std::move(votes);
}

void MatchStage::decide(const MatchWish& wish, const TargetVoxels& target, const Clock& clock, MatchTimes& ms) {
    const bool refined = followed(wish) && wish.method == MatchMethod::refined && target.count() > 0;
    const Decided how = refined ? Decided::byRefinement : Decided::byVoting;
    if (decided_ == how && matcher_->found().converged) return;
    const StageTimer timer(clock, refined ? ms.refine : ms.match);
    if (!refined)
        matcher_->keepVotes(target.bits());
    else if (decided_ == how)
        matcher_->resume(target.bits(), wish.budget, clock);
    else
        matcher_->refine(target.bits(), wish.budget, clock);
    decided_ = how;
}

void MatchStage::judge(const MatchWish& wish, const TargetVoxels& target, MatchFrame& frame) {
    judgeWanted(target, frame);
    judgeEstimated(target, frame);
    newVoxels_ = false;
    if (!wish.showTint) return;
    if (!classes_) classes_ = std::make_shared<const std::vector<std::uint8_t>>(voxelClasses(covered_, target.bits()));
    frame.classes = classes_;
}

void MatchStage::judgeWanted(const TargetVoxels& target, MatchFrame& frame) {
    const bool moved = coveredState_ != frame.wanted;
    if (moved) field_->coverage.covered(frame.wanted, covered_, scratch_);
    coveredState_ = frame.wanted;
    if (moved || newVoxels_) {
        quality_ = compareVolumes(covered_, target.bits());
        classes_ = nullptr;
    }
    const double voxelVolume = field_->field.frame.voxelVolume();
    frame.iouWanted = iouOf(quality_, target.count());
    frame.unmatchedVolume = static_cast<double>(quality_.unmatched) * voxelVolume;
    frame.overfilledVolume = static_cast<double>(quality_.overfilled) * voxelVolume;
}

void MatchStage::judgeEstimated(const TargetVoxels& target, MatchFrame& frame) {
    const bool moved = reachedStrokes_ != frame.estimatedStrokes;
    if (moved) field_->coverage.coveredAt(frame.estimatedStrokes, reached_, scratch_);
    reachedStrokes_ = frame.estimatedStrokes;
    if (moved || newVoxels_) iouReached_ = iouOf(compareVolumes(reached_, target.bits()), target.count());
    frame.iouEstimated = iouReached_;
}

std::vector<std::uint8_t> voxelClasses(const BitColumns& covered, const BitColumns& target) {
    const glm::ivec3 size = covered.dimensions();
    const auto rowLength = static_cast<std::size_t>(size.x);
    std::vector<std::uint8_t> classes(rowLength * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z),
                                      0);
    const auto words = static_cast<std::size_t>(covered.wordsPerColumn());
    for (int z = 0; z < size.z; ++z)
        for (int x = 0; x < size.x; ++x)
            for (std::size_t w = 0; w < words; ++w) {
                const std::size_t word = covered.columnIndex(x, z) * words + w;
                const std::uint64_t isCovered = covered.words()[word];
                const std::uint64_t isWanted = target.words()[word];
                for (std::uint64_t left = isCovered | isWanted; left != 0; left &= left - 1) {
                    const auto bit = static_cast<std::size_t>(std::countr_zero(left));
                    const std::size_t y = 64 * w + bit;
                    const bool in = (isCovered >> bit) & 1U;
                    const bool asked = (isWanted >> bit) & 1U;
                    const std::size_t row = static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y) + y;
                    classes[row * rowLength + static_cast<std::size_t>(x)] = in && asked ? kVoxelMatched
                                                                             : asked     ? kVoxelUnmatched
                                                                                         : kVoxelOverfilled;
                }
            }
    return classes;
}

} // namespace lumorph

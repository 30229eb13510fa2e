#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/loop/match_frame.h"
#include "core/loop/match_wish.h"
#include "core/loop/show_program.h"
#include "core/loop/target_voxels.h"
#include "core/motion/causal_split.h"
#include "core/motion/surface_heights.h"
#include "core/voxels/solid.h"

namespace lumorph {

/// The stage before all others of a frame whose wish has a show program: asks it for its content, and turns what servos
/// shall follow into voxels or strokes. A program that throws, or answers what cannot be used, is never asked again.
class ProgramStage {
public:
    /// The wish with scene and assets of its program, where it has one that answers; `strokes` are the estimated ones.
    /// Writes the program's part of a frame that began at its `time`.
    [[nodiscard]] MatchWish ask(const MatchWish& wish, double sinceLast, std::span<const double> strokes,
                                const Clock& clock, MatchFrame& frame);

    /// Whether there are voxels to be matched in this frame, and whether they are other ones than in the frame before.
    [[nodiscard]] bool matches() const noexcept { return matches_; }
    [[nodiscard]] bool newVoxels() const noexcept { return newVoxels_; }
    [[nodiscard]] const TargetVoxels& voxels() const noexcept { return voxels_; }
    /// What is to be said of those voxels, written into a frame.
    void describe(MatchFrame& frame) const;
    /// Strokes that the split asks for in this frame; empty without a split.
    [[nodiscard]] const std::vector<double>& splitStrokes() const noexcept { return splitStrokes_; }
    /// Whether the next frame with the same wish would be another one.
    [[nodiscard]] bool moves() const noexcept { return moves_; }

private:
    using Mesh = std::shared_ptr<const TriangleMesh>;
    using Voxels = std::shared_ptr<const BitColumns>;

    void begin(const MatchWish& wish, double sinceLast);
    void rest();
    void lookAround(const MatchWish& wish, MatchFrame& frame);
    [[nodiscard]] MatchWish answered(const MatchWish& wish, std::span<const double> strokes, const Clock& clock,
                                     MatchFrame& frame);
    void use(const MatchWish& wish, const ShowContent& content, const Clock& clock, MatchFrame& frame);
    void end(const MatchWish& wish, const std::string& why, MatchFrame& frame);
    [[nodiscard]] const std::string* endOf(const std::shared_ptr<ShowProgram>& program);

    void checkMeshOnce(const Mesh& mesh);
    void match(const MatchWish& wish, const ShowContent& content);
    void split(const MatchWish& wish, const ShowContent& content);
    void heightsAt(const MatchWish& wish, const ShowContent& content, std::span<float> heights);

    std::shared_ptr<ShowProgram> program_; ///< that was asked in the frame before
    double seconds_ = 0.0;
    double step_ = 0.0;
    std::vector<ShowBody> bodies_;
    glm::mat4 worldFromDevice_{1.0F};
    std::shared_ptr<const Scene> checked_; ///< is known to be sound
    std::shared_ptr<const SceneAssets> noAssets_ = std::make_shared<const SceneAssets>();
    std::vector<std::pair<std::weak_ptr<ShowProgram>, std::string>> ended_; ///< programs that threw, and what

    bool moves_ = false;
    bool matches_ = false;
    bool newVoxels_ = false;
    TargetVoxels voxels_;
    BitColumns before_;                       ///< voxels of the frame before; a buffer
    std::shared_ptr<const MatchField> field_; ///< that `voxels_` are of; empty before the first
    std::shared_ptr<const void> shape_;       ///< the mesh or voxels that they were made from
    SolidVoxelizer voxelizer_;
    Mesh soundMesh_; ///< the last that was looked over

    std::shared_ptr<const Rig> splitRig_;
    std::optional<CausalSplit> split_;
    std::optional<SurfaceHeights> reader_;
    std::vector<float> heights_;
    std::vector<double> splitStrokes_;
};

} // namespace lumorph

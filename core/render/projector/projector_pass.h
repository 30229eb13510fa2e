#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/render/eye/eye_view.h"
#include "core/render/eye/lookup_region.h"
#include "core/render/projector/projector_surface.h"
#include "core/render/projector/projector_target.h"

namespace lumorph {

/// The eye's pictures that a frame has: none in the view-independent mode, the table's only where it can differ from
/// the view-independent picture.
struct EyeViews {
    const EyeView* device = nullptr;
    const EyeView* table = nullptr;          ///< only with `device`
    std::span<const TableArea> tableAreas{}; ///< where the table is looked up in them
};

/// Draws what projectors send out so that the eye sees its picture on device and table.
class ProjectorPass {
public:
    ProjectorPass();

    /// Fits the target's table grid and depth range to the frame and draws the depth of the device, with what the
    /// lookups must know of it; of the table too where several projectors share the work.
    void drawDepth(ProjectorTarget& target, const ShowFrame& frame, const DeviceSurface& device, const EyeViews& views,
                   bool shared);
    /// Weighs projectors against one another; all their depths are drawn. Where one has a measured black, adds up what
    /// all blacks make of each place.
    /// What a tracked hand keeps from one is left to the others.
    void drawWeights(std::span<ProjectorTarget* const> targets, const ShowFrame& frame, const DeviceSurface& device);
    /// Begins the picture of one projector with what the eye sees, and hides what is done; depth and weights are drawn.
    /// The rest is the eye pass's.
    void drawSeen(const ProjectorTarget& target, const ShowFrame& frame, const DeviceSurface& device,
                  const EyeViews& views);
    /// Gives pixels that lie on several surfaces the value that is best for all that the eye sees of these, when the
    /// picture is complete.
    void drawMixed(const ProjectorTarget& target, const ShowFrame& frame, const EyeViews& views);

    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    [[nodiscard]] Program& seenProgram(const std::vector<std::string>& defines);
    Program& beginLookup(const ProjectorTarget& target, const ShowFrame& frame, const EyeViews& views,
                         const TableArea* onTable);
    void drawSurface(const ProjectorTarget& target, const DeviceSurface& device, const EyeViews& views);
    void hideDone(const ProjectorTarget& target, const EyeViews& views);
    void drawFullFrame(const PixelRectangle& part);
    void drawDistance(ProjectorTarget& target);
    void addWeight(const ProjectorTarget& shown, const ProjectorTarget& weighed, const ShowFrame& frame,
                   const DeviceSurface& device);
    [[nodiscard]] Program& mixedProgram(const ProjectorTarget& target);

    gl::VertexArray noAttributes_;
    ProjectorSurface seenSurface_;
    Program depth_, surface_, edges_, distance_, deviceWeight_, tableWeight_, deviceBlack_, tableBlack_, done_, mixed_,
        mixedGamma_, mixedResponse_;
    std::map<std::vector<std::string>, Program> seen_; ///< by the defines of projector.frag
};

} // namespace lumorph

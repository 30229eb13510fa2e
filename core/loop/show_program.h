#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>

#include "core/base/words.h"
#include "core/geometry/triangle_mesh.h"
#include "core/loop/match_field.h"
#include "core/loop/pose_stream.h"
#include "core/loop/show_caption.h"
#include "core/loop/show_inputs.h"
#include "core/loop/show_sound.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"
#include "core/voxels/bit_columns.h"
#include "core/voxels/height_grid.h"

namespace lumorph {

/// A tracked body that is seen now.
struct ShowBody {
    std::string name;
    PoseRole role = PoseRole::head;
    /// Predicted for the moment at which the frame is seen; world metres. A pointer is its tip, the device is its own
    /// frame, and a head is its body, with the eye at the installation's `eyeFromHead`.
    Pose pose;
};

/// What a program may know when it is asked for a frame. Spans hold until it answers.
struct ShowMoment {
    double seconds = 0.0; ///< since the program was asked first: the sum of all steps
    double step = 0.0;    ///< since the frame before; 0 in the first
    std::span<const ShowBody> bodies;
    std::span<const double> strokes;                  ///< where the actuators are estimated to be, one each
    std::shared_ptr<const Rig> rig;                   ///< always there
    std::shared_ptr<const MatchField> field;          ///< whose frame a target of voxels fills; may be empty
    std::shared_ptr<const Installation> installation; ///< what stands in the room; always there
    glm::mat4 worldFromDevice{1.0F};                  ///< predicted as `bodies` are
    std::optional<glm::vec3> eye; ///< of the viewer who is followed, predicted likewise, world metres; empty: none is
    std::span<const ShowInput> inputs;     ///< since the frame before, the oldest first
    Language language = Language::english; ///< of what it writes into its scene
};

/// How servos follow a program's target.
enum class Following {
    matched, ///< as voxels: the levels that fit best, as of a target (needs a field, else strokes are held)
    split,   ///< as heights: their slow part, by CausalSplit with its lag; all else is left to light
};

/// What a program answers.
struct ShowContent {
    std::shared_ptr<const Scene> scene;        ///< empty: the wish's own, with its own assets
    std::shared_ptr<const SceneAssets> assets; ///< of `scene`; empty: it needs none

    /// What servos follow, while the driver is `program`: nothing (they hold the wish's strokes), heights, a closed
    /// mesh in device metres, or voxels of the field's frame; a new one each frame where it likes. Nothing is repaired.
    std::variant<std::monostate, HeightGrid, std::shared_ptr<const TriangleMesh>, std::shared_ptr<const BitColumns>>
        target;
    Following following = Following::matched;

    bool moves = true; ///< another frame without a new input or pose would be another one

    std::vector<ShowSound> sounds; ///< that begin in this frame, or go on in it

    /// What visitors may read now, such as a level's name; the same object while it stays. Empty: nothing.
    std::shared_ptr<const ShowCaption> caption;
    /// In the frame in which it has changed: makes what the program shall be given at its next start, best runs for
    /// example. It is called by whoever keeps that, later and in another thread, so it holds copies. Empty: as before.
    std::function<std::string()> keepsake;
    /// The device shall be seen twice, beside each other: without and with view dependence (R23), whichever the servos
    /// do.
    bool comparesBend = false;
};

/// An application: asked once a frame for what is shown and felt. It runs in the loop's thread, knows neither window
/// nor devices, and must answer within a small part of a frame. The same moments, one after another, shall give the
/// same contents, so that a recording of its inputs can replay it: no clock, no chance without a seed.
///
/// An exception ends the program and not the show: see MatchFrame::programError.
class ShowProgram {
public:
    ShowProgram() = default;
    virtual ~ShowProgram() = default;
    ShowProgram(const ShowProgram&) = delete;
    ShowProgram& operator=(const ShowProgram&) = delete;

    [[nodiscard]] virtual ShowContent frame(const ShowMoment& moment) = 0;
};

} // namespace lumorph

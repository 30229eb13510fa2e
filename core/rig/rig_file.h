#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/rig/rig.h"

namespace lumorph {

/// Reads a rig from `.glb`/`.gltf`, or from a folder of one mesh per state.
///
/// In glTF an actuator is an object `lumorph` in the `extras` of a node (hinge, bend, slide, joint)
/// or, for morph targets and levers, in the list `extras.lumorph` of the mesh. Keys: `actuator` (its name, required),
/// `deformer` ("hinge" | "bend" | "slide" | "morph" | "joint" | "lever"), `axis`, `direction` (3 numbers in
/// the node's frame), `length` (metres), `range` (two numbers: degrees for hinge, bend, lever and a
/// turning joint, metres for slide and a moving joint, weights for morph), `motion` ("rotate" | "translate",
/// joint), `target` (morph target's name), `gridAxis` (lever), `levels`, `maxVelocity` (degrees, metres or weight a
/// second), `damping` (1 or more), `channel`, `pulse` (two numbers, microseconds), `pulseCurve` (PulseCurve),
/// `servo` (its kind), `order`. A node
/// with several actuators holds a list of such objects. The object or list may also be a text in JSON. A morph actuator
/// with several keys has the lists `targets` and `keys` (strokes). The model as drawn is the shape at the lower end of
/// every range; only of morph targets is the lower end worked out from the weights. Actuators stand in the order of
/// `order`; without it in that of the nodes, an inner one before those around it, so that a flap on a flap turns in the
/// frame in which it was drawn. Which vertices an actuator moves: those of the vertex attributes `_ACTUATORS_0`, `_1`,
/// ... (up to four actuator indices a vertex each; -1 for none) and `_INFLUENCES_0`, ... (their weights) where present;
/// else all vertices of the node's own mesh and of its descendants. A morph target moves what it displaces. Vertices of
/// one mesh that agree in place and in all that moves them become one, so that a solid whose corners were split for
/// normals closes again, unless the scene's `extras.lumorph.uniqueVertices` is true. `extras.lumorph.pathInside` there
/// states that the solid holds its own path; `extras.lumorph.drawing` is a text, what the rig was drawn as
/// (`RigParts::drawing`), which is carried along and not looked at.
///
/// The sheet that levers lift (SheetMotion) is stated by the mesh: `extras.lumorphSheet` has `modes` (their number K),
/// `strokes` (a flat list; each axis of the grid begins at 0 and ends at 1) and `coefficients` (a flat list: K a state
/// of the grid, of the states the last axis varies fastest), and where there are any `seconds` (two numbers: states
/// that have another equilibrium, too, and how far apart the two are, metres). The modes are the morph targets "sheet
/// mode 1" to "sheet mode K"; the vertex attributes `_SHEET_ROW` (-1 for none) and `_SHEET_SHARE` (1 where it is
/// missing) say what follows. A vertex of a row has the row's modes.
///
/// A folder holds `rest.obj` and `ACTUATOR_KEY.obj` (any mesh format; KEY 1, 2, ... evenly spaced
/// strokes), all with the same triangles.
///
/// A rig without actuators of its own but with skin or morph targets gets them as actuators: each
/// morph target one (weight 0 to 1); of a skin, each joint turned by an animation, over the range
/// the animations use; rest is the lower end of it.
/// Throws DataError naming the file, the node and the remedy.
[[nodiscard]] Rig readRig(const std::filesystem::path& path);

/// Something that moves in a model without actuators of its own, and can become one.
struct ActuatorOffer {
    enum class Kind {
        morphTarget,   ///< weight 0 to 1
        animatedJoint, ///< over the range that the animations use
        jointAtRest    ///< no animation turns it: by 45 degrees about its own X axis
    };
    std::string name; ///< as the actuator would be called
    Kind kind = Kind::morphTarget;
    bool operator==(const ActuatorOffer&) const = default;
};
/// Empty for a folder, and for a model that states its actuators. Throws DataError as `readRig`, but not where nothing
/// moves.
[[nodiscard]] std::vector<ActuatorOffer> offeredActuators(const std::filesystem::path& path);
/// Those that `readRig` takes without being told: all but joints at rest.
[[nodiscard]] std::vector<std::size_t> usualOffers(std::span<const ActuatorOffer> offers);
/// The model with these of its offers as actuators, in this order; a joint that is not taken stays as drawn.
[[nodiscard]] Rig readRig(const std::filesystem::path& path, std::span<const std::size_t> taken);

/// The same from a GLB in memory, as a .mdf file holds it.
[[nodiscard]] Rig readRigGlb(std::span<const std::byte> bytes, const std::string& name);

/// The rig as GLB; `readRigGlb` gives back the same rig (bit-equal rest positions, equal deformation).
[[nodiscard]] std::vector<std::byte> writeRigGlb(const Rig& rig);

} // namespace lumorph

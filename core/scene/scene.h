#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/units.h"
#include "core/scene/material.h"

namespace lumorph {

/// What servos and light do with an item (R33). `virtualOnly`: light alone. `physical`: the matcher's target, drawn by
/// light too. `split`: its slow, long part is for the servos, and light draws it whole, so that light carries what the
/// estimated device does not.
enum class ItemRole { virtualOnly, physical, split };

/// The frame in which an item stands: it rides on the device, or stays in the world (table).
enum class Anchor { device, world };

/// The model of a glTF, with its materials, textures, animations and skins.
struct MeshItem {
    std::string model;        ///< asset
    int animation = 0;        ///< -1: it stands still
    double speed = 1.0;       ///< of the animation
    bool ownMaterials = true; ///< the glTF's; false: the item's material
    bool operator==(const MeshItem&) const = default;
};
/// The project's match target, drawn by light where the matcher has it.
struct TargetItem {
    bool operator==(const TargetItem&) const = default;
};
/// A simple solid around the item's origin.
struct ShapeItem {
    enum class Form { box, sphere, cylinder, plane };
    Form form = Form::box;
    glm::vec3 size{0.03F}; ///< metres
    bool operator==(const ShapeItem&) const = default;
};
/// One travelling sine of a height field.
struct Wave {
    double amplitude = 0.005; ///< metres
    double length = 0.1;      ///< metres
    double period = 2.0;      ///< seconds; 0 stands still
    Angle direction;          ///< it travels along (cos, sin) in x and z
    Angle phase;
    bool operator==(const Wave&) const = default;
};
/// A surface y = height(x, z, time) over a rectangle around the item's origin, with walls down to `floor`: water, a
/// map.
struct HeightItem {
    glm::vec2 size{0.21F, 0.15F}; ///< metres in x and z
    std::vector<Wave> waves;
    std::string image;         ///< grey picture asset, stretched over the rectangle; empty: none
    double imageHeight = 0.02; ///< metres from black to white
    double floor = -0.02;      ///< y to which its walls lead
    double calmEdge = 0.0;     ///< metres over which waves fade towards the rim
    bool operator==(const HeightItem&) const = default;
};
/// Fog in a box around the item's origin; its grain drifts with the wind.
struct FogItem {
    glm::vec3 size{0.25F, 0.06F, 0.2F}; ///< metres
    double density = 12.0;              ///< extinction a metre, at most
    glm::vec3 color{0.9F};
    double grain = 0.06;          ///< size of its clouds, metres
    glm::vec2 drift{0.02F, 0.0F}; ///< metres a second in x and z
    bool operator==(const FogItem&) const = default;
};
/// A light. `sun`: parallel light from the direction of the item's position as seen from its anchor's origin. `lamp`:
/// it stands at the item's position; its intensity is that at 0.5 m.
struct LightItem {
    enum class Kind { sun, lamp };
    Kind kind = Kind::sun;
    glm::vec3 color{1.0F};
    double intensity = 2.0; ///< radiance of a white diffuse surface it meets head on
    double softness = 0.1;  ///< size of the source over its distance
    bool shadows = true;
    bool operator==(const LightItem&) const = default;
};
/// Holds others together.
struct GroupItem {
    bool operator==(const GroupItem&) const = default;
};
using ItemKind = std::variant<MeshItem, TargetItem, ShapeItem, HeightItem, FogItem, LightItem, GroupItem>;

/// A small motion of its own: a floating cube turns and rises and falls.
struct ItemMotion {
    double spin = 0.0;      ///< radians a second about +Y
    double bob = 0.0;       ///< metres up and down
    double bobPeriod = 3.0; ///< seconds
    bool operator==(const ItemMotion&) const = default;
};

struct SceneItem {
    int id = 0;     ///< unique in the scene, from 1
    int parent = 0; ///< a group's id; 0: none
    std::string name;
    bool visible = true;
    float opacity = 1.0F;
    Anchor anchor = Anchor::device; ///< of a child: its group's
    ItemRole role = ItemRole::virtualOnly;
    glm::vec3 position{0.0F}; ///< metres, in the anchor's frame or the group's
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    glm::vec3 scale{1.0F};
    ItemMotion motion;
    Material material;
    ItemKind kind = GroupItem{};
    bool operator==(const SceneItem&) const = default;
};

/// What is shown on the device's own surface, against what is physically there.
struct DeviceSkin {
    enum class Show { material, content }; ///< `content`: only items show, the device is a mere screen
    Show show = Show::material;
    Material material;
    double shrink = 0.0; ///< apparent shrinking in [0, 0.9]: the rim shows the table (R32)
    struct Hole {
        glm::vec2 centre{0.0F}; ///< x and z in device coordinates at rest, metres
        double radius = 0.015;
        bool operator==(const Hole&) const = default;
    };
    std::vector<Hole> holes;
    struct Creases {
        double emphasis = 0.0;                 ///< -1 blurred, 0 as they are, 1 drawn sharp (R30)
        Angle threshold = Angle::degrees(8.0); ///< of the dihedral angle across a crease
        double width = 0.002;                  ///< metres
        glm::vec3 color{0.05F};
        bool operator==(const Creases&) const = default;
    } creases;
    bool operator==(const DeviceSkin&) const = default;
};

/// What the table beneath looks like, through holes and beside the device. How large it is says the installation.
struct Table {
    Material material;
    bool operator==(const Table&) const = default;
};

/// Which of the two layers works, Fig. 2 of the paper: servos, light, or both. `virtualOnly` keeps the device at rest.
enum class Showing { both, physical, virtualOnly };

/// View-dependent shape change (R20-R23).
struct ViewDependence {
    bool on = false;
    Angle theta = Angle::degrees(90.0); ///< largest bend, and the elevation from which nothing bends
    bool operator==(const ViewDependence&) const = default;
};

/// All that is shown, and how: a plain value. Where it is shown says the installation (installation.h).
struct Scene {
    std::vector<SceneItem> items; ///< a group stands before its members
    DeviceSkin device;
    Table table;
    glm::vec3 sky{0.30F};    ///< light from everywhere, linear
    double exposure = 1.0;   ///< before tone mapping
    bool toneMapping = true; ///< a soft shoulder; false clips
    Showing showing = Showing::both;
    ViewDependence viewDependence;
    bool operator==(const Scene&) const = default;
};

/// What a new project shows: the device as paper on a wooden table, and one sun. Room for all its numbers is in
/// `scene_defaults.cpp`.
[[nodiscard]] Scene defaultScene();

/// Throws InvalidInput naming the item and the value: ids, parents, numbers that are not finite or out of range, more
/// than one item that the servos follow, more than kMaxItems.
void checkScene(const Scene& scene);
inline constexpr int kMaxItems = 500;

[[nodiscard]] const SceneItem* findItem(const Scene& scene, int id);
/// Whether an item and all groups around it are visible.
[[nodiscard]] bool isShown(const Scene& scene, const SceneItem& item);
/// The item the servos follow (role physical or split), if any.
[[nodiscard]] const SceneItem* drivingItem(const Scene& scene);

} // namespace lumorph

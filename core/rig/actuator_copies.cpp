#include "core/rig/actuator_copies.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rig/rig_validation.h"

namespace lumorph {
namespace {

constexpr float kNear = 0.0005F; // metres

int axisOf(MirrorPlane plane) { return plane == MirrorPlane::acrossX ? 0 : 2; }

/// Vertices sorted along x, to be found by place.
class VertexFinder {
public:
    explicit VertexFinder(const std::vector<glm::vec3>& positions) : positions_(positions), order_(positions.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
        std::ranges::sort(order_, {}, [&](std::uint32_t v) { return positions_[v].x; });
    }
    /// The nearest one.
    [[nodiscard]] std::optional<std::uint32_t> at(const glm::vec3& place) const {
        std::optional<std::uint32_t> found;
        float least = kNear;
        auto next =
            std::ranges::lower_bound(order_, place.x - kNear, {}, [&](std::uint32_t v) { return positions_[v].x; });
        for (; next != order_.end() && positions_[*next].x <= place.x + kNear; ++next)
            if (const float far = glm::distance(positions_[*next], place); far <= least) least = far, found = *next;
        return found;
    }

private:
    const std::vector<glm::vec3>& positions_;
    std::vector<std::uint32_t> order_;
};

/// Where a copy stands: a turn, or a mirror image, and a way.
struct Image {
    glm::mat3 turn{1.0F};
    glm::vec3 way{0.0F};
    const std::string& subject;

    [[nodiscard]] glm::vec3 place(const glm::vec3& point) const { return turn * point + way; }
    /// Turning is seen reversed in a mirror: an axis is turned over the other way round than a direction.
    [[nodiscard]] glm::vec3 axis(const glm::vec3& axis) const { return glm::determinant(turn) * (turn * axis); }

    void operator()(Hinge& hinge) const {
        hinge.origin = place(hinge.origin);
        hinge.axis = axis(hinge.axis);
    }
    void operator()(Bend& bend) const {
        bend.origin = place(bend.origin);
        bend.axis = axis(bend.axis);
        bend.direction = turn * bend.direction;
    }
    void operator()(Slide& slide) const { slide.direction = turn * slide.direction; }
    void operator()(MorphTarget& morph) const {
        for (auto& displacements : morph.displacements)
            for (glm::vec3& displacement : displacements) displacement = turn * displacement;
    }
    void operator()(SkinJoint&) const {
        throw InvalidInput(subject, "it turns a joint of the skin, which cannot be copied here",
                           "add the joint in the program that the model was made with");
    }
    void operator()(SheetLift&) const {
        throw InvalidInput(subject, "it is a lever of the sheet, whose shape was computed with the levers that it has",
                           "add the lever where the sheet is drawn");
    }
};

/// Influences on the vertices where the copy stands, ascending, with the displacements of a morph target in the same
/// order.
void moveInfluences(Actuator& actuator, const VertexFinder& vertices, const std::vector<glm::vec3>& positions,
                    const Image& copy) {
    std::vector<std::pair<std::uint32_t, std::size_t>> images; // vertex, which influence
    for (std::size_t i = 0; i < actuator.influences.size(); ++i) {
        const auto image = vertices.at(copy.place(positions[actuator.influences[i].vertex]));
        if (!image)
            throw InvalidInput(copy.subject, "the mesh is not the same where its copy would stand",
                               "make the mesh alike there first, or add the actuator by hand");
        images.emplace_back(*image, i);
    }
    std::ranges::sort(images);
    for (std::size_t i = 1; i < images.size(); ++i)
        if (images[i].first == images[i - 1].first)
            throw InvalidInput(copy.subject, "two of its vertices would be the same one in its copy",
                               "clean the mesh first");
    const std::vector<Influence> before = actuator.influences;
    for (std::size_t i = 0; i < images.size(); ++i)
        actuator.influences[i] = {images[i].first, before[images[i].second].weight};
    if (auto* morph = std::get_if<MorphTarget>(&actuator.deformer))
        for (auto& displacements : morph->displacements) {
            const auto old = displacements;
            for (std::size_t i = 0; i < images.size(); ++i) displacements[i] = old[images[i].second];
        }
}

/// `wanted`, with a number behind it where another actuator is called so.
std::string freeName(const RigParts& parts, const std::string& wanted) {
    const auto taken = [&](const std::string& one) {
        return std::ranges::any_of(parts.actuators, [&](const Actuator& a) { return a.name == one; });
    };
    std::string free = wanted;
    for (int i = 2; taken(free); ++i) free = wanted + " " + std::to_string(i);
    return free;
}

bool sameVertices(const Actuator& a, const Actuator& b) {
    return std::ranges::equal(a.influences, b.influences, {}, &Influence::vertex, &Influence::vertex);
}

float middleOf(const RigParts& parts, int axis) {
    const Box box = boundingBox(parts.restMesh.positions);
    return 0.5F * (box.min[axis] + box.max[axis]);
}

Actuator imageOf(const RigParts& parts, std::size_t index, const VertexFinder& vertices, const Image& copy) {
    Actuator image = parts.actuators[index];
    std::visit(copy, image.deformer);
    moveInfluences(image, vertices, parts.restMesh.positions, copy);
    return image;
}

/// Among the actuators: the one that moves the same vertices takes over how the image moves, or the image is added.
/// Returns which one it is, and whether it is new.
std::pair<std::size_t, bool> place(RigParts& parts, Actuator image, const std::string& name) {
    auto& actuators = parts.actuators;
    const auto there = std::ranges::find_if(actuators, [&](const Actuator& a) { return sameVertices(a, image); });
    if (there == actuators.end()) {
        image.name = freeName(parts, name);
        image.drive.channel = -1;
        actuators.push_back(std::move(image));
        return {actuators.size() - 1, true};
    }
    image.name = there->name;
    image.drive = there->drive;
    *there = std::move(image);
    return {static_cast<std::size_t>(there - actuators.begin()), false};
}

/// `images` are those of the copies beside the first one.
ActuatorCopies copies(const RigParts& parts, std::size_t index, const std::vector<Image>& images) {
    const Actuator& first = parts.actuators.at(index);
    const VertexFinder vertices(parts.restMesh.positions);
    ActuatorCopies result{parts, {}, 0};
    for (const Image& image : images) {
        Actuator copy = imageOf(parts, index, vertices, image);
        if (sameVertices(copy, first))
            throw InvalidInput(image.subject, "a copy would stand where it stands itself",
                               "choose one that lies on one side, or fewer copies");
        const auto [actuator, added] = place(result.parts, std::move(copy), first.name + " copy");
        result.actuators.push_back(actuator);
        result.added += added ? 1 : 0;
    }
    return result;
}

void requireCount(int count, const std::string& subject) {
    if (count < 2 || count > kMostCopies)
        throw InvalidInput(subject, std::to_string(count) + " copies are asked for", "ask for 2 to 200");
}

} // namespace

MirroredActuator mirroredActuator(const RigParts& parts, std::size_t index, MirrorPlane plane) {
    validate(parts); // while they are edited they may be no rig
    const Actuator& first = parts.actuators.at(index);
    const std::string subject = "actuator " + inQuotes(first.name);
    const int axis = axisOf(plane);
    Image over{glm::mat3(1.0F), glm::vec3(0.0F), subject};
    over.turn[axis][axis] = -1.0F;
    over.way[axis] = 2.0F * middleOf(parts, axis);
    Actuator image = imageOf(parts, index, VertexFinder(parts.restMesh.positions), over);
    if (sameVertices(image, first))
        throw InvalidInput(subject, "it lies across the middle and is its own mirror image",
                           "choose one that lies on one side");
    MirroredActuator result{parts, 0, false};
    std::tie(result.actuator, result.added) = place(result.parts, std::move(image), first.name + " mirrored");
    return result;
}

ActuatorCopies copiesAround(const RigParts& parts, std::size_t index, int count) {
    validate(parts);
    const std::string subject = "actuator " + inQuotes(parts.actuators.at(index).name);
    requireCount(count, subject);
    const glm::vec3 middle(middleOf(parts, 0), 0.0F, middleOf(parts, 2));
    std::vector<Image> images;
    for (int i = 1; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        const glm::mat3 turn(glm::mat3_cast(glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0))));
        images.push_back({turn, middle - turn * middle, subject});
    }
    return copies(parts, index, images);
}

ActuatorCopies copiesAlong(const RigParts& parts, std::size_t index, int count, const glm::vec3& step) {
    validate(parts);
    const std::string subject = "actuator " + inQuotes(parts.actuators.at(index).name);
    requireCount(count, subject);
    if (!(glm::length(step) > 2.0F * kNear) || !std::isfinite(glm::length(step)))
        throw InvalidInput(subject, "the way from copy to copy is too short", "give more than a millimetre");
    std::vector<Image> images;
    for (int i = 1; i < count; ++i) images.push_back({glm::mat3(1.0F), static_cast<float>(i) * step, subject});
    return copies(parts, index, images);
}

MirrorPlane mirrorPlaneOf(const RigParts& parts, std::size_t actuator) {
    glm::dvec3 sum(0.0);
    const auto& influences = parts.actuators.at(actuator).influences;
    for (const Influence& influence : influences) sum += glm::dvec3(parts.restMesh.positions[influence.vertex]);
    const double count = std::max<double>(1.0, static_cast<double>(influences.size()));
    const double x = std::abs(sum.x / count - middleOf(parts, 0)), z = std::abs(sum.z / count - middleOf(parts, 2));
    return x >= z ? MirrorPlane::acrossX : MirrorPlane::acrossZ;
}

} // namespace lumorph

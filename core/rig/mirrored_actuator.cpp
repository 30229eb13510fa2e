#include "core/rig/mirrored_actuator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rig/rig_validation.h"

namespace lumorph {
namespace {

constexpr float kNear = 0.0005F; // metres

int axisOf(MirrorPlane plane) { return plane == MirrorPlane::acrossX ? 0 : 2; }

glm::vec3 turnedOver(glm::vec3 vector, int axis) {
    vector[axis] = -vector[axis];
    return vector;
}

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

/// Turning is seen reversed in a mirror: an axis is turned over the other way round than a direction.
struct TurnOver {
    float middle;
    int axis;
    const std::string& subject;

    [[nodiscard]] glm::vec3 place(glm::vec3 point) const {
        point[axis] = 2.0F * middle - point[axis];
        return point;
    }
    void operator()(Hinge& hinge) const {
        hinge.origin = place(hinge.origin);
        hinge.axis = -turnedOver(hinge.axis, axis);
    }
    void operator()(Bend& bend) const {
        bend.origin = place(bend.origin);
        bend.axis = -turnedOver(bend.axis, axis);
        bend.direction = turnedOver(bend.direction, axis);
    }
    void operator()(Slide& slide) const { slide.direction = turnedOver(slide.direction, axis); }
    void operator()(MorphTarget& morph) const {
        for (auto& displacements : morph.displacements)
            for (glm::vec3& displacement : displacements) displacement = turnedOver(displacement, axis);
    }
    void operator()(SkinJoint&) const {
        throw InvalidInput(subject, "it turns a joint of the skin, which has no mirror image here",
                           "add the joint on the other side in the program that the model was made with");
    }
};

/// Influences on the mirrored vertices, ascending, with the displacements of a morph target in the same order.
void moveInfluences(Actuator& actuator, const VertexFinder& vertices, const std::vector<glm::vec3>& positions,
                    const TurnOver& over) {
    std::vector<std::pair<std::uint32_t, std::size_t>> images; // vertex, which influence
    for (std::size_t i = 0; i < actuator.influences.size(); ++i) {
        const auto image = vertices.at(over.place(positions[actuator.influences[i].vertex]));
        if (!image)
            throw InvalidInput(over.subject, "the mesh is not the same on the other side",
                               "mirror the mesh first, or add the actuator by hand");
        images.emplace_back(*image, i);
    }
    std::ranges::sort(images);
    for (std::size_t i = 1; i < images.size(); ++i)
        if (images[i].first == images[i - 1].first)
            throw InvalidInput(over.subject, "two of its vertices have the same mirror image", "clean the mesh first");
    const std::vector<Influence> before = actuator.influences;
    for (std::size_t i = 0; i < images.size(); ++i)
        actuator.influences[i] = {images[i].first, before[images[i].second].weight};
    if (auto* morph = std::get_if<MorphTarget>(&actuator.deformer))
        for (auto& displacements : morph->displacements) {
            const auto old = displacements;
            for (std::size_t i = 0; i < images.size(); ++i) displacements[i] = old[images[i].second];
        }
}

std::string freeName(const RigParts& parts, const std::string& name) {
    const auto taken = [&](const std::string& one) {
        return std::ranges::any_of(parts.actuators, [&](const Actuator& a) { return a.name == one; });
    };
    std::string free = name + " mirrored";
    for (int i = 2; taken(free); ++i) free = name + " mirrored " + std::to_string(i);
    return free;
}

bool sameVertices(const Actuator& a, const Actuator& b) {
    return std::ranges::equal(a.influences, b.influences, {}, &Influence::vertex, &Influence::vertex);
}

float middleOf(const RigParts& parts, int axis) {
    const Box box = boundingBox(parts.restMesh.positions);
    return 0.5F * (box.min[axis] + box.max[axis]);
}

} // namespace

MirroredActuator mirroredActuator(const RigParts& parts, std::size_t index, MirrorPlane plane) {
    validate(parts); // while they are edited they may be no rig
    const Actuator& first = parts.actuators.at(index);
    const std::string subject = "actuator " + inQuotes(first.name);
    const TurnOver over{middleOf(parts, axisOf(plane)), axisOf(plane), subject};
    Actuator image = first;
    std::visit(over, image.deformer);
    moveInfluences(image, VertexFinder(parts.restMesh.positions), parts.restMesh.positions, over);
    if (sameVertices(image, first))
        throw InvalidInput(subject, "it lies across the middle and is its own mirror image",
                           "choose one that lies on one side");
    MirroredActuator result{parts, 0, false};
    auto& actuators = result.parts.actuators;
    const auto there = std::ranges::find_if(actuators, [&](const Actuator& a) { return sameVertices(a, image); });
    result.added = there == actuators.end();
    if (result.added) {
        image.name = freeName(parts, first.name);
        image.drive.channel = -1;
        result.actuator = actuators.size();
        actuators.push_back(std::move(image));
    } else {
        image.name = there->name;
        image.drive = there->drive;
        result.actuator = static_cast<std::size_t>(there - actuators.begin());
        *there = std::move(image);
    }
    return result;
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

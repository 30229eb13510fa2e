#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/rig/compiled_sheet.h"
#include "core/rig/motion_setup.h"
#include "core/rig/rig.h"

namespace lumorph {

/// One actuator on a vertex's way.
struct MotionStep {
    std::uint16_t actuator = 0;
    float weight = 0.0F;
    std::uint32_t influence = 0; ///< index into the actuator's influences
};

/// A rig's parts with what deformation needs looked up: for every vertex its steps in order.
struct RigCore {
    explicit RigCore(RigParts rigParts);
    RigCore(const RigCore&) = delete; // `sheet` refers to `parts`
    RigCore& operator=(const RigCore&) = delete;

    RigParts parts;
    std::vector<CompiledActuator> actuators;
    std::vector<std::uint16_t> skinActuators;
    std::vector<std::uint32_t> stepStart; ///< vertices + 1
    std::vector<MotionStep> steps;        ///< morph targets first, then hinges, bends and slides in order
    std::vector<bool> skinMoves;          ///< empty without joint actuators, else one a vertex
    std::optional<CompiledSheet> sheet;

    [[nodiscard]] std::span<const MotionStep> stepsOf(std::uint32_t vertex) const noexcept {
        return {steps.data() + stepStart[vertex], steps.data() + stepStart[vertex + 1]};
    }
};

/// A list of vertices compiled for deformation: vertices that share an actuator and a weight stand
/// together, so that a stroke's sine and cosine are worked out once for all of them.
class DeformProgram {
public:
    DeformProgram(std::shared_ptr<const RigCore> core, std::span<const std::uint32_t> vertices);

    [[nodiscard]] std::size_t size() const noexcept { return rest_.size(); }
    void run(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept;

private:
    enum class Zone : std::uint8_t {
        whole,    ///< whatever comes in
        arc,      ///< known from rest to lie in the arc of a bend
        straight, ///< ... beyond it
    };
    struct Run {
        std::uint16_t actuator = 0;
        Zone zone = Zone::whole;
        float weight = 0.0F;
        std::uint32_t first = 0;
        std::uint32_t count = 0;
        std::uint32_t firstLocal = 0; ///< into the bend coordinates, for arc and straight
    };
    struct Entry;

    void addRuns(std::vector<Entry>& entries, std::vector<Run>& runs);
    void runMorphs(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept;
    void runSheet(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept;
    void runSkin(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept;
    void runSpace(const Run& run, const MotionSetup& setup, std::span<glm::vec3> out) const noexcept;
    void runBend(const Run& run, const MotionSetup& setup, std::span<glm::vec3> out) const noexcept;

    std::shared_ptr<const RigCore> core_;
    std::vector<glm::vec3> rest_;
    std::vector<Run> morphRuns_;
    std::vector<Run> spaceRuns_;
    std::vector<std::uint32_t> slots_;      ///< places in `out`, run after run
    std::vector<std::uint32_t> influences_; ///< beside slots_
    std::vector<float> bendU_;
    std::vector<float> bendH_;
    std::vector<glm::vec3> bendBase_;
    struct SkinnedSlot {
        std::uint32_t slot;
        std::uint32_t vertex;
    };
    std::vector<SkinnedSlot> skinned_;
    struct SheetSlot {
        std::uint16_t path;
        std::uint32_t slot;
        std::uint32_t row;
    };
    std::vector<SheetSlot> sheet_; ///< by path
};

/// The listed vertices without compiling them first; for lists used once.
void deformListed(const RigCore& core, std::span<const double> strokes, std::span<const std::uint32_t> vertices,
                  std::span<glm::vec3> out) noexcept;

} // namespace lumorph

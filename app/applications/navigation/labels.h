#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/applications/navigation/map.h"
#include "app/applications/navigation/view_ground.h"
#include "core/scene/scene.h"
#include "core/scene/scene_assets.h"

namespace lumorph {
class Font;
}

namespace lumorph::navigation {

inline constexpr int kFirstLabel = 100; ///< ids of items: a plate and its pole for each place, in their order

/// Names of places on plates that stand over them and always turn to who looks.
class Labels {
public:
    static constexpr double kPlateHeight = 0.0078; ///< metres
    static constexpr std::size_t kMost = 60;       ///< places that have a plate: those of the least rank
    static constexpr std::size_t kMostShown = 9;

    /// Writes the plates in all languages. Throws DataError where the font is missing.
    explicit Labels(const Map& map);

    /// Their models and pictures are added to these assets.
    void addTo(SceneAssets& assets) const;

    /// Chooses whose names in a language there is room for, seen by an eye (device metres), and moves them there.
    void arrange(const Map& map, const ViewGround& ground, const glm::dvec3& eye, Language language, double seconds);
    /// Adds the items of those that show.
    void show(Scene& scene) const;

private:
    /// What stands on a plate.
    struct Writing {
        double width = 0.0; ///< of the plate, metres
        std::string model;
        Material material;
        std::shared_ptr<const SceneModel> shape;
        std::shared_ptr<const Image> picture;
    };
    struct Plate {
        std::size_t place = 0;
        std::array<Writing, 2> writings; ///< by Language; of a name that is the same in both they share all
        Language language = Language::english;
        [[nodiscard]] const Writing& writing() const noexcept { return writings[static_cast<std::size_t>(language)]; }

        glm::dvec3 foot{0.0}, middle{0.0};
        glm::dvec3 before{0.0}; ///< on the way from the middle to the eye: there no house hides it
        double size = 1.0;      ///< by which it is as large for the eye there
        glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
        double opacity = 0.0, lift = 0.0; ///< metres over its pole's shortest
        glm::dvec2 shift{0.0};            ///< in x and z, so that none of it reaches over the device's rim
        bool wanted = false;
    };
    [[nodiscard]] static Writing write(const Font& font, const std::string& text, const std::string& model);
    struct Room {
        double lift = 0.0;
        glm::dvec2 shift{0.0};
    };
    [[nodiscard]] std::optional<Room> findRoom(const Plate& plate, const std::vector<const Plate*>& before,
                                               const glm::dvec3& eye) const;

    std::vector<Plate> plates_; ///< the least rank first
};

/// By how much a plate must be moved in x and z so that the eye sees all of it before the device's top, at a height of
/// the top; nothing where it would be too far from its place.
[[nodiscard]] std::optional<glm::dvec2> shiftToTop(const glm::dvec3& middle, double width, const glm::dvec3& eye,
                                                   double top) noexcept;

/// The rotation of a plate whose picture faces +z with its text along +x, so that an eye reads it upright.
[[nodiscard]] glm::dquat facing(const glm::dvec3& from, const glm::dvec3& eye) noexcept;

} // namespace lumorph::navigation

#pragma once

#include <memory>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/base/units.h"
#include "core/geometry/calibrated_camera.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// How light reaches one place on a device, over all its joint states.
struct LightAt {
    glm::vec3 place{0.0F}; ///< at rest, world metres
    double area = 0.0;     ///< square metres that it stands for
    double lit = 0.0;      ///< share of the joint states in which light arrives
    /// Pixels a millimetre along the direction in which they are farthest apart, in the worst state that is lit; 0
    /// where none is.
    double pixelsPerMillimetre = 0.0;
    Angle incidence; ///< between light and surface normal, in the worst state that is lit
    /// What a point of the picture becomes along the direction in which it is spread most, in the worst state that is
    /// lit, metres.
    double blur = 0.0;
};

/// Light on a whole device.
struct LightMap {
    bool blurKnown = false; ///< the aperture of one of the lenses was given
    std::vector<LightAt> places;
    double lit = 0.0;                 ///< share of area and states
    double pixelsPerMillimetre = 0.0; ///< that 95 % of the area that is ever lit have at least
    Angle incidence;                  ///< that 95 % of it have at most
    double blur = 0.0;                ///< metres that 95 % of it have at most
    /// Of each projector: the distance at which it is focused best for all that it lights over all states, metres; 0
    /// where it lights nothing.
    std::vector<double> bestFocus;
    double worth = 0.0; ///< what a plan makes as large as it can; see LightWish
};

/// What is expected of light.
struct LightWish {
    double pixelsPerMillimetre = 2.0;           ///< more is worth no more
    Angle mostIncidence = Angle::degrees(70.0); ///< beyond it light is spread so thinly that it counts as none
    double mostBlur = 0.001;                    ///< metres; a map's worst colour
};

/// A device as light meets it: the side that looks up at rest and lies open, in a number of joint states, which also
/// shadow it.
///
/// `worth` of a LightMap is the mean over area and states of min(pixels a millimetre / wished for, 1), 0 where no light
/// arrives. Where several projectors light a place, the one with the most pixels counts.
class LitDevice {
public:
    /// Rest, each actuator alone at full stroke, all together, and `randomStates` random ones (seeded); `places` at
    /// most. Throws InvalidInput for a rig without a triangle that looks up, Cancelled.
    LitDevice(const Rig& rig, const glm::mat4& worldFromDevice, int randomStates = 8, std::size_t places = 1000,
              const Progress& progress = {});
    ~LitDevice();
    LitDevice(LitDevice&&) noexcept;
    LitDevice& operator=(LitDevice&&) noexcept;

    /// Light and sight go the same way: of a camera it tells how the camera sees the device, in its own pixels.
    /// `focus`: of each projector; of those that have none nothing is blurred.
    [[nodiscard]] LightMap lightOf(std::span<const CalibratedCamera> projectors, const LightWish& wish = {},
                                   std::span<const LensFocus> focus = {}) const;
    /// The corners of the box that holds it in every state looked at, world metres.
    [[nodiscard]] std::vector<glm::vec3> corners() const;
    [[nodiscard]] std::size_t states() const noexcept;
    /// Which of the map's places each triangle of the rest mesh is counted with; -1: it does not look up.
    [[nodiscard]] const std::vector<int>& placeOfTriangle() const noexcept;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// The blur of a point on a surface across a projector's axis, as it was measured.
struct MeasuredBlur {
    double distance = 0.0; ///< metres along the axis
    double blur = 0.0;     ///< metres across
};

/// The lens that blurs so, by least squares: `aperture` and `focusDistance` of LensFocus. Throws InvalidInput for fewer
/// than three distances, figures that are none, or blur that does not change with the distance.
[[nodiscard]] LensFocus lensFocusOf(std::span<const MeasuredBlur> measured);

/// A projector's lens as data sheets describe it.
struct ProjectorLens {
    glm::ivec2 size{1920, 1080}; ///< pixels
    /// Distance divided by the picture's width, at either end of the zoom.
    double throwLeast = 1.2;
    double throwMost = 1.2;
    /// How far the picture's middle lies above the lens' axis, in picture heights: of a projector whose picture begins
    /// at its axis 0.5. Fixed.
    double shift = 0.0;
};

/// The camera of a lens at a place that lights all points with the middle of its picture towards the middle of their
/// box: zoomed in as far as the picture still holds them, or out as far as it goes. `turned`: on its side.
[[nodiscard]] CalibratedCamera aimedProjector(const ProjectorLens& lens, const glm::dvec3& place,
                                              std::span<const glm::vec3> points, bool turned = false);

/// Where a projector should hang.
struct ProjectorPlace {
    CalibratedCamera camera;
    double throwRatio = 0.0;
    bool turned = false;
    LightMap light; ///< with the projectors that are there already
};

/// The place within a box (world metres) from which a lens lights a device best, beside the projectors that hang
/// already: the best of evenly spread places, and from the three best of them as long as a small step helps.
/// Throws InvalidInput for a lens or bounds that are none, Cancelled.
[[nodiscard]] ProjectorPlace bestProjectorPlace(const LitDevice& device, const ProjectorLens& lens,
                                                const glm::dvec3& boundsLow, const glm::dvec3& boundsHigh,
                                                std::span<const CalibratedCamera> others = {},
                                                const LightWish& wish = {}, const Progress& progress = {});

} // namespace lumorph

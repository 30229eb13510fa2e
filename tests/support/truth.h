#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/lab/lab.h"
#include "calibration/lab/lab_light.h"

namespace lumorph::test {

/// One arrangement in the virtual lab: what stands there, what lights it, who looks.
struct TruthSetup {
    TriangleMesh device; ///< world metres
    TriangleMesh table;
    InstalledProjector projector;
    CalibratedCamera eye;
    int fine = 3;    ///< rays along the side of a projector pixel
    int around = 60; ///< projector pixels around the device that are judged too
    int samples = 1; ///< rays along the side of an eye pixel
};

/// Judges a projector's picture: lights the lab with it, looks from the eye, and compares with the eye picture
/// low-passed on the surface by the projector's footprint (a projector pixel's box convolved with the lens's tent).
///
/// Judged is surface that the eye sees and the projector lights, except
/// - within 2 projector pixels of where either ends. There a projector pixel lies on two surfaces, or on one that only
///   half belongs to the eye, and no value can be right for both (BandBench judges which is best); and the low-pass
///   kernel, 1.5 pixels wide to either side, would reach over the edge;
/// - where light comes in at more than 70 degrees. A projector of peak 3 cannot reach white beyond acos(1/3) = 70.5
///   degrees at its reference distance, and the program warns of such places;
/// - the outermost 3 % of the eye's frame, where its picture fades into that of the table on purpose;
/// - table farther than `around` projector pixels from the device, for speed: it is all alike.
class TruthBench {
public:
    static constexpr double kBand = 2.0;                  ///< projector pixels
    static constexpr double kSteepestIncidence = 0.34202; ///< cosine of 70 degrees
    static constexpr double kFrame = 0.03;                ///< of the eye's frame
    static constexpr int kDevice = 0;                     ///< its number among the lab's surfaces

    explicit TruthBench(const TruthSetup& setup);
    ~TruthBench();

    [[nodiscard]] const Lab& lab() const;
    [[nodiscard]] const CalibratedCamera& eye() const;
    /// What the eye's rays meet.
    [[nodiscard]] const LabSight& sight() const;
    [[nodiscard]] const InstalledProjector& projector() const;
    /// Whether a pixel of the projector lies in the band beside an edge, near enough to the device to be judged.
    [[nodiscard]] bool besideEdge(glm::ivec2 pixel) const;
    /// One an eye pixel: 1 where it is judged.
    [[nodiscard]] const std::vector<std::uint8_t>& judged() const;
    [[nodiscard]] std::size_t judgedPixels() const;
    /// 1 where device is judged.
    [[nodiscard]] std::vector<std::uint8_t> judgedDevice() const;

    /// What a perfect renderer would send: for each projector pixel the average over its footprint of the eye picture
    /// (of places the eye sees), compensated for incidence and distance.
    [[nodiscard]] Image ideal(const LabPicture& eyePicture) const;
    /// The eye picture as the projector's footprint lets it through; judged pixels alone are meaningful.
    [[nodiscard]] LabPicture lowPassed(const LabPicture& eyePicture) const;
    /// What the eye sees when the projector sends a picture.
    [[nodiscard]] LabPicture seen(const Image& projected);

    /// Points on judged device surface, about `spacing` projector pixels apart.
    [[nodiscard]] std::vector<glm::dvec3> devicePoints(int spacing) const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Peak signal to noise ratio in decibels over the marked pixels, of sRGB values (what a screen or a person's lightness
/// compares), peak 1. At most 100.
[[nodiscard]] double psnr(const LabPicture& one, const LabPicture& other, std::span<const std::uint8_t> marked);

/// A picture an eye would see if each surface point had a colour (linear light).
[[nodiscard]] LabPicture painted(const Lab& lab, const CalibratedCamera& eye,
                                 const std::function<glm::vec3(const Lab::Hit&)>& color);

/// An sRGB picture as light.
[[nodiscard]] LabPicture lightOf(const Image& image);

/// Distances in pixels between the centres of light of spots in two pictures. A spot counts where its window of
/// `reach` pixels to either side is marked throughout and dark at its rim in both pictures, and holds light.
[[nodiscard]] std::vector<double> spotErrors(const LabPicture& one, const LabPicture& other,
                                             std::span<const glm::dvec2> spots, int reach,
                                             std::span<const std::uint8_t> marked);

/// The mean, and the value below which a share of all lies. 0 for none.
[[nodiscard]] double meanOf(std::span<const double> values);
[[nodiscard]] double quantileOf(std::vector<double> values, double share);

} // namespace lumorph::test

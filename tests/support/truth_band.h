#pragma once

#include <array>
#include <vector>

#include "tests/support/truth.h"

namespace lumorph::test {

/// Squared errors of linear light, summed over rays and channels.
struct BandError {
    double rendered = 0.0;
    double least = 0.0; ///< that no choice of the band's projector pixels undercuts

    [[nodiscard]] double ratio() const { return rendered / least; }
    BandError& operator+=(const BandError& other) {
        rendered += other.rendered;
        least += other.least;
        return *this;
    }
};

/// Judges what TruthBench leaves out: the projector pixels within its band beside edges, which lie on two surfaces. All
/// that they light for the eye is compared with the eye picture itself, and with the least squared error that values in
/// [0, 1] for these pixels reach when all others keep theirs: a box-constrained least squares solved from the ray
/// caster alone.
class BandBench {
public:
    /// The bench must outlive it. `samples`: rays along the side of an eye pixel. Few would make the least too small:
    /// a projector pixel that a single ray meets is right for that ray.
    explicit BandBench(const TruthBench& bench, int samples = 3);

    [[nodiscard]] BandError error(const LabPicture& eyePicture, const Image& projected) const;
    [[nodiscard]] std::size_t rays() const { return rays_.size(); }

    /// A ray of the eye that pixels of the band light.
    struct Ray {
        glm::vec2 eyePixel{0.0F};
        glm::ivec2 corner{0};           ///< the first of the four projector pixels whose light it sees
        std::array<float, 4> weights{}; ///< share of each one's light
    };

private:
    const TruthBench& bench_;
    std::vector<std::uint8_t> band_; ///< one a projector pixel
    std::vector<Ray> rays_;
};

} // namespace lumorph::test

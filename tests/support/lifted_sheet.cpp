#include "tests/support/lifted_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

namespace lumorph::test {

namespace {

constexpr int kLevers = 6;
constexpr double kHalfWidth = 0.1, kHalfDepth = 0.135; // metres
constexpr double kBody = 0.03;
constexpr double kLift = 0.04;
constexpr double kPull = 0.006;
const Angle kLow = Angle::degrees(12.0), kHigh = Angle::degrees(64.0);

constexpr std::array<glm::dvec2, kLevers> kPlaces{{{-kHalfWidth, kHalfDepth},
                                                   {kHalfWidth, kHalfDepth},
                                                   {-kHalfWidth, -kHalfDepth},
                                                   {kHalfWidth, -kHalfDepth},
                                                   {-kHalfWidth, 0.0},
                                                   {kHalfWidth, 0.0}}};

/// How far a lever lifts its place, as a share of its lift at full stroke.
double liftAt(double stroke) {
    const double low = std::sin(kLow.inRadians());
    const double angle = std::lerp(kLow.inRadians(), kHigh.inRadians(), stroke);
    return (std::sin(angle) - low) / (std::sin(kHigh.inRadians()) - low);
}

/// 0 on the pad in the middle, 1 away from it.
double freeOfPad(const glm::dvec2& place) {
    const double far = glm::length(place / glm::dvec2(0.6 * kHalfWidth, 0.6 * kHalfDepth));
    const double t = std::clamp(far - 0.5, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// How much of a lever's lift reaches a place.
double follow(int lever, const glm::dvec2& place) {
    const double far = glm::length((place - kPlaces[static_cast<std::size_t>(lever)]) / glm::dvec2(0.11, 0.12));
    return freeOfPad(place) * std::exp(-far * far);
}

/// Modes of one place: the lifts, the products of two, and the squares.
std::vector<glm::vec3> modesAt(const glm::dvec2& place) {
    std::vector<glm::vec3> modes;
    for (int a = 0; a < kLevers; ++a) modes.emplace_back(0.0, kLift * follow(a, place), 0.0);
    for (int a = 0; a < kLevers; ++a)
        for (int b = 0; b < a; ++b) modes.emplace_back(0.0, -kLift * follow(a, place) * follow(b, place), 0.0);
    for (int a = 0; a < kLevers; ++a) {
        const glm::dvec2 in = -kPull * follow(a, place) * glm::normalize(kPlaces[static_cast<std::size_t>(a)]);
        modes.emplace_back(in.x, 0.0, in.y);
    }
    return modes;
}

std::vector<float> coefficientsAt(const std::array<double, kLevers>& strokes) {
    std::vector<float> values;
    std::array<double, kLevers> lift{};
    for (std::size_t a = 0; a < kLevers; ++a) lift[a] = strokes[a] == 0.0 ? 0.0 : liftAt(strokes[a]);
    for (const double one : lift) values.push_back(static_cast<float>(one));
    for (std::size_t a = 0; a < kLevers; ++a)
        for (std::size_t b = 0; b < a; ++b) values.push_back(static_cast<float>(lift[a] * lift[b]));
    for (const double one : lift) values.push_back(static_cast<float>(one * one));
    return values;
}

class SheetBuilder {
public:
    RigParts build() {
        parts_.name = "lifted sheet";
        parts_.pathInside = true;
        SheetModes& modes = parts_.sheet.emplace().modes;
        modes.strokes.assign(kLevers, {0.0F, 0.5F, 1.0F});
        for (std::size_t state = 0; state < modes.stateCount(); ++state) {
            std::array<double, kLevers> strokes{};
            for (std::size_t axis = kLevers, left = state; axis-- > 0; left /= 3)
                strokes[axis] = 0.5 * static_cast<double>(left % 3);
            const auto values = coefficientsAt(strokes);
            modes.coefficients.insert(modes.coefficients.end(), values.begin(), values.end());
            modes.modeCount = values.size();
        }
        addTop();
        addSides();
        for (int a = 0; a < kLevers; ++a) {
            Actuator actuator;
            actuator.name = "lever " + std::to_string(a + 1);
            actuator.deformer = SheetLift{a, kLow, kHigh};
            parts_.actuators.push_back(std::move(actuator));
        }
        return std::move(parts_);
    }

private:
    std::uint32_t vertex(const glm::vec3& place, std::uint32_t row, float share) {
        parts_.restMesh.positions.push_back(place);
        parts_.sheet->followers.push_back({row, share});
        return static_cast<std::uint32_t>(parts_.restMesh.positions.size()) - 1;
    }
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        parts_.restMesh.triangles.emplace_back(a, b, c);
        parts_.restMesh.triangles.emplace_back(a, c, d);
    }
    static glm::dvec2 placeOf(int column, int row) {
        return {kHalfWidth * (2.0 * column / (kSheetColumns - 1) - 1.0),
                kHalfDepth * (2.0 * row / (kSheetRows - 1) - 1.0)};
    }
    static std::uint32_t at(int column, int row) { return static_cast<std::uint32_t>(row * kSheetColumns + column); }

    void addTop() {
        for (int j = 0; j < kSheetRows; ++j)
            for (int i = 0; i < kSheetColumns; ++i) {
                const glm::dvec2 p = placeOf(i, j);
                vertex({p.x, kBody, p.y}, at(i, j), 1.0F);
                for (const glm::vec3& mode : modesAt(p)) parts_.sheet->modes.modes.push_back(mode);
            }
        for (int j = 0; j + 1 < kSheetRows; ++j)
            for (int i = 0; i + 1 < kSheetColumns; ++i) quad(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    }

    /// From the rim down: the shares of its path, the rim at rest, the foot.
    void addSides() {
        std::vector<std::uint32_t> rim;
        for (int i = 0; i + 1 < kSheetColumns; ++i) rim.push_back(at(i, 0));
        for (int j = 0; j + 1 < kSheetRows; ++j) rim.push_back(at(kSheetColumns - 1, j));
        for (int i = kSheetColumns - 1; i > 0; --i) rim.push_back(at(i, kSheetRows - 1));
        for (int j = kSheetRows - 1; j > 0; --j) rim.push_back(at(0, j));
        std::vector<std::uint32_t> above = rim;
        const auto addRing = [&](auto&& make) {
            std::vector<std::uint32_t> ring;
            for (const std::uint32_t row : rim) ring.push_back(make(row));
            for (std::size_t k = 0; k < ring.size(); ++k) {
                const std::size_t next = (k + 1) % ring.size();
                quad(above[k], above[next], ring[next], ring[k]);
            }
            above = std::move(ring);
        };
        for (int share = kSkirtShares; share-- > 1;)
            addRing([&](std::uint32_t row) {
                return vertex(parts_.restMesh.positions[row], row, static_cast<float>(share) / kSkirtShares);
            });
        addRing([&](std::uint32_t row) { return vertex(parts_.restMesh.positions[row], SheetMotion::kNoRow, 1.0F); });
        addRing([&](std::uint32_t row) {
            const glm::vec3 p = parts_.restMesh.positions[row];
            return vertex({p.x, 0.0F, p.z}, SheetMotion::kNoRow, 1.0F);
        });
        const std::uint32_t middle = vertex(glm::vec3(0.0F), SheetMotion::kNoRow, 1.0F);
        for (std::size_t k = 0; k < above.size(); ++k)
            parts_.restMesh.triangles.emplace_back(middle, above[k], above[(k + 1) % above.size()]);
    }

    RigParts parts_;
};

} // namespace

RigParts liftedSheetParts() { return SheetBuilder().build(); }

} // namespace lumorph::test

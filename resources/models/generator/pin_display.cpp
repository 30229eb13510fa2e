#include <string>

#include "resources/models/generator/models.h"

namespace lumorph {
namespace {

// Metres.
constexpr int kPins = 30;
constexpr double kPitch = 0.005;
constexpr double kPin = 0.0047;
constexpr double kBorder = 0.0013; ///< of plate around the outermost pitch
constexpr double kPlate = 0.049;   ///< its top
constexpr double kProud = 0.001;   ///< a pin at rest stands this much above the plate
constexpr double kStroke = 0.1;

/// Coordinates of the pins' sides: two a pin.
double line(int index) {
    const double first = -0.5 * kPins * kPitch + 0.5 * (kPitch - kPin);
    return first + (index / 2) * kPitch + (index % 2) * kPin;
}

class PinDisplayBuilder {
public:
    Rig build() {
        for (int j = 0; j < kLines; ++j)
            for (int i = 0; i < kLines; ++i) mesh_.positions.emplace_back(line(i), kPlate, line(j));
        for (int j = 0; j + 1 < kLines; ++j)
            for (int i = 0; i + 1 < kLines; ++i)
                if (i % 2 == 0 && j % 2 == 0)
                    addPin(i, j);
                else
                    addQuad(foot(i, j + 1), foot(i + 1, j + 1), foot(i + 1, j), foot(i, j));
        addPlate();
        parts_.name = "pin display";
        parts_.restMesh = std::move(mesh_);
        parts_.pathInside = true;
        return Rig(std::move(parts_));
    }

private:
    static constexpr int kLines = 2 * kPins;

    static std::uint32_t foot(int i, int j) { return static_cast<std::uint32_t>(j * kLines + i); }

    std::uint32_t addVertex(double x, double y, double z) {
        mesh_.positions.emplace_back(x, y, z);
        return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
    }

    /// Counter-clockwise seen from outside.
    void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh_.triangles.emplace_back(a, b, c);
        mesh_.triangles.emplace_back(a, c, d);
    }

    void addPin(int i, int j) {
        const std::uint32_t feet[4]{foot(i, j + 1), foot(i + 1, j + 1), foot(i + 1, j), foot(i, j)};
        std::uint32_t tops[4];
        Actuator actuator;
        actuator.name = "pin " + std::to_string(j / 2 + 1) + "." + std::to_string(i / 2 + 1);
        for (int k = 0; k < 4; ++k) {
            const glm::vec3 at = mesh_.positions[feet[k]];
            tops[k] = addVertex(at.x, kPlate + kProud, at.z);
            actuator.influences.push_back({tops[k], 1.0F});
        }
        addQuad(tops[0], tops[1], tops[2], tops[3]);
        for (int k = 0; k < 4; ++k) addQuad(feet[k], feet[(k + 1) % 4], tops[(k + 1) % 4], tops[k]);
        actuator.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.0, kStroke};
        actuator.levels = 101;
        actuator.maxVelocity = 2.0;
        actuator.drive.channel = (j / 2) * kPins + i / 2;
        parts_.actuators.push_back(std::move(actuator));
    }

    /// The border around the pins, the plate's sides and its bottom.
    void addPlate() {
        const double half = 0.5 * kPins * kPitch + kBorder;
        const double x[4]{-half, half, half, -half};
        const double z[4]{half, half, -half, -half};
        std::uint32_t low[4];
        std::uint32_t high[4];
        for (int k = 0; k < 4; ++k) {
            low[k] = addVertex(x[k], 0.0, z[k]);
            high[k] = addVertex(x[k], kPlate, z[k]);
        }
        const int last = kLines - 1;
        for (int k = 0; k < 4; ++k) {
            const int next = (k + 1) % 4;
            addQuad(low[k], low[next], high[next], high[k]);
            // Along this side the border is a fan from the next corner, closed by one triangle.
            const auto along = [&](int step) {
                switch (k) {
                case 0:
                    return foot(step, last);
                case 1:
                    return foot(last, last - step);
                case 2:
                    return foot(last - step, 0);
                default:
                    return foot(0, step);
                }
            };
            mesh_.triangles.emplace_back(high[k], high[next], along(0));
            for (int step = 0; step < last; ++step)
                mesh_.triangles.emplace_back(along(step), high[next], along(step + 1));
        }
        addQuad(low[0], low[3], low[2], low[1]);
    }

    TriangleMesh mesh_;
    RigParts parts_;
};

} // namespace

Rig pinDisplayRig() { return PinDisplayBuilder().build(); }

} // namespace lumorph

#include <string>

#include "core/base/error.h"
#include "core/rig/templates/bundled_rigs.h"

namespace lumorph {
namespace {

// Metres.
constexpr double kBorder = 0.0013; ///< of plate around the outermost pitch
constexpr double kProud = 0.001;   ///< a pin at rest stands this much above the plate
constexpr int kMaxPins = 10'000;

void requirePins(bool good, const char* parameter, const char* why, const char* remedy) {
    if (!good) throw InvalidInput(std::string("pins: ") + parameter, why, remedy);
}

void checkPins(const PinDisplaySize& size) {
    requirePins(size.columns >= 1 && size.rows >= 1, "columns, rows", "no pin would be left", "choose 1 or more");
    requirePins(size.columns * static_cast<long long>(size.rows) <= kMaxPins, "columns, rows",
                "so many pins are too many", "choose at most 10000 in all");
    requirePins(size.pin >= 0.05, "pin", "the pins would vanish", "choose 0.05 cm or more");
    requirePins(size.pitch - size.pin >= 0.01, "pitch", "the pins would touch",
                "choose it at least 0.01 cm larger than a pin");
    requirePins(size.stroke >= 0.1, "stroke", "the pins would not move", "choose 0.1 cm or more");
    requirePins(size.plate >= 0.1, "plate", "the plate would vanish", "choose 0.1 cm or more");
}

class PinDisplayBuilder {
public:
    explicit PinDisplayBuilder(const PinDisplaySize& size)
        : columns_(size.columns), rows_(size.rows), pitch_(0.01 * size.pitch), pin_(0.01 * size.pin),
          stroke_(0.01 * size.stroke), plate_(0.01 * size.plate) {}

    Rig build() {
        for (int j = 0; j < 2 * rows_; ++j)
            for (int i = 0; i < 2 * columns_; ++i)
                mesh_.positions.emplace_back(line(i, columns_), plate_, line(j, rows_));
        for (int j = 0; j + 1 < 2 * rows_; ++j)
            for (int i = 0; i + 1 < 2 * columns_; ++i)
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
    /// Coordinates of the pins' sides: two a pin, of so many.
    [[nodiscard]] double line(int index, int pins) const {
        const double first = -0.5 * pins * pitch_ + 0.5 * (pitch_ - pin_);
        return first + (index / 2) * pitch_ + (index % 2) * pin_;
    }

    [[nodiscard]] std::uint32_t foot(int i, int j) const { return static_cast<std::uint32_t>(j * 2 * columns_ + i); }

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
            tops[k] = addVertex(at.x, plate_ + kProud, at.z);
            actuator.influences.push_back({tops[k], 1.0F});
        }
        addQuad(tops[0], tops[1], tops[2], tops[3]);
        for (int k = 0; k < 4; ++k) addQuad(feet[k], feet[(k + 1) % 4], tops[(k + 1) % 4], tops[k]);
        actuator.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.0, stroke_};
        actuator.levels = 101;
        actuator.maxVelocity = 2.0;
        actuator.drive.channel = (j / 2) * columns_ + i / 2;
        parts_.actuators.push_back(std::move(actuator));
    }

    /// The border around the pins, the plate's sides and its bottom.
    void addPlate() {
        const double halfX = 0.5 * columns_ * pitch_ + kBorder;
        const double halfZ = 0.5 * rows_ * pitch_ + kBorder;
        const double x[4]{-halfX, halfX, halfX, -halfX};
        const double z[4]{halfZ, halfZ, -halfZ, -halfZ};
        std::uint32_t low[4];
        std::uint32_t high[4];
        for (int k = 0; k < 4; ++k) {
            low[k] = addVertex(x[k], 0.0, z[k]);
            high[k] = addVertex(x[k], plate_, z[k]);
        }
        const int lastX = 2 * columns_ - 1;
        const int lastZ = 2 * rows_ - 1;
        for (int k = 0; k < 4; ++k) {
            const int next = (k + 1) % 4;
            addQuad(low[k], low[next], high[next], high[k]);
            // Along this side the border is a fan from the next corner, closed by one triangle.
            const auto along = [&](int step) {
                switch (k) {
                case 0:
                    return foot(step, lastZ);
                case 1:
                    return foot(lastX, lastZ - step);
                case 2:
                    return foot(lastX - step, 0);
                default:
                    return foot(0, step);
                }
            };
            mesh_.triangles.emplace_back(high[k], high[next], along(0));
            for (int step = 0; step < (k % 2 == 0 ? lastX : lastZ); ++step)
                mesh_.triangles.emplace_back(along(step), high[next], along(step + 1));
        }
        addQuad(low[0], low[3], low[2], low[1]);
    }

    int columns_;
    int rows_;
    double pitch_;
    double pin_;
    double stroke_;
    double plate_;
    TriangleMesh mesh_;
    RigParts parts_;
};

} // namespace

Rig pinDisplayRig(const PinDisplaySize& size) {
    checkPins(size);
    return PinDisplayBuilder(size).build();
}

} // namespace lumorph

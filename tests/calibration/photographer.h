#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "calibration/tracking/board_finder.h"
#include "core/loop/pose_stream.h"

namespace lumorph::test {

inline double degreesBetween(const glm::dquat& a, const glm::dquat& b) {
    return glm::degrees(2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b)))));
}

/// Takes pictures of a page that lies in the world, by rays: four a pixel, whose directions are found once.
class Photographer {
public:
    Photographer(const MarkerBoard& board, const CalibratedCamera& camera)
        : page_(BoardFinder::page(board, kFine)), from_(positionOf(camera)) {
        for (int y = 0; y < camera.size.y; ++y)
            for (int x = 0; x < camera.size.x; ++x)
                for (const glm::dvec2 part : {glm::dvec2(-0.25, -0.25), {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}})
                    ways_.push_back(directionOf(camera, glm::dvec2(x, y) + part));
    }

    [[nodiscard]] std::vector<std::uint8_t> picture(const glm::dmat4& worldFromBoard, double noise) const {
        const glm::dmat4 boardFromWorld = glm::inverse(worldFromBoard);
        const glm::dvec3 from(boardFromWorld * glm::dvec4(from_, 1.0));
        std::mt19937 random(7);
        std::normal_distribution<double> grain(0.0, noise);
        std::vector<std::uint8_t> grey;
        for (std::size_t i = 0; i < ways_.size(); i += 4) {
            double sum = 0.0;
            for (std::size_t k = i; k < i + 4; ++k) sum += lightAlong(from, glm::dmat3(boardFromWorld) * ways_[k]);
            grey.push_back(static_cast<std::uint8_t>(std::clamp(sum / 4.0 + grain(random), 0.0, 255.0)));
        }
        return grey;
    }

private:
    static constexpr double kFine = 4000.0; // pixels of the page a metre

    [[nodiscard]] double lightAlong(const glm::dvec3& from, const glm::dvec3& way) const {
        const glm::dvec3 at = from - way * (from.z / way.z);
        const int column = static_cast<int>(std::floor(at.x * kFine));
        const int row = page_.size().y - 1 - static_cast<int>(std::floor(at.y * kFine));
        const bool on = column >= 0 && row >= 0 && column < page_.size().x && row < page_.size().y;
        return on ? 20.0 + page_.at(column, row)[0] * 0.75 : 230.0;
    }

    Image page_;
    glm::dvec3 from_;
    std::vector<glm::dvec3> ways_;
};

} // namespace lumorph::test

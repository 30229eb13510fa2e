#include "calibration/verify/check_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

#include "calibration/lab/lab_world.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kLonger = 8.0;                                                         // times: arrows
constexpr double kReddest = 3e-3;                                                       // metres
constexpr int kCell = 44;                                                               // pixels between arrows
constexpr double kFineGrid = 0.01, kCoarseGrid = 0.05, kLine = 0.00045, kCross = 0.006; // metres

cv::Scalar colorOf(double metres) {
    const double share = std::clamp(metres / kReddest, 0.0, 1.0);
    return {40.0, 255.0 * std::min(1.0, 2.0 * (1.0 - share)), 255.0 * std::min(1.0, 2.0 * share)};
}

/// World x and z as pixels of a view from above.
class Plan {
public:
    Plan(const Box& box, int width) : low_(box.min), scale_(width / static_cast<double>(box.size().x)) {
        const int height = static_cast<int>(scale_ * static_cast<double>(box.size().z));
        whole_ = cv::Mat(kTop + height + kBottom, width, CV_8UC3, cv::Scalar(24, 21, 20));
        image_ = whole_(cv::Rect(0, kTop, width, height));
        image_.setTo(cv::Scalar(38, 34, 32));
    }
    [[nodiscard]] cv::Point at(const glm::dvec3& p) const {
        return {static_cast<int>(std::lround(scale_ * (p.x - static_cast<double>(low_.x)))),
                static_cast<int>(std::lround(scale_ * (p.z - static_cast<double>(low_.z))))};
    }
    [[nodiscard]] cv::Mat& image() { return image_; }
    [[nodiscard]] cv::Mat& whole() { return whole_; } ///< with room for words above and below

    static constexpr int kTop = 128, kBottom = 44; ///< pixels

private:
    glm::vec3 low_;
    double scale_;
    cv::Mat whole_, image_;
};

/// From below upwards, so that what lies on top hides the rest.
void drawDevice(Plan& plan, const TriangleMesh& mesh) {
    std::vector<glm::uvec3> order = mesh.triangles;
    const auto height = [&](const glm::uvec3& t) {
        return mesh.positions[t.x].y + mesh.positions[t.y].y + mesh.positions[t.z].y;
    };
    std::ranges::sort(order, {}, height);
    for (const glm::uvec3& t : order) {
        const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const glm::vec3 normal = glm::cross(b - a, c - a);
        const float length = glm::length(normal);
        if (!(length > 0.0F) || normal.y <= 0.0F) continue;
        const double shade = 70.0 + 60.0 * static_cast<double>(normal.y / length);
        const cv::Point corners[] = {plan.at(a), plan.at(b), plan.at(c)};
        cv::fillConvexPoly(plan.image(), corners, 3, cv::Scalar(shade, shade, shade));
    }
}

/// One arrow a cell of the picture: the mean of what was seen in it.
void drawArrows(Plan& plan, const std::vector<LightError>& map) {
    const int columns = plan.image().cols / kCell + 1, rows = plan.image().rows / kCell + 1;
    struct Sum {
        glm::dvec3 place{0.0}, beside{0.0};
        double count = 0.0;
    };
    std::vector<Sum> cells(static_cast<std::size_t>(columns * rows));
    for (const LightError& error : map) {
        const cv::Point at = plan.at(error.place);
        if (at.x < 0 || at.y < 0 || at.x >= plan.image().cols || at.y >= plan.image().rows) continue;
        Sum& cell = cells[static_cast<std::size_t>(at.y / kCell * columns + at.x / kCell)];
        cell.place += error.place;
        cell.beside += error.beside;
        cell.count += 1.0;
    }
    for (const Sum& cell : cells) {
        if (cell.count == 0.0) continue;
        const glm::dvec3 place = cell.place / cell.count, beside = cell.beside / cell.count;
        const cv::Scalar color = colorOf(glm::length(beside));
        const cv::Point from = plan.at(place - beside), to = plan.at(place - beside + kLonger * beside);
        cv::circle(plan.image(), from, 2, color, cv::FILLED, cv::LINE_AA);
        if (cv::norm(to - from) > 4.0) cv::arrowedLine(plan.image(), from, to, color, 2, cv::LINE_AA, 0, 0.25);
    }
}

void drawWords(Plan& plan, const RoomCheck& check) {
    char figures[120];
    std::snprintf(figures, sizeof figures,
                  "median %.1f mm, 95 %% within %.1f mm, worst %.1f mm; arrows 8 times as long", 1e3 * check.now.median,
                  1e3 * check.now.most, 1e3 * check.now.worst);
    const cv::Scalar ink(235, 235, 235);
    std::string first = check.sentence;
    std::vector<std::string> lines;
    constexpr std::size_t kLetters = 96;
    while (first.size() > kLetters) {
        const std::size_t blank = first.rfind(' ', kLetters);
        const bool isWord = blank == std::string::npos; // longer than a line
        lines.push_back(first.substr(0, isWord ? kLetters : blank));
        first.erase(0, isWord ? kLetters : blank + 1);
    }
    lines.push_back(first);
    lines.emplace_back(figures);
    for (std::size_t i = 0; i < lines.size(); ++i)
        cv::putText(plan.whole(), lines[i], {16, 30 + 26 * static_cast<int>(i)}, cv::FONT_HERSHEY_SIMPLEX, 0.62, ink, 1,
                    cv::LINE_AA);
    const int bottom = plan.whole().rows - 22;
    for (int i = 0; i <= 3; ++i) {
        const int x = 24 + 110 * i;
        cv::circle(plan.whole(), {x, bottom}, 7, colorOf(1e-3 * i), cv::FILLED, cv::LINE_AA);
        cv::putText(plan.whole(), std::to_string(i) + " mm", {x + 14, bottom + 6}, cv::FONT_HERSHEY_SIMPLEX, 0.55, ink,
                    1, cv::LINE_AA);
    }
}

Image imageOf(const cv::Mat& bgr) {
    Image image(glm::ivec2(bgr.cols, bgr.rows));
    for (int y = 0; y < bgr.rows; ++y)
        for (int x = 0; x < bgr.cols; ++x) {
            const auto& pixel = bgr.at<cv::Vec3b>(y, x);
            image.at(x, y) = {pixel[2], pixel[1], pixel[0], 255};
        }
    return image;
}

/// How far a number lies from the nearest multiple.
double fromLine(double value, double spacing) { return std::abs(value - spacing * std::round(value / spacing)); }

/// Light of the grid at a place, in [0, 255].
int gridAt(const glm::dvec3& place, bool isOnDevice) {
    const double x = fromLine(place.x, kCoarseGrid), z = fromLine(place.z, kCoarseGrid);
    if (!isOnDevice) return std::min(x, z) < kLine ? 110 : 0;
    if (std::max(x, z) < kCross && std::min(x, z) < 2.0 * kLine) return 255;
    return std::min(fromLine(place.x, kFineGrid), fromLine(place.z, kFineGrid)) < kLine ? 140 : 25;
}

} // namespace

Image errorPicture(const RoomCheck& check, const Rig& rig, const Installation& believed,
                   std::span<const double> strokes, int width) {
    const TriangleMesh device = deviceMesh(believed, rig, strokes);
    Box box = boundingBox(device.positions);
    const glm::vec3 around = 0.45F * std::max(box.size().x, box.size().z) * glm::vec3(1.6F, 0.0F, 0.6F);
    box.min -= around;
    box.max += around;
    Plan plan(box, width);
    drawDevice(plan, device);
    drawArrows(plan, check.map);
    drawWords(plan, check);
    return imageOf(plan.whole());
}

Image gridPicture(const Rig& rig, const Installation& believed, std::span<const double> strokes,
                  std::size_t projector) {
    if (projector >= believed.projectors.size())
        throw InvalidInput("projector " + std::to_string(projector), "the room has no such projector", "count from 0");
    const CalibratedCamera& lamp = believed.projectors[projector].camera;
    const RoomSurface surface(believed, rig, strokes);
    Installation lying = believed;
    lying.worldFromDevice = glm::mat4(1.0F);
    const RoomSurface rest(lying, rig, std::vector<double>(rig.actuatorCount(), 0.0));
    Image picture(lamp.size);
    tbb::parallel_for(0, lamp.size.y, [&](int y) {
        for (int x = 0; x < lamp.size.x; ++x) {
            const auto hit = surface.trace(positionOf(lamp), directionOf(lamp, {x, y}));
            if (!hit) continue;
            const glm::dvec3 place = hit->isOnDevice ? rest.counterpart(surface, *hit).point : hit->point;
            const auto light = static_cast<std::uint8_t>(gridAt(place, hit->isOnDevice));
            picture.at(x, y) = {light, light, light, 255};
        }
    });
    return picture;
}

} // namespace lumorph

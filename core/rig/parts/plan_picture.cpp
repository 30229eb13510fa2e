#include <cstdio>

#include <glm/common.hpp>

#include "core/rig/parts/plan_making.h"

namespace lumorph {
namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

/// y runs down the page.
std::string pathOf(const std::vector<PlanePolygon>& polygons) {
    std::string path;
    for (const PlanePolygon& polygon : polygons) {
        char command = 'M';
        for (const glm::dvec2& p : polygon) {
            path += command + number(p.x) + " " + number(-p.y);
            command = 'L';
        }
        path += "Z";
    }
    return path;
}

} // namespace

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '"')
            result += "&quot;";
        else
            result += c;
    }
    return result;
}

void PlanPicture::include(const glm::dvec2& p) {
    low_ = glm::min(low_, p);
    high_ = glm::max(high_, p);
}

void PlanPicture::add(const PlanePolygon& polygon, const char* kind) { add(std::vector<PlanePolygon>{polygon}, kind); }

void PlanPicture::add(const std::vector<PlanePolygon>& evenOdd, const char* kind) {
    for (const PlanePolygon& polygon : evenOdd)
        for (const glm::dvec2& p : polygon) include(p);
    body_ += std::string("<path class=\"") + kind + "\" d=\"" + pathOf(evenOdd) + "\"/>\n";
}

void PlanPicture::text(const glm::dvec2& at, const std::string& words) {
    body_ += "<text x=\"" + number(at.x) + "\" y=\"" + number(-at.y) + "\">" + escaped(words) + "</text>\n";
}

std::string PlanPicture::svg() const {
    const glm::dvec2 size = high_ - low_ + 4.0;
    return "<svg viewBox=\"" + number(low_.x - 2.0) + " " + number(-high_.y - 2.0) + " " + number(size.x) + " " +
           number(size.y) + "\" fill-rule=\"evenodd\">\n" + body_ + "</svg>\n";
}

std::string pictureOf(const LayeredSolid& solid) {
    PlanPicture picture;
    const std::size_t count = solid.layers.size();
    for (std::size_t k = 0; k < count; ++k) {
        static constexpr const char* kKinds[]{"layer1", "layer2", "layer3", "layer4"};
        picture.add(solid.layers[k].borders, kKinds[count == 1 ? 1 : 3 * k / (count - 1)]);
    }
    return picture.svg();
}

} // namespace lumorph

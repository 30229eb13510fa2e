#include "app/applications/navigation/city_json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_check.h"

namespace lumorph::navigation {
namespace {

using Json = nlohmann::json;
using Ring = std::vector<glm::dvec3>;
constexpr std::size_t kMostBytes = std::size_t{256} << 20U;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
    throw DataError(file.string(), why, "export it again as CityJSON 1.0 or later");
}

/// The outer rings of all surfaces in nested boundaries, whatever their depth: of a MultiSurface, a Solid, ...
void collectRings(const Json& boundaries, const std::vector<glm::dvec3>& vertices, std::vector<Ring>& rings) {
    if (!boundaries.is_array() || boundaries.empty()) return;
    const Json& first = boundaries.front();
    const bool surface = first.is_array() && !first.empty() && first.front().is_number_integer();
    if (!surface) {
        for (const Json& part : boundaries) collectRings(part, vertices, rings);
        return;
    }
    Ring ring;
    for (const Json& index : first) {
        if (!index.is_number_unsigned() || index.get<std::size_t>() >= vertices.size())
            throw std::out_of_range("a surface names a vertex that there is not");
        ring.push_back(vertices[index.get<std::size_t>()]);
    }
    if (ring.size() >= 3) rings.push_back(std::move(ring));
}

double areaFromAbove(const Ring& ring) {
    double sum = 0.0;
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const glm::dvec3 &a = ring[k], &b = ring[(k + 1) % ring.size()];
        sum += a.x * b.y - b.x * a.y;
    }
    return 0.5 * std::abs(sum);
}

/// The largest of the surfaces that lie at the bottom.
bool shapeFrom(const std::vector<Ring>& rings, CityBuilding& building) {
    double low = std::numeric_limits<double>::infinity(), high = -low, largest = 0.0;
    for (const Ring& ring : rings)
        for (const glm::dvec3& p : ring) {
            low = std::min(low, p.z);
            high = std::max(high, p.z);
        }
    for (const Ring& ring : rings) {
        double top = ring.front().z;
        for (const glm::dvec3& p : ring) top = std::max(top, p.z);
        const double area = areaFromAbove(ring);
        if (top > low + 0.3 * std::max(high - low, 1.0) || area <= largest) continue;
        largest = area;
        building.footprint = ring;
    }
    building.height = high - low;
    return largest > 0.0;
}

int epsgOf(const Json& root) {
    const Json metadata = root.value("metadata", Json::object());
    const std::string system = metadata.is_object() ? metadata.value("referenceSystem", std::string()) : std::string();
    const std::size_t digits = system.find_last_not_of("0123456789");
    int epsg = 0;
    if (!system.empty() && digits != std::string::npos)
        (void)std::from_chars(system.data() + digits + 1, system.data() + system.size(), epsg);
    return epsg;
}

std::vector<glm::dvec3> verticesOf(const Json& root) {
    glm::dvec3 scale(1.0), shift(0.0);
    if (root.contains("transform"))
        for (int axis = 0; axis < 3; ++axis) {
            scale[axis] = root.at("transform").at("scale").at(static_cast<std::size_t>(axis)).get<double>();
            shift[axis] = root.at("transform").at("translate").at(static_cast<std::size_t>(axis)).get<double>();
        }
    std::vector<glm::dvec3> vertices;
    for (const Json& v : root.at("vertices"))
        vertices.push_back(scale * glm::dvec3(v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()) +
                           shift);
    return vertices;
}

CityModel cityOf(const Json& root) {
    CityModel city;
    city.epsg = epsgOf(root);
    const std::vector<glm::dvec3> vertices = verticesOf(root);
    for (const auto& [id, object] : root.at("CityObjects").items()) {
        const std::string type = object.value("type", std::string());
        if (type != "Building" && type != "BuildingPart" && type != "Bridge") continue;
        std::vector<Ring> rings;
        if (object.contains("geometry") && object["geometry"].is_array() && !object["geometry"].empty())
            collectRings(object["geometry"].back().value("boundaries", Json::array()), vertices, rings);
        else if (object.contains("children"))
            continue; // its parts have the shape
        CityBuilding building;
        const Json attributes = object.value("attributes", Json::object());
        if (attributes.is_object() && attributes.contains("name") && attributes["name"].is_string())
            building.name = attributes["name"].get<std::string>();
        if (shapeFrom(rings, building))
            city.buildings.push_back(std::move(building));
        else
            ++city.withoutShape;
    }
    return city;
}

} // namespace

bool isCityJson(const std::filesystem::path& file) {
    const std::string extension = file.extension().string();
    if (extension != ".json" && extension != ".cityjson") return false;
    std::string begin(4096, ' ');
    std::ifstream stream(file, std::ios::binary);
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return begin.find("\"CityJSON\"") != std::string::npos;
}

CityModel readCityJson(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFile(file, kMostBytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string problem = jsonProblem(text, {kMostBytes, 64, 40'000'000});
    if (!problem.empty()) refuse(file, "it " + problem);
    try {
        return cityOf(Json::parse(text));
    } catch (const Json::exception& failure) {
        refuse(file, std::string("it is damaged (") + failure.what() + ")");
    } catch (const std::out_of_range& failure) {
        refuse(file, failure.what());
    }
}

} // namespace lumorph::navigation

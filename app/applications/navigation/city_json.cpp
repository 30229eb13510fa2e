#include "app/applications/navigation/city_json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <stdexcept>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_check.h"
#include "core/base/text.h"

namespace lumorph::navigation {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kMostBytes = std::size_t{256} << 20U;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
    throw DataError(file.string(), why, "export it again as CityJSON 1.0 or later");
}

/// Stops at the type of the root.
class RootType final : public nlohmann::json_sax<Json> {
public:
    [[nodiscard]] const std::string& type() const { return type_; }

    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(number_integer_t) override { return value(); }
    bool number_unsigned(number_unsigned_t) override { return value(); }
    bool number_float(number_float_t, const string_t&) override { return value(); }
    bool binary(binary_t&) override { return value(); }
    bool string(string_t& text) override {
        if (!isType_) return true;
        type_ = text;
        return false;
    }
    bool key(string_t& name) override {
        isType_ = depth_ == 1 && name == "type";
        return true;
    }
    bool start_object(std::size_t) override { return begin(); }
    bool start_array(std::size_t) override { return depth_ > 0 && begin(); } // the root is an object
    bool end_object() override { return end(); }
    bool end_array() override { return end(); }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

private:
    bool value() {
        isType_ = false;
        return depth_ > 0;
    }
    bool begin() {
        isType_ = false;
        return ++depth_ <= 64;
    }
    bool end() {
        --depth_;
        return true;
    }
    int depth_ = 0;
    bool isType_ = false;
    std::string type_;
};

/// The faces of nested boundaries, whatever their depth: of a MultiSurface, a Solid, ...
class Faces {
public:
    Faces(const Json& geometry, const std::vector<glm::dvec3>& vertices) : vertices_(vertices) {
        const std::string type = geometry.value("type", std::string());
        if (!type.empty() && type.find("Surface") == std::string::npos && type.find("Solid") == std::string::npos)
            return; // points, lines, instances of templates
        static const Json kNone;
        if (const auto semantics = geometry.find("semantics"); semantics != geometry.end() && semantics->is_object()) {
            if (const auto surfaces = semantics->find("surfaces"); surfaces != semantics->end() && surfaces->is_array())
                for (const Json& surface : *surfaces)
                    meanings_.push_back(meaningOf(surface.is_object() ? surface.value("type", std::string()) : ""));
            if (const auto values = semantics->find("values"); values != semantics->end()) {
                collect(geometry.at("boundaries"), *values);
                return;
            }
        }
        collect(geometry.at("boundaries"), kNone);
    }
    [[nodiscard]] std::vector<CityFace> take() { return std::move(faces_); }

private:
    static CityFace::Means meaningOf(const std::string& type) {
        if (type == "GroundSurface") return CityFace::Means::ground;
        if (type == "RoofSurface") return CityFace::Means::roof;
        return type.empty() ? CityFace::Means::unsaid : CityFace::Means::other;
    }
    void collect(const Json& boundaries, const Json& values) {
        if (!boundaries.is_array() || boundaries.empty()) return;
        const Json& first = boundaries.front();
        if (first.is_array() && !first.empty() && first.front().is_number()) return add(boundaries, values);
        static const Json kNone;
        for (std::size_t k = 0; k < boundaries.size(); ++k)
            collect(boundaries[k], values.is_array() && k < values.size() ? values[k] : kNone);
    }
    void add(const Json& rings, const Json& meaning) {
        CityFace face;
        for (const Json& indices : rings) {
            std::vector<glm::dvec3> ring;
            for (const Json& index : indices) {
                if (!index.is_number_unsigned() || index.get<std::size_t>() >= vertices_.size())
                    throw std::out_of_range("a surface names a vertex that there is not");
                ring.push_back(vertices_[index.get<std::size_t>()]);
                if (!std::isfinite(ring.back().x + ring.back().y + ring.back().z))
                    throw std::out_of_range("a vertex of it is no three numbers");
            }
            if (face.ring.empty() && ring.size() < 3) return; // not even a triangle
            if (face.ring.empty())
                face.ring = std::move(ring);
            else if (ring.size() >= 3)
                face.holes.push_back(std::move(ring));
        }
        if (meaning.is_number_unsigned() && meaning.get<std::size_t>() < meanings_.size())
            face.means = meanings_[meaning.get<std::size_t>()];
        faces_.push_back(std::move(face));
    }

    const std::vector<glm::dvec3>& vertices_;
    std::vector<CityFace::Means> meanings_;
    std::vector<CityFace> faces_;
};

double detailOf(const Json& geometry) {
    const auto lod = geometry.find("lod");
    if (lod == geometry.end()) return 0.0;
    if (lod->is_number()) return lod->get<double>();
    double value = 0.0;
    if (lod->is_string()) {
        const auto& text = lod->get_ref<const std::string&>();
        (void)std::from_chars(text.data(), text.data() + text.size(), value);
    }
    return value;
}

/// Gives a building the faces of its highest level of detail that has any. Throws out_of_range or a JSON exception
/// where none has, and one is broken.
void addShape(const Json& geometries, const std::vector<glm::dvec3>& vertices, CityBuilding& building) {
    std::vector<std::pair<double, const Json*>> order;
    for (const Json& geometry : geometries)
        if (geometry.is_object()) order.emplace_back(-detailOf(geometry), &geometry);
    std::ranges::stable_sort(order, {}, &std::pair<double, const Json*>::first);
    std::exception_ptr problem;
    for (const auto& [detail, geometry] : order) {
        try {
            building.faces = Faces(*geometry, vertices).take();
            building.detail = -detail;
        } catch (const std::exception&) {
            if (!problem) problem = std::current_exception();
        }
        if (!building.faces.empty()) return;
    }
    if (problem) std::rethrow_exception(problem);
}

std::string systemOfFile(const Json& root) {
    const auto metadata = root.find("metadata");
    if (metadata == root.end() || !metadata->is_object()) return {};
    const auto system = metadata->find("referenceSystem");
    return system != metadata->end() && system->is_string() ? system->get<std::string>() : std::string();
}

std::vector<glm::dvec3> verticesOf(const Json& root) {
    glm::dvec3 scale(1.0), shift(0.0);
    if (const auto transform = root.find("transform"); transform != root.end())
        for (int axis = 0; axis < 3; ++axis) {
            scale[axis] = transform->at("scale").at(static_cast<std::size_t>(axis)).get<double>();
            shift[axis] = transform->at("translate").at(static_cast<std::size_t>(axis)).get<double>();
        }
    std::vector<glm::dvec3> vertices;
    for (const Json& v : root.at("vertices")) {
        glm::dvec3 vertex(std::numeric_limits<double>::quiet_NaN());
        const bool whole = v.is_array() && v.size() >= 3 && v[0].is_number() && v[1].is_number() && v[2].is_number();
        if (whole) vertex = scale * glm::dvec3(v[0].get<double>(), v[1].get<double>(), v[2].get<double>()) + shift;
        vertices.push_back(vertex);
    }
    return vertices;
}

bool isBuilding(const std::string& type) {
    return type == "Building" || type == "BuildingPart" || type == "Bridge" || type == "BridgePart";
}

std::string textOf(const Json& object, const char* name) {
    const auto value = object.find(name);
    return value != object.end() && value->is_string() ? value->get<std::string>() : std::string();
}

CityBuilding buildingOf(const std::string& id, const Json& object, const std::vector<glm::dvec3>& vertices) {
    CityBuilding building;
    building.id = id;
    if (const auto attributes = object.find("attributes"); attributes != object.end() && attributes->is_object()) {
        building.name = textOf(*attributes, "name");
        for (const char* name : {"measuredHeight", "height"})
            if (const auto value = attributes->find(name); value != attributes->end() && value->is_number())
                if (const auto height = value->get<double>(); height > 0.0 && height < 1000.0 && !building.height)
                    building.height = height;
    }
    if (const auto geometry = object.find("geometry"); geometry != object.end() && geometry->is_array())
        addShape(*geometry, vertices, building);
    return building;
}

CityModel cityOf(const Json& root) {
    CityModel city;
    city.system = systemOfFile(root);
    const std::vector<glm::dvec3> vertices = verticesOf(root);
    std::map<std::string, std::size_t> indices;
    const Json& objects = root.at("CityObjects");
    for (const auto& [id, object] : objects.items()) {
        if (!object.is_object() || !isBuilding(textOf(object, "type"))) continue;
        try {
            city.buildings.push_back(buildingOf(id, object, vertices));
            indices[id] = city.buildings.size() - 1;
        } catch (const std::exception& problem) {
            city.broken.emplace_back(id, problem.what());
        }
    }
    const auto join = [&](const std::string& part, const std::string& whole) {
        const auto one = indices.find(part), other = indices.find(whole);
        if (one != indices.end() && other != indices.end() && one != other)
            city.buildings[one->second].wholeIndex = other->second;
    };
    for (const auto& [id, object] : objects.items()) {
        if (!object.is_object()) continue;
        for (const char* way : {"parents", "children"}) {
            const auto others = object.find(way);
            if (others == object.end() || !others->is_array()) continue;
            for (const Json& other : *others)
                if (other.is_string())
                    way == std::string_view("parents") ? join(id, other.get<std::string>())
                                                       : join(other.get<std::string>(), id);
        }
    }
    return city;
}

} // namespace

bool isCityJson(const std::filesystem::path& file) {
    const std::string extension = lowerCase(file.extension().string());
    if (extension != ".json" && extension != ".cityjson") return false;
    std::ifstream stream(file, std::ios::binary);
    RootType root;
    (void)Json::sax_parse(stream, &root);
    return root.type() == "CityJSON";
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
    }
}

} // namespace lumorph::navigation

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/scene/scene_fields.h"
#include "core/scene/scene_format.h"

namespace lumorph {
namespace {

using nlohmann::json;

/// The double whose shortest text is that of the float: 0.1F is written 0.1, and read as 0.1F again.
double shortest(float value) {
    std::array<char, 32> text{};
    const auto [end, failed] = std::to_chars(text.data(), text.data() + text.size() - 1, value);
    const double number = failed == std::errc() ? std::strtod(text.data(), nullptr) : static_cast<double>(value);
    return static_cast<float>(number) == value ? number : static_cast<double>(value);
}
double shortest(double value) { return value; }
int shortest(int value) { return value; }

/// The degrees, round where that is possible, that give this very angle when read; nothing where none do.
std::optional<double> exactDegrees(Angle angle) {
    const double degrees = angle.inDegrees();
    const auto gives = [angle](double candidate) { return Angle::degrees(candidate) == angle; };
    if (const double rounded = std::round(degrees * 1e9) / 1e9; gives(rounded)) return rounded;
    // There and back costs four roundings.
    double above = degrees;
    double below = degrees;
    for (int step = 0; step < 4; ++step) {
        if (gives(above)) return above;
        if (gives(below)) return below;
        above = std::nextafter(above, 1e300);
        below = std::nextafter(below, -1e300);
    }
    return std::nullopt;
}

/// Not every number of radians has degrees of its own. The nearest are written then, those that would be written of
/// what will be read, so that the text of a project stays as it is from save to save.
double writtenDegrees(Angle angle) {
    if (const auto exact = exactDegrees(angle)) return *exact;
    return exactDegrees(Angle::degrees(angle.inDegrees())).value_or(angle.inDegrees());
}

class Writer {
public:
    void text(const char* key, const std::string& value) { document[key] = value; }
    void asset(const char* key, const std::string& value) { document[key] = value; }
    void flag(const char* key, bool value) { document[key] = value; }
    template <typename T> void number(const char* key, T value, Range /*range*/) { document[key] = shortest(value); }
    template <int Length, typename T> void vector(const char* key, const glm::vec<Length, T>& value, Range /*range*/) {
        json& list = document[key] = json::array();
        for (int i = 0; i < Length; ++i) list.push_back(shortest(value[i]));
    }
    template <std::size_t Length>
    void vector(const char* key, const std::array<double, Length>& value, Range /*range*/) {
        document[key] = value;
    }
    void color(const char* key, const glm::vec3& value) { vector(key, value, kShare); }
    void rotation(const char* key, const glm::quat& value) {
        vector(key, glm::vec4(value.x, value.y, value.z, value.w), kShare);
    }
    void degrees(const char* key, Angle value, Range /*range*/ = {}) { document[key] = writtenDegrees(value); }
    void turnRate(const char* key, double radians, Range /*range*/) { degrees(key, Angle::radians(radians)); }
    template <typename Enumeration, std::size_t Count>
    void word(const char* key, Enumeration value, const Words<Count>& words) {
        document[key] = words.at(static_cast<std::size_t>(value));
    }
    template <typename T> void rigid(const char* key, const glm::mat<4, 4, T>& value) {
        json& list = document[key] = json::array();
        for (int i = 0; i < 16; ++i) list.push_back(shortest(value[i % 4][i / 4]));
    }
    template <typename T> void object(const char* key, const T& value) { document[key] = written(value); }
    template <typename T> void whole(const char* key, const T& value) { object(key, value); }
    template <typename T> void plain(const char* key, const T& value) {
        if (!(value == T{})) object(key, value);
    }
    template <typename T> void list(const char* key, const std::vector<T>& values, std::size_t /*most*/) {
        json& list = document[key] = json::array();
        for (const T& value : values) list.push_back(written(value));
    }
    void kind(const ItemKind& kind) {
        const char* word = kKinds[kind.index()];
        document["kind"] = word;
        std::visit([&](const auto& value) { object(word, value); }, kind);
        if (document[word].empty()) document.erase(word);
    }

    json document = json::object();

private:
    template <typename T> static json written(const T& value) {
        Writer writer;
        fields(writer, value);
        return std::move(writer.document);
    }
};

} // namespace

json documentOf(const Scene& scene) {
    Writer writer;
    fields(writer, scene);
    return std::move(writer.document);
}

json documentOf(const Installation& installation) {
    Writer writer;
    fields(writer, installation);
    return std::move(writer.document);
}

} // namespace lumorph

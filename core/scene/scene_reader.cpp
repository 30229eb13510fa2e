#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/scene_fields.h"
#include "core/scene/scene_format.h"

namespace lumorph {
namespace {

constexpr std::size_t kLongestText = 1000;
/// Radians up to a million.
constexpr Range kTurnRange{-6e7, 6e7};

class Reader {
public:
    explicit Reader(JsonSection section) : section_(std::move(section)) {}

    void text(const char* key, std::string& value) {
        section_.text(key, value);
        if (value.size() > kLongestText)
            section_.refuse(key, "is longer than " + std::to_string(kLongestText) + " bytes", "shorten it");
    }
    void asset(const char* key, std::string& value) {
        section_.asset(key, value);
        if (value.size() > kLongestText) section_.refuse(key, "is too long for the name of a file", "rename the file");
    }
    void flag(const char* key, bool& value) { section_.flag(key, value); }
    void number(const char* key, int& value, Range range) {
        section_.wholeNumber(key, value, static_cast<int>(range.min), static_cast<int>(range.max));
    }
    void number(const char* key, double& value, Range range) { section_.number(key, value, range.min, range.max); }
    void number(const char* key, float& value, Range range) {
        if (!section_.has(key)) return;
        double number = 0.0;
        section_.number(key, number, range.min, range.max);
        value = static_cast<float>(number);
    }
    template <int Length, typename T> void vector(const char* key, glm::vec<Length, T>& value, Range range) {
        numbers(key, range, value, Length);
    }
    template <std::size_t Length> void vector(const char* key, std::array<double, Length>& value, Range range) {
        numbers(key, range, value, Length);
    }
    void color(const char* key, glm::vec3& value) { vector(key, value, kShare); }
    void rotation(const char* key, glm::quat& value) {
        glm::vec4 xyzw(value.x, value.y, value.z, value.w);
        vector(key, xyzw, {-1.01, 1.01});
        value = glm::quat(xyzw.w, xyzw.x, xyzw.y, xyzw.z);
    }
    void degrees(const char* key, Angle& value, Range range = kTurnRange) {
        if (!section_.has(key)) return;
        double number = 0.0;
        section_.number(key, number, range.min, range.max);
        value = Angle::degrees(number);
    }
    void turnRate(const char* key, double& radians, Range range) {
        Angle angle = Angle::radians(radians);
        degrees(key, angle, {Angle::radians(range.min).inDegrees(), Angle::radians(range.max).inDegrees()});
        radians = angle.inRadians();
    }
    template <typename Enumeration, std::size_t Count>
    void word(const char* key, Enumeration& value, const Words<Count>& words) {
        if (section_.has(key)) value = static_cast<Enumeration>(indexOfWord(key, words));
    }
    /// Sixteen numbers, row by row.
    template <typename T> void rigid(const char* key, glm::mat<4, 4, T>& value) {
        std::array<double, 16> rows{};
        if (!section_.has(key)) return;
        vector(key, rows, {-1e3, 1e3});
        for (int i = 0; i < 16; ++i) value[i % 4][i / 4] = static_cast<T>(rows[static_cast<std::size_t>(i)]);
    }
    template <typename T> void object(const char* key, T& value) {
        section_.section(key, [&value](JsonSection section) {
            Reader reader(std::move(section));
            fields(reader, value);
        });
    }
    template <typename T> void whole(const char* key, T& value) {
        if (section_.has(key)) value = T{};
        object(key, value);
    }
    template <typename T> void plain(const char* key, T& value) { whole(key, value); }
    template <typename T> void list(const char* key, std::vector<T>& values, std::size_t most) {
        if (section_.has(key)) values.clear();
        section_.sections(key, most, [&values](JsonSection section) {
            Reader reader(std::move(section));
            fields(reader, values.emplace_back());
        });
    }
    void kind(ItemKind& kind) {
        if (!section_.has("kind")) section_.refuse("kind", "is missing", "write one of " + choices(kKinds));
        const std::size_t index = indexOfWord("kind", kKinds);
        setKind(kind, index, std::make_index_sequence<std::variant_size_v<ItemKind>>());
        std::visit([&](auto& value) { object(kKinds[index], value); }, kind);
    }

private:
    template <typename Values> void numbers(const char* key, Range range, Values& values, std::size_t count) {
        if (!section_.has(key)) return;
        std::vector<double> read;
        section_.numbers(key, read, range.min, range.max, count, true);
        for (std::size_t i = 0; i < count; ++i) {
            using Index = std::conditional_t<std::is_same_v<Values, std::array<double, 5>>, std::size_t, int>;
            auto& value = values[static_cast<Index>(i)];
            value = static_cast<std::remove_reference_t<decltype(value)>>(read[i]);
        }
    }
    template <std::size_t Count> static std::string choices(const Words<Count>& words) {
        std::string all;
        for (const char* word : words) all += (all.empty() ? "" : ", ") + inQuotes(word);
        return all;
    }
    template <std::size_t Count> std::size_t indexOfWord(const char* key, const Words<Count>& words) {
        std::string word;
        section_.text(key, word);
        for (std::size_t i = 0; i < Count; ++i)
            if (word == words[i]) return i;
        section_.refuse(key, inQuotes(word) + " is not known here", "write one of " + choices(words));
    }
    template <std::size_t... Indices>
    static void setKind(ItemKind& kind, std::size_t index, std::index_sequence<Indices...> /*all*/) {
        const auto set = [&kind]<std::size_t Index>(std::size_t wanted) {
            if (wanted == Index) kind = std::variant_alternative_t<Index, ItemKind>{};
        };
        (set.template operator()<Indices>(index), ...);
    }

    JsonSection section_;
};

} // namespace

void readScene(const JsonSection& section, Scene& scene) {
    Reader reader(section);
    fields(reader, scene);
    try {
        checkScene(scene);
    } catch (const InvalidInput& error) {
        section.refuse("items", error.subject() + ": " + error.why(), error.remedy());
    }
}

void readInstallation(const JsonSection& section, Installation& installation) {
    Reader reader(section);
    fields(reader, installation);
    try {
        checkInstallation(installation);
    } catch (const InvalidInput& error) {
        const std::string& subject = error.subject();
        if (subject == "installation")
            section.refuse(error.why().substr(0, error.why().find(' ')), error.why(), error.remedy());
        section.refuse(subject.starts_with("camera") ? "cameras" : "projectors", subject + ": " + error.why(),
                       error.remedy());
    }
}

} // namespace lumorph

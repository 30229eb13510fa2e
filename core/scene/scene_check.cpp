#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>
#include <string>

#include <glm/matrix.hpp>

#include "core/base/error.h"
#include "core/scene/scene_fields.h"

namespace lumorph {
namespace {

constexpr std::size_t kMaxTextLength = 1000;
constexpr double kManyTurns = 1e6; ///< radians

/// How an item is called in messages.
std::string subjectOf(const SceneItem& item) {
    return item.name.empty() ? "item " + std::to_string(item.id) : "item \"" + item.name.substr(0, 80) + "\"";
}

/// Goes through one part of a scene and refuses what is out of range.
class Checker {
public:
    explicit Checker(std::string subject, std::string path = {})
        : subject_(std::move(subject)), path_(std::move(path)) {}

    [[noreturn]] void refuse(const std::string& why, const std::string& remedy) const {
        throw InvalidInput(subject_, why, remedy);
    }
    void text(const char* key, const std::string& value) const {
        if (value.size() > kMaxTextLength) refuse(path_ + key + " is too long", "shorten it");
    }
    void asset(const char* key, const std::string& value) const { text(key, value); }
    void flag(const char* /*key*/, bool /*value*/) const {}
    /// Compared in the value's own precision, so that a limit itself is never refused.
    template <typename T> void number(const char* key, T value, Range range) const {
        if (value >= static_cast<T>(range.min) && value <= static_cast<T>(range.max)) return;
        std::ostringstream why;
        why << path_ << key << " is " << value << ", not a number from " << range.min << " to " << range.max;
        refuse(why.str(), "correct it");
    }
    template <int Length, typename T>
    void vector(const char* key, const glm::vec<Length, T>& value, Range range) const {
        for (int i = 0; i < Length; ++i) number(key, value[i], range);
    }
    template <std::size_t Length>
    void vector(const char* key, const std::array<double, Length>& value, Range range) const {
        for (const double number : value) this->number(key, number, range);
    }
    void color(const char* key, const glm::vec3& value) const { vector(key, value, kShare); }
    void rotation(const char* key, const glm::quat& q) const {
        if (!(std::abs(glm::dot(q, q) - 1.0F) < 0.02F)) refuse(path_ + key + " is no rotation", "correct it");
    }
    void degrees(const char* key, Angle value) const { number(key, value.inRadians(), {-kManyTurns, kManyTurns}); }
    void degrees(const char* key, Angle value, Range range) const {
        constexpr double kRounding = 1e-9;
        number(key, value.inDegrees(), {range.min - kRounding, range.max + kRounding});
    }
    void turnRate(const char* key, double radians, Range range) const { number(key, radians, range); }
    template <typename Enumeration, std::size_t Count>
    void word(const char* key, Enumeration value, const Words<Count>& /*words*/) const {
        number(key, static_cast<int>(value), {0, Count - 1});
    }
    template <typename T> void rigid(const char* key, const glm::mat<4, 4, T>& value) const {
        checkRigid(key, glm::dmat4(value));
    }
    template <typename T> void object(const char* key, const T& value) const { go(value, path_ + key + "."); }
    template <typename T> void whole(const char* key, const T& value) const { object(key, value); }
    template <typename T> void plain(const char* key, const T& value) const { object(key, value); }
    template <typename T> void list(const char* key, const std::vector<T>& values, std::size_t most) const {
        if (values.size() > most)
            refuse(path_ + key + " are " + std::to_string(values.size()) + ", and " + std::to_string(most) +
                       " is the most",
                   "remove some");
        for (std::size_t i = 0; i < values.size(); ++i) go(values[i], path_ + key + "[" + std::to_string(i) + "].");
    }
    void kind(const ItemKind& kind) const {
        std::visit([&](const auto& value) { go(value, path_); }, kind);
    }

private:
    void go(const SceneItem& item, const std::string& /*path*/) const {
        Checker checker(subjectOf(item));
        fields(checker, item);
    }
    void go(const InstalledCamera& camera, const std::string& /*path*/) const {
        Checker checker("camera \"" + camera.name.substr(0, 80) + "\"");
        fields(checker, camera);
    }
    void go(const InstalledProjector& projector, const std::string& /*path*/) const {
        Checker checker("projector \"" + projector.name.substr(0, 80) + "\"");
        fields(checker, projector);
    }
    template <typename T> void go(const T& value, const std::string& path) const {
        Checker checker(subject_, path);
        fields(checker, value);
    }
    void checkRigid(const char* key, const glm::dmat4& matrix) const {
        for (int i = 0; i < 16; ++i) number(key, matrix[i / 4][i % 4], {-1e3, 1e3});
        const glm::dmat3 rotation(matrix);
        const glm::dmat3 product = glm::transpose(rotation) * rotation;
        double worst = 0.0;
        for (int i = 0; i < 9; ++i)
            worst = std::max(worst, std::abs(product[i / 3][i % 3] - (i / 3 == i % 3 ? 1.0 : 0.0)));
        const bool lastRow = matrix[0][3] == 0.0 && matrix[1][3] == 0.0 && matrix[2][3] == 0.0 && matrix[3][3] == 1.0;
        if (worst > 1e-3 || glm::determinant(rotation) < 0.0 || !lastRow)
            refuse(path_ + key + " is not a rotation and a translation", "correct it, or calibrate again");
    }

    std::string subject_;
    std::string path_;
};

bool drives(const SceneItem& item) { return item.role != ItemRole::virtualOnly; }

bool hasShape(const SceneItem& item) {
    return !std::holds_alternative<LightItem>(item.kind) && !std::holds_alternative<FogItem>(item.kind) &&
           !std::holds_alternative<GroupItem>(item.kind);
}

/// Ids once each; parents are groups that stand before their members, so that there are no circles.
void checkTree(const std::vector<SceneItem>& items) {
    std::map<int, bool> isGroup;
    for (const SceneItem& item : items) {
        const Checker checker(subjectOf(item));
        if (item.parent != 0) {
            const auto parent = isGroup.find(item.parent);
            if (parent == isGroup.end())
                checker.refuse("its group " + std::to_string(item.parent) + " does not stand before it",
                               "put the group first, or take the item out of it");
            if (!parent->second)
                checker.refuse("its parent " + std::to_string(item.parent) + " is no group", "take the item out of it");
        }
        if (!isGroup.emplace(item.id, std::holds_alternative<GroupItem>(item.kind)).second)
            checker.refuse("its id " + std::to_string(item.id) + " is used twice", "give each item an id of its own");
    }
}

void checkDriving(const std::vector<SceneItem>& items) {
    const SceneItem* first = nullptr;
    for (const SceneItem& item : items) {
        if (!drives(item)) continue;
        const Checker checker(subjectOf(item));
        if (!hasShape(item)) checker.refuse("servos cannot follow it: it has no shape", "give it the role \"virtual\"");
        if (first)
            checker.refuse("the servos follow " + subjectOf(*first) + " already",
                           "give all but one of them the role \"virtual\"");
        first = &item;
    }
}

/// A measured curve begins at 0, rises and ends at 1; or there is none.
template <typename Point>
void checkRising(const Checker& checker, const std::string& what, const std::vector<Point>& points,
                 double Point::*value) {
    if (points.empty()) return;
    const bool whole = points.size() >= 2 && points.front().*value == 0.0 && points.back().*value == 1.0;
    if (!whole || !std::ranges::is_sorted(points, std::less_equal{}, value))
        checker.refuse(what + " does not rise from 0 to 1", "measure it again");
}

} // namespace

void checkScene(const Scene& scene) {
    Checker checker("scene");
    fields(checker, scene);
    checkTree(scene.items);
    checkDriving(scene.items);
}

void checkInstallation(const Installation& installation) {
    Checker checker("installation");
    fields(checker, installation);
    for (const InstalledProjector& projector : installation.projectors)
        checkRising(Checker("projector \"" + projector.name.substr(0, 80) + "\""), "responseCurve.value",
                    projector.responseCurve, &InstalledProjector::ResponsePoint::value);
    for (const MeasuredServo& servo : installation.servos)
        checkRising(Checker("servo \"" + servo.actuator.substr(0, 80) + "\""), "points.commanded", servo.points,
                    &MeasuredServo::Point::commanded);
}

} // namespace lumorph

#include <bit>
#include <cmath>
#include <cstring>
#include <deque>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <type_traits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/studio/document/match_wish.h"
#include "app/studio/document/rig_compiler.h"
#include "app/studio/document/rig_edit.h"
#include "app/workspaces/rig/actuator_guide.h"
#include "app/workspaces/rig/rig_facts.h"
#include "core/base/error.h"
#include "core/rig/actuator_copies.h"
#include "core/rig/rig_file.h"
#include "core/rig/servo_types.h"
#include "core/rig/templates/bundled_rigs.h"
#include "core/rig/templates/rig_templates.h"
#include "tests/support/long_tests.h"
#include "tests/support/small_rigs.h"
#include "tests/ui/event_loop.h"

// Walks at random through all that can be done to a rig, and back.

namespace lumorph::studio {
namespace {

using test::eventually;
using Random = std::mt19937_64;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostSteps = 200; ///< of undo, as the document has it

std::size_t below(Random& random, std::size_t count) { return static_cast<std::size_t>(random() % count); }
double between(Random& random, double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1.0p-53;
}
double nonsense(Random& random) {
    constexpr double kValues[] = {kNan, kInfinite, -kInfinite, 0.0, -0.0, -1.0, 1e300, -1e300, 1e38, 1e-300, 5e8};
    return kValues[below(random, std::size(kValues))];
}
float nonsenseFloat(Random& random) {
    constexpr float kBig = std::numeric_limits<float>::max();
    constexpr float kValues[] = {std::numeric_limits<float>::quiet_NaN(),
                                 std::numeric_limits<float>::infinity(),
                                 0.0F,
                                 -0.0F,
                                 -1.0F,
                                 kBig,
                                 -kBig,
                                 1e-30F,
                                 3e20F};
    return kValues[below(random, std::size(kValues))];
}

/// Every bit of a rig's parts, of those too that are no rig.
class Bytes {
public:
    static std::string of(const RigParts& parts) {
        Bytes bytes;
        bytes.add(parts);
        return std::move(bytes.text_);
    }

private:
    template <typename Value> void add(const Value& value) {
        static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
        text_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void add(const std::string& text) {
        add(text.size());
        text_ += text;
    }
    void add(const Angle& angle) { add(angle.inRadians()); }
    template <int size, typename Value> void add(const glm::vec<size, Value>& vector) {
        for (int k = 0; k < size; ++k) add(vector[k]);
    }
    void add(const glm::mat4& matrix) {
        for (int k = 0; k < 4; ++k) add(matrix[k]);
    }
    template <typename Value> void add(const std::vector<Value>& values) {
        add(values.size());
        for (const Value& value : values) add(value);
    }
    void add(const Hinge& d) { add(d.origin), add(d.axis), add(d.min), add(d.max); }
    void add(const Bend& d) { add(d.origin), add(d.axis), add(d.direction), add(d.length), add(d.min), add(d.max); }
    void add(const Slide& d) { add(d.direction), add(d.min), add(d.max); }
    void add(const MorphTarget& d) { add(d.target), add(d.keys), add(d.displacements); }
    void add(const SkinJoint& d) { add(d.joint), add(d.motion), add(d.axis), add(d.min), add(d.max); }
    void add(const SheetLift& d) { add(d.axis), add(d.min), add(d.max); }
    void add(const Influence& influence) { add(influence.vertex), add(influence.weight); }
    void add(const Actuator& a) {
        add(a.name), add(a.deformer.index());
        std::visit([this](const auto& deformer) { add(deformer); }, a.deformer);
        add(a.influences), add(a.levels), add(a.maxVelocity), add(a.dampingRatio);
        add(a.drive.channel), add(a.drive.pulseMin), add(a.drive.pulseMax), add(a.drive.servo);
    }
    void add(const Skeleton::Joint& joint) { add(joint.parent), add(joint.localRest); }
    void add(const RigParts& parts) {
        add(parts.name), add(parts.restMesh.positions), add(parts.restMesh.triangles), add(parts.actuators);
        add(parts.skeleton.has_value());
        if (parts.skeleton)
            add(parts.skeleton->joints), add(parts.skeleton->vertexJoints), add(parts.skeleton->vertexWeights);
        add(parts.pathInside), add(parts.drawing);
    }

    std::string text_;
};

/// Whether parts are a rig, by what the documentation of `RigParts` says, word for word.
class Judge {
public:
    static bool sound(const RigParts& parts) { return Judge(parts).all(); }

private:
    explicit Judge(const RigParts& parts) : parts_(parts) {}

    static bool number(double value) { return std::abs(value) <= 1e6; } // false for NaN
    static bool place(const glm::vec3& v) { return number(v.x) && number(v.y) && number(v.z); }
    static bool way(const glm::vec3& v) { return place(v) && glm::length(v) > 1e-6F; }
    static bool range(double min, double max) { return number(min) && number(max) && min < max; }
    static bool turn(double min, double max) { return range(min, max) && max - min <= 2.0 * std::numbers::pi + 1e-9; }
    bool fits(const Hinge& d) const {
        return way(d.axis) && place(d.origin) && turn(d.min.inRadians(), d.max.inRadians());
    }
    bool fits(const Bend& d) const {
        return way(d.axis) && way(d.direction) && place(d.origin) &&
               std::abs(glm::dot(glm::normalize(d.axis), glm::normalize(d.direction))) < 1e-3F && number(d.length) &&
               d.length > 1e-6 && turn(d.min.inRadians(), d.max.inRadians()) && d.min.inRadians() == 0.0;
    }
    bool fits(const Slide& d) const { return way(d.direction) && range(d.min, d.max); }
    bool fits(const MorphTarget& d) const {
        bool good = !d.keys.empty() && d.keys.size() == d.displacements.size();
        float last = 0.0F;
        for (const float key : d.keys) good = good && key > last && key <= 1.0F, last = key;
        for (const auto& displacements : d.displacements) {
            good = good && displacements.size() == actuator_->influences.size();
            for (const glm::vec3& displacement : displacements) good = good && place(displacement);
        }
        return good;
    }
    bool fits(const SkinJoint& d) const {
        if (!parts_.skeleton || d.joint < 0 || d.joint >= static_cast<int>(parts_.skeleton->joints.size()))
            return false;
        return way(d.axis) && (d.motion == SkinJoint::Motion::rotate ? turn(d.min, d.max) : range(d.min, d.max));
    }
    static bool fits(const SheetLift&) { return false; } // the rigs that are walked through have no sheet
    bool fits(const Actuator& a) {
        actuator_ = &a;
        bool good =
            !a.name.empty() && names_.insert(a.name).second && QString::fromStdString(a.name).toStdString() == a.name;
        for (std::size_t i = 0; i < a.influences.size(); ++i) {
            const Influence& influence = a.influences[i];
            good = good && influence.vertex < parts_.restMesh.positions.size() && influence.weight >= 0.0F &&
                   influence.weight <= 1.0F && (i == 0 || a.influences[i - 1].vertex < influence.vertex);
        }
        good = good && a.levels >= 2 && a.levels <= 200 && a.maxVelocity >= 1e-6 && a.maxVelocity <= 1e6 &&
               a.dampingRatio >= 1.0 && a.dampingRatio <= 1e3 && std::isfinite(a.drive.pulseMin) &&
               std::isfinite(a.drive.pulseMax);
        return good && std::visit([this](const auto& deformer) { return fits(deformer); }, a.deformer);
    }
    bool all() {
        bool good = !parts_.restMesh.positions.empty() && !parts_.restMesh.triangles.empty();
        for (const glm::vec3& p : parts_.restMesh.positions) good = good && place(p);
        for (const glm::uvec3& t : parts_.restMesh.triangles)
            for (int k = 0; k < 3; ++k) good = good && t[k] < parts_.restMesh.positions.size();
        for (const Actuator& actuator : parts_.actuators) good = good && fits(actuator);
        return good;
    }

    const RigParts& parts_;
    const Actuator* actuator_ = nullptr;
    std::set<std::string> names_;
};

/// An edit with all its chance drawn: the same each time it is done.
struct Step {
    const char* what;
    RigEdit edit;
};

void setAxis(Actuator& actuator, const glm::vec3& axis) {
    if (auto* hinge = std::get_if<Hinge>(&actuator.deformer)) hinge->axis = axis;
    if (auto* slide = std::get_if<Slide>(&actuator.deformer)) slide->direction = axis;
    if (auto* joint = std::get_if<SkinJoint>(&actuator.deformer)) joint->axis = axis;
    if (auto* bend = std::get_if<Bend>(&actuator.deformer)) {
        bend->axis = axis;
        bend->direction = glm::cross(glm::vec3(0.0F, 1.0F, 0.0F), axis);
    }
}

/// The line by the handles of the view: to a place at random, or both ends in one.
void dragLine(RigParts& parts, std::size_t a, Random& random) {
    std::vector<std::uint32_t> vertices;
    for (const Influence& influence : parts.actuators[a].influences) vertices.push_back(influence.vertex);
    const auto guide = guideOf(parts, a, vertices);
    if (!guide) return;
    std::array<glm::vec3, 2> ends = endsOf(*guide);
    if (below(random, 10) == 0)
        ends[0] = ends[1];
    else
        ends[below(random, 2)] += 0.02F * glm::vec3(between(random, -1, 1), 0.0, between(random, -1, 1));
    setLine(parts.actuators[a], *guide, ends);
}

void mirror(RigParts& parts, std::size_t a, Random& random) {
    try {
        parts = mirroredActuator(parts, a, below(random, 2) == 0 ? MirrorPlane::acrossX : MirrorPlane::acrossZ).parts;
    } catch (const InvalidInput&) { // it says why, and leaves the parts alone
    }
}

void weigh(Actuator& actuator, Random& random) {
    if (actuator.influences.empty()) return;
    Influence& influence = actuator.influences[below(random, actuator.influences.size())];
    switch (below(random, 4)) {
    case 0:
        influence.weight = nonsenseFloat(random);
        break;
    case 1:
        influence.vertex = static_cast<std::uint32_t>(random());
        break;
    default:
        influence.weight = static_cast<float>(between(random, 0, 1));
    }
}

/// Numbers that no field lets through, wherever an actuator has any.
void spoil(RigParts& parts, Actuator& actuator, Random& random) {
    const glm::vec3 vector(nonsenseFloat(random), nonsenseFloat(random), nonsenseFloat(random));
    switch (below(random, 12)) {
    case 0:
        setRange(actuator, nonsense(random), nonsense(random));
        break;
    case 1:
        setRange(actuator, rangeOf(actuator).max, rangeOf(actuator).min);
        break;
    case 2:
        setAxis(actuator, vector);
        break;
    case 3:
        moveLine(actuator, vector);
        break;
    case 4:
        if (auto* bend = std::get_if<Bend>(&actuator.deformer)) bend->length = nonsense(random);
        break;
    case 5:
        actuator.levels = below(random, 2) == 0 ? static_cast<int>(random()) : static_cast<int>(below(random, 3)) - 1;
        break;
    case 6:
        actuator.maxVelocity = nonsense(random);
        break;
    case 7:
        actuator.dampingRatio = nonsense(random);
        break;
    case 8:
        (below(random, 2) == 0 ? actuator.drive.pulseMin : actuator.drive.pulseMax) = nonsense(random);
        break;
    case 9: {
        constexpr const char* kNames[] = {"", "\xff\xfe", "\xed\xa0\x80", "cut \xc3"};
        actuator.name = kNames[below(random, std::size(kNames))];
        break;
    }
    case 10:
        parts.restMesh.positions[below(random, parts.restMesh.positions.size())] = vector;
        break;
    default:
        actuator.deformer = SkinJoint{static_cast<int>(below(random, 6)) - 2, SkinJoint::Motion::rotate, vector, 0, 1};
    }
}

/// One of all the kinds of edits there are.
Step randomStep(Random& random) {
    using Edit = std::function<void(RigParts&, std::size_t, Random&)>;
    const auto one = [](auto edit) {
        return Edit([edit](RigParts& parts, std::size_t a, Random& r) { edit(parts.actuators[a], r); });
    };
    struct Kind {
        const char* what;
        Edit edit;
    };
    static const std::vector<Kind> kinds{
        {"axis", one([](Actuator& a, Random& r) {
             setAxis(a, glm::vec3(between(r, -1, 1), between(r, -1, 1), between(r, -1, 1)));
         })},
        {"range", one([](Actuator& a, Random& r) {
             const ActuatorRange range = rangeOf(a);
             setRange(a, range.min, range.min + between(r, 0.1, 1.2) * (range.max - range.min));
         })},
        {"lower end", one([](Actuator& a, Random& r) { setRange(a, between(r, -0.05, 0.01), rangeOf(a).max); })},
        {"line", dragLine},
        {"place", one([](Actuator& a, Random& r) {
             moveLine(a, 0.02F * glm::vec3(between(r, -1, 1), between(r, -1, 1), between(r, -1, 1)));
         })},
        {"arc", one([](Actuator& a, Random& r) {
             if (auto* bend = std::get_if<Bend>(&a.deformer)) bend->length = between(r, 0.001, 0.05);
         })},
        {"name", one([](Actuator& a, Random& r) { a.name = "part " + std::to_string(below(r, 12)); })},
        {"name of many letters",
         one([](Actuator& a, Random& r) { a.name = std::string(below(r, 300) + 1, 'n') + "\xc3\xa4\"\\\n"; })},
        {"levels", one([](Actuator& a, Random& r) { a.levels = 2 + static_cast<int>(below(r, 199)); })},
        {"velocity", one([](Actuator& a, Random& r) { a.maxVelocity = 1.0 / between(r, 0.02, 60.0); })},
        {"damping", one([](Actuator& a, Random& r) { a.dampingRatio = between(r, 1.0, 20.0); })},
        {"servo", one([](Actuator& a, Random& r) {
             a.drive.servo = servoTypes()[below(r, servoTypes().size())].name;
             a.drive.channel = static_cast<int>(below(r, 16)) - 1;
             a.drive.pulseMin = between(r, 500, 1500);
             a.drive.pulseMax = between(r, 1500, 2500);
         })},
        {"weight", one(weigh)},
        {"mirror", mirror},
        {"add",
         [](RigParts& parts, std::size_t a, Random& r) {
             Actuator copy = parts.actuators[a];
             copy.name += " " + std::to_string(below(r, 100));
             parts.actuators.insert(parts.actuators.begin() +
                                        static_cast<std::ptrdiff_t>(below(r, parts.actuators.size())),
                                    std::move(copy));
         }},
        {"remove", [](RigParts& parts, std::size_t a,
                      Random&) { parts.actuators.erase(parts.actuators.begin() + static_cast<std::ptrdiff_t>(a)); }},
        {"exchange",
         [](RigParts& parts, std::size_t a, Random& r) {
             std::swap(parts.actuators[a], parts.actuators[below(r, parts.actuators.size())]);
         }},
        {"nothing", [](RigParts&, std::size_t, Random&) {}},
        {"nonsense", [](RigParts& parts, std::size_t a, Random& r) { spoil(parts, parts.actuators[a], r); }},
        {"more nonsense", [](RigParts& parts, std::size_t a, Random& r) { spoil(parts, parts.actuators[a], r); }},
    };
    const Kind& kind = kinds[below(random, kinds.size())];
    const std::uint64_t seed = random();
    return {kind.what, [edit = kind.edit, seed](RigParts& parts) {
                Random own(seed);
                if (parts.actuators.empty()) {
                    parts.actuators.push_back({"first", Slide{{0, 1, 0}, 0.0, 0.01}, {{0, 1.0F}}, 33, 1.0, 1.0, {}});
                    return;
                }
                edit(parts, below(own, parts.actuators.size()), own);
            }};
}

/// The document with its compiler, and beside it what each step of undo has to give back.
class Walk {
public:
    Walk(const Rig& rig, std::uint64_t seed) : random_(seed) {
        StudioState state;
        state.rig.rig = std::make_shared<const Rig>(rig);
        state.strokes.assign(rig.actuatorCount(), 0.0);
        document_.reset(std::move(state), {});
        known_.push_back(now());
        good_ = document_.state().rig.rig;
    }

    void step() {
        const std::size_t way = below(random_, 100);
        if (way < 50)
            edit();
        else if (way < 62)
            drag();
        else if (way < 67)
            moveByHand();
        else if (way < 90)
            undo(1 + below(random_, 6));
        else
            redo(1 + below(random_, 4));
        // Each thing of its own, as fast as it comes: the compiler is behind most of the time.
        QCoreApplication::processEvents();
        look();
        if (++steps_ % 9 == 0) rest();
    }

    /// The compiler has done what it can.
    void rest() {
        const auto& rig = document_.state().rig;
        if (!Judge::sound(*rig.parts)) {
            ASSERT_TRUE(eventually([&] { return !notices_.at("rig").empty(); })) << trail_;
            return;
        }
        ASSERT_TRUE(eventually([&] { return document_.state().rig.compiled; }))
            << trail_ << why() << "is a rig that is not compiled";
        const auto& compiled = *document_.state().rig.rig;
        EXPECT_TRUE(Bytes::of(compiled.parts()) == known_.at(at_).parts) << trail_;
        EXPECT_TRUE(notices_.at("rig").empty()) << trail_;
        const std::vector<std::byte> file = writeRigGlb(compiled);
        EXPECT_TRUE(writeRigGlb(readRigGlb(file, "walk")) == file) << trail_ << "is another rig after reading";
    }

    [[nodiscard]] std::size_t undone() const { return undone_; }
    [[nodiscard]] std::size_t refused() const { return refused_; }

private:
    struct Known {
        std::string parts;
        std::vector<double> strokes;
    };
    [[nodiscard]] Known now() const { return {Bytes::of(*document_.state().rig.parts), document_.state().strokes}; }
    [[nodiscard]] std::string why() const {
        const auto notices = notices_.at("rig");
        return notices.empty() ? "" : (notices.front().subject + ": " + notices.front().why).toStdString() + " ";
    }

    /// What an edit has to give; 0 and -0 are the same, so that one becoming the other is no edit.
    [[nodiscard]] std::string after(const Step& step) const {
        RigParts parts = *document_.state().rig.parts;
        step.edit(parts);
        return parts == *document_.state().rig.parts ? now().parts : Bytes::of(parts);
    }

    void edit() {
        const Step step = randomStep(random_);
        trail_ = std::string(step.what) + " ";
        const std::string expected = after(step);
        editRig(document_, step.what, step.edit);
        remember(expected);
    }

    /// Previews that end as a step, or are taken back.
    void drag() {
        const std::string before = known_.at(at_).parts;
        std::string expected = before;
        for (std::size_t k = 1 + below(random_, 4); k > 0; --k) {
            const Step step = randomStep(random_);
            trail_ = std::string("drag of ") + step.what + " ";
            expected = after(step);
            previewRig(document_, step.edit);
            EXPECT_TRUE(now().parts == expected) << trail_;
            QCoreApplication::processEvents();
            look();
        }
        if (below(random_, 3) == 0) {
            document_.cancelPreview();
            EXPECT_TRUE(now().parts == before) << trail_ << "taken back";
            return;
        }
        document_.commitPreview("drag");
        remember(expected);
    }

    void moveByHand() {
        trail_ = "by hand ";
        const double value = below(random_, 4) == 0 ? nonsense(random_) : between(random_, 0, 1);
        const std::size_t count = document_.state().strokes.size();
        if (count == 0) return;
        const std::size_t which = below(random_, count);
        document_.change("move", [&](StudioState& state) { state.strokes[which] = value; });
        remember(known_.at(at_).parts);
    }

    void remember(const std::string& expected) {
        EXPECT_TRUE(now().parts == expected) << trail_;
        if (newest() == top_) {
            EXPECT_TRUE(known_.at(at_).parts == expected) << trail_ << "is no step of undo";
            EXPECT_EQ(known_.at(at_).strokes, now().strokes) << trail_ << "is no step of undo";
            return;
        }
        known_.resize(at_ + 1);
        known_.push_back(now());
        if (known_.size() > kMostSteps + 1) known_.pop_front();
        at_ = known_.size() - 1;
        followStack();
    }
    void undo(std::size_t count) {
        for (; count > 0 && document_.undoStack().canUndo(); --count) {
            document_.undoStack().undo();
            --at_;
            ++undone_;
            expectKnown("undone ");
        }
    }
    void redo(std::size_t count) {
        for (; count > 0 && document_.undoStack().canRedo(); --count) {
            document_.undoStack().redo();
            ++at_;
            expectKnown("redone ");
        }
    }
    void expectKnown(const char* what) {
        trail_ = what;
        followStack();
        EXPECT_TRUE(now().parts == known_.at(at_).parts) << trail_;
        EXPECT_EQ(now().strokes, known_.at(at_).strokes) << trail_;
    }
    [[nodiscard]] const QUndoCommand* newest() {
        const QUndoStack& stack = document_.undoStack();
        return stack.index() == 0 ? nullptr : stack.command(stack.index() - 1);
    }
    void followStack() {
        top_ = newest();
        ASSERT_EQ(static_cast<std::size_t>(document_.undoStack().index()), at_);
    }

    /// What the loop is given after each step: a sound rig with as many strokes, that can be deformed.
    void look() {
        const StudioState& state = document_.state();
        if (!Judge::sound(*state.rig.parts)) {
            ++refused_;
            EXPECT_FALSE(state.rig.compiled) << trail_ << "is no rig, but said to be compiled";
        }
        const MatchWish wish = wishOf(state);
        ASSERT_TRUE(wish.rig) << trail_;
        EXPECT_EQ(wish.strokes.size(), wish.rig->actuatorCount()) << trail_;
        for (const double stroke : wish.strokes) EXPECT_TRUE(stroke >= 0.0 && stroke <= 1.0) << trail_;
        if (wish.rig == good_) return;
        good_ = wish.rig;
        EXPECT_TRUE(Judge::sound(good_->parts())) << trail_ << "has brought the loop what is no rig";
        std::vector<double> strokes(good_->actuatorCount());
        for (double& stroke : strokes) stroke = between(random_, 0, 1);
        for (const glm::vec3& p : deformed(*good_, strokes).positions)
            ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << trail_;
        const Box& reach = good_->reach();
        EXPECT_TRUE(std::isfinite(glm::length(reach.max - reach.min))) << trail_;
    }

    Random random_;
    StudioDocument document_;
    Notices notices_;
    RigCompiler compiler_{document_, notices_};
    std::deque<Known> known_; ///< what the steps of undo hold, the first the farthest back
    std::size_t at_ = 0;
    const QUndoCommand* top_ = nullptr;
    std::shared_ptr<const Rig> good_; ///< the last rig that was looked at
    std::string trail_;
    std::size_t steps_ = 0;
    std::size_t undone_ = 0;
    std::size_t refused_ = 0;
};

struct Kind {
    const char* name;
    std::function<Rig()> make;
};

Rig templateRig(const char* name, const std::vector<TemplateChoice>& choices = {}) {
    return rigOf(rigTemplate(name), choices);
}

class RigWalk : public testing::TestWithParam<Kind> {};

TEST_P(RigWalk, EachUndoGivesBackEveryByteAndTheLoopGetsNothingBroken) {
    test::needApplication();
    const int steps = test::longTests() ? 1000 : 100; // of each of ten rigs
    Walk walk(GetParam().make(), 20 + GetParam().name[0]);
    for (int k = 0; k < steps && !HasFailure(); ++k) walk.step();
    walk.rest();
    EXPECT_GT(walk.undone(), static_cast<std::size_t>(steps / 4));
    EXPECT_GT(walk.refused(), 0U) << "the nonsense was none";
}

INSTANTIATE_TEST_SUITE_P(Rigs, RigWalk,
                         testing::Values(Kind{"Tablet",
                                              [] {
                                                  return templateRig("tablet", {{"top", 0.0}});
                                              }},
                                         Kind{"Phone", [] { return templateRig("phone"); }},
                                         Kind{"Pins",
                                              [] {
                                                  return templateRig("pins", {{"columns", 4}, {"rows", 3}});
                                              }},
                                         Kind{"Flower", [] { return templateRig("flower"); }},
                                         Kind{"Book", [] { return templateRig("book"); }},
                                         Kind{"Cushion", [] { return test::cushionRig(); }},
                                         Kind{"Sheet", [] { return templateRig("sheet"); }},
                                         Kind{"Arm", [] { return test::armRig(); }},
                                         Kind{"Lifter", [] { return test::lifterRig(); }},
                                         Kind{"Ribbon", [] { return ribbonRig(); }}),
                         [](const auto& kind) { return std::string(kind.param.name); });

} // namespace
} // namespace lumorph::studio

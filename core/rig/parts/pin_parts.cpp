#include <algorithm>
#include <cmath>
#include <set>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rig/parts/bed_split.h"
#include "core/rig/parts/plan_making.h"
#include "core/rig/parts/servo_seat.h"
#include "core/rig/templates/flap_layout.h"

namespace lumorph {
namespace {

// Millimetres.
constexpr double kWeb = 0.8; ///< that stays between two holes
constexpr double kLeastShaft = 1.5;
constexpr double kHead = 2.0;  ///< thickness of a pin's head
constexpr double kGuide = 3.0; ///< thickness of the guide
constexpr double kBaseFloor = 2.0;
constexpr double kBaseWall = 2.0;
constexpr double kBorder = 9.0; ///< of base beyond the pins, for walls and screw posts
constexpr double kCornerPost = 3.2;
constexpr double kBankBaseFloor = 2.0; ///< under the seats of a bank
constexpr double kCellGap = 1.0;

struct Pin {
    glm::dvec2 low{0.0};
    glm::dvec2 high{0.0};
    double top = 0.0; ///< height at rest
    double way = 0.0; ///< of its slide
    [[nodiscard]] glm::dvec2 middle() const { return 0.5 * (low + high); }
};

/// The pin that an actuator slides up: one level rectangle of a mesh's vertices.
bool readPin(const Rig& rig, const Actuator& actuator, double bottom, Pin& pin) {
    const auto* slide = std::get_if<Slide>(&actuator.deformer);
    if (slide == nullptr || actuator.influences.size() != 4 || slide->max <= slide->min) return false;
    const glm::vec3 way = glm::normalize(slide->direction);
    if (way.y < 0.999F) return false;
    pin.low = glm::dvec2(1e9);
    pin.high = glm::dvec2(-1e9);
    std::set<long> corners;
    for (const Influence& influence : actuator.influences) {
        const glm::vec3& p = rig.restMesh().positions[influence.vertex];
        const glm::dvec2 at = pageOf({p.x, p.z});
        pin.low = glm::min(pin.low, at);
        pin.high = glm::max(pin.high, at);
        pin.top = 1e3 * (p.y - bottom);
        corners.insert(std::lround(1e3 * p.y * 1e3));
    }
    pin.way = 1e3 * (slide->max - slide->min);
    return corners.size() == 1 && glm::all(glm::greaterThan(pin.high - pin.low, glm::dvec2(0.1)));
}

std::vector<Pin> pinsOf(const Rig& rig) {
    std::vector<Pin> pins;
    const double bottom = boundingBox(rig.restMesh().positions).min.y;
    for (const Actuator& actuator : rig.actuators()) {
        Pin pin;
        if (!readPin(rig, actuator, bottom, pin)) return {};
        pins.push_back(pin);
    }
    return pins;
}

class PinParts {
public:
    PinParts(BuildPlan& plan, const Rig& rig, const PartOptions& options)
        : plan_(plan), options_(options), pins_(pinsOf(rig)), seat_(options.servo, options.tolerance) {
        low_ = glm::dvec2(1e9);
        high_ = glm::dvec2(-1e9);
        double gap = 1e9; // the least from one pin's middle to the next, along either side
        for (const Pin& pin : pins_) {
            low_ = glm::min(low_, pin.low);
            high_ = glm::max(high_, pin.high);
            way_ = std::max(way_, pin.way);
            plate_ = std::max(plate_, pin.top);
            head_ = std::max({head_, pin.high.x - pin.low.x, pin.high.y - pin.low.y});
        }
        for (std::size_t k = 1; k < pins_.size(); ++k) {
            const glm::dvec2 step = glm::abs(pins_[k].middle() - pins_[0].middle());
            gap = std::min(gap, std::max(step.x, step.y));
        }
        shaft_ = std::min(head_, gap - kWeb - 2.0 * options.tolerance);
        if (shaft_ < kLeastShaft)
            throw InvalidInput("pins", "between two of them no guide can be printed",
                               "choose a larger pitch or a smaller tolerance");
    }

    void make(const Progress& progress) {
        addPart(plan_, options_, pin(),
                {"pin", "one for each actuator; printed lying", "PLA or PETG", static_cast<int>(pins_.size()), {}});
        progress.throwIfCancelled();
        progress.report(0.3, "drawing guide and base");
        const BedSplit split(outline(), options_.bed, options_.tolerance);
        addPieces(split, guide(), {"guide", "leads the pins at the top", "PLA or PETG", 1, {}});
        progress.throwIfCancelled();
        progress.report(0.6, "drawing guide and base");
        addPieces(split, base(), {"base", "leads the pins at the bottom and carries the guide", "PLA or PETG", 1, {}});
        progress.throwIfCancelled();
        progress.report(0.9, "drawing seats");
        addBanks();
        addWords(split.needed());
    }

private:
    [[nodiscard]] PlanePolygon outline() const { return rectangle(low_ - kBorder, high_ + kBorder); }

    [[nodiscard]] std::vector<glm::dvec2> posts() const {
        const glm::dvec2 low = low_ - kBorder + kBaseWall + kCornerPost - 1.0;
        const glm::dvec2 high = high_ + kBorder - kBaseWall - kCornerPost + 1.0;
        return {low, {high.x, low.y}, high, {low.x, high.y}};
    }

    /// Lying on a side that shaft and head share, so that the shaft is nearer to it than the middle of the head.
    [[nodiscard]] LayeredDrawing pin() const {
        const double length = plate_ + way_;
        Region both;
        both.add(rectangle({0.0, 0.5 * (head_ - shaft_)}, {length, 0.5 * (head_ + shaft_)}))
            .add(rectangle({length - kHead, 0.0}, {length, head_}));
        LayeredDrawing drawing{{{shaft_, both}}};
        if (head_ > shaft_ + 0.05) {
            Region head;
            head.add(rectangle({length - kHead, 0.0}, {length, head_}));
            drawing.layers.push_back({head_, head});
        }
        return drawing;
    }

    /// Below its pin's shaft.
    [[nodiscard]] std::vector<PlanePolygon> holes() const {
        std::vector<PlanePolygon> holes;
        const double half = 0.5 * shaft_ + options_.tolerance;
        for (const Pin& pin : pins_) {
            const glm::dvec2 at(pin.middle().x, pin.low.y + 0.5 * shaft_);
            holes.push_back(rectangle(at - half, at + half));
        }
        return holes;
    }

    [[nodiscard]] LayeredDrawing guide() const {
        Region plate;
        plate.add(outline()).cut(holes());
        for (const glm::dvec2& post : posts()) plate.cut(disc(post, 0.5 * ServoSeat::kScrewHole));
        return {{{kGuide, plate}}};
    }

    [[nodiscard]] LayeredDrawing base() const {
        Region floor;
        floor.add(outline()).cut(holes());
        Region walls;
        walls.add(outline()).cut(rectangle(low_ - kBorder + kBaseWall, high_ + kBorder - kBaseWall));
        for (const glm::dvec2& post : posts()) walls.add(disc(post, kCornerPost));
        for (const glm::dvec2& post : posts()) walls.cut(disc(post, 0.5 * ServoSeat::kScrewPilot));
        const double height = std::max(plate_ - kHead - kGuide, kBaseFloor + 5.0);
        return {{{kBaseFloor, floor}, {height, walls}}};
    }

    void addPieces(const BedSplit& split, const LayeredDrawing& drawing, const PrintPart& part) {
        if (!split.needed()) {
            addPart(plan_, options_, drawing, part);
            return;
        }
        int number = 0;
        for (const LayeredDrawing& piece : split.pieces(drawing)) {
            PrintPart numbered = part;
            numbered.name += "-" + std::to_string(++number);
            addPart(plan_, options_, piece, std::move(numbered));
        }
    }

    /// Seats side by side on one floor, as many as the bed holds; the last bank has the rest.
    void addBanks() {
        const PlanePolygon cell = seat_.outline();
        const glm::dvec2 size = cell[2] - cell[0] + glm::dvec2(kCellGap, leverRoom());
        const int columns = std::max(1, static_cast<int>(options_.bed / size.x));
        const int rows = std::max(1, static_cast<int>(options_.bed / size.y));
        const int all = static_cast<int>(pins_.size());
        const int full = all / (columns * rows);
        if (full > 0) addBank("seat-bank", columns * rows, columns, size, full);
        if (all % (columns * rows) > 0) addBank("seat-bank-rest", all % (columns * rows), columns, size, 1);
        plan_.bought.push_back({std::string(options_.servo.name) + " servo, with its horn", "move the pins", all});
        plan_.bought.push_back({"self-tapping screw 2 x 8 mm", "guide onto the base", 4});
        for (WiringRow& row : plan_.wiring) row.seat = "seat-bank";
    }

    [[nodiscard]] double leverRoom() const { return leverPlane(options_.servo) - options_.servo.height + 4.0; }

    void addBank(const std::string& name, int seats, int columns, const glm::dvec2& size, int count) {
        LayeredDrawing bank;
        Region floor;
        for (int k = 0; k < seats; ++k) {
            const int row = k / columns;
            const glm::dvec2 at(size.x * (k % columns), size.y * row);
            const LayeredDrawing seat = seat_.drawing({at, {1.0, 0.0}, {0.0, 1.0}}, 0.0);
            floor.add(rectangle(at + seat_.outline()[0], at + seat_.outline()[0] + size));
            for (const glm::dvec2& screw : seat_.screws()) floor.cut(disc(at + screw, 0.5 * ServoSeat::kScrewPilot));
            if (bank.layers.empty()) bank.layers.resize(seat.layers.size());
            for (std::size_t l = 0; l < seat.layers.size(); ++l) {
                bank.layers[l].top = kBankBaseFloor + seat.layers[l].top;
                bank.layers[l].region.append(seat.layers[l].region);
            }
        }
        bank.layers.insert(bank.layers.begin(), {kBankBaseFloor, floor});
        addPart(plan_, options_, bank,
                {name, std::to_string(seats) + " servo seats on one floor", "PLA or PETG", count, {}});
    }

    void addWords(bool split) {
        const auto whole = [](double value) { return std::to_string(std::lround(value)); };
        plan_.notes.push_back("A pin slides by " + whole(way_) +
                              " mm and is as much longer than the base is high: stand "
                              "the base on legs, and leave so much room below it.");
        plan_.notes.push_back("The horn of one servo moves a rod by twice its arm, about " +
                              whole(2.0 * options_.servo.hornReach) + " mm" +
                              (2.0 * options_.servo.hornReach < way_
                                   ? "; these pins go farther, so each needs a drum or a rack of " +
                                         whole(std::ceil(way_ / 3.1416)) + " mm diameter on its shaft."
                                   : "."));
        if (split) plan_.notes.push_back("Guide and base come in pieces with dovetails; glue them together.");
        plan_.steps.push_back({"Put the pins in",
                               "Push each pin from above through the guide, and hang the guide over the "
                               "base so that the pins find its holes. The flat side of all heads looks the same way.",
                               {}});
        plan_.steps.push_back({"Screw the guide onto the base", "At the four corners.", {}});
        plan_.steps.push_back({"Lay the servos into the banks",
                               "On their side, the tabs in the slots, the cable out of "
                               "the notch, numbered as in the wiring table.",
                               {}});
        plan_.steps.push_back({"Link pins and servos",
                               "By stiff wire in a sleeve from each horn to the foot of its pin. "
                               "Each pin must fall back by itself or be pushed and pulled.",
                               {}});
    }

    BuildPlan& plan_;
    const PartOptions& options_;
    std::vector<Pin> pins_;
    ServoSeat seat_;
    glm::dvec2 low_{0.0};
    glm::dvec2 high_{0.0};
    double way_ = 0.0;
    double plate_ = 0.0; ///< height of the pins at rest
    double head_ = 0.0;
    double shaft_ = 0.0;
};

} // namespace

bool isPinDisplay(const Rig& rig) { return rig.actuatorCount() > 0 && !pinsOf(rig).empty(); }

void addPinParts(BuildPlan& plan, const Rig& rig, const PartOptions& options, const Progress& progress) {
    PinParts(plan, rig, options).make(progress);
}

} // namespace lumorph

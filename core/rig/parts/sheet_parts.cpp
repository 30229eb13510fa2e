#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <glm/geometric.hpp>

#include "core/base/text.h"
#include "core/rig/parts/plan_making.h"
#include "core/rig/parts/servo_arrangement.h"

namespace lumorph {
namespace {

// Millimetres.
constexpr double kBoardHeight = 4.0;
constexpr double kCableHeight = 5.5;
constexpr double kPostPilot = 1.7;
constexpr double kScrewHead = 5.5; ///< diameter, where a screw sits deeper than the sheet
constexpr double kShares[]{0.0, 0.5, 1.0};
constexpr glm::dvec2 kSeamShifts[]{{0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}, {-0.5, 0.5}, {1.0, 1.0}, {-1.0, -1.0}};

std::string tenths(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

class SheetParts {
public:
    SheetParts(BuildPlan& plan, const SheetLayout& sheet, const PartOptions& options)
        : plan_(plan), sheet_(sheet), options_(options), seat_(options.servo, options.tolerance),
          heights_(sheet, seat_, options.servo), split_(sheet.housing, options.bed, options.tolerance) {
        arrange();
    }

    void make(const Progress& progress) {
        progress.report(0.2, "drawing the housing");
        addPieces(tray(), {"housing", "carries the servos and the board", "PLA or PETG", 1, {}});
        progress.throwIfCancelled();
        progress.report(0.4, "drawing the lid");
        addPieces(lid(), {"lid", "closes the housing and carries the sheet", "PLA or PETG", 1, {}});
        progress.throwIfCancelled();
        progress.report(0.6, "drawing the sheet");
        addPieces(sheetDrawing(), {"sheet", "the surface that bends", "TPU, or cut it from a flexible plate", 1, {}});
        progress.throwIfCancelled();
        progress.report(0.8, "drawing seats and levers");
        addSeats();
        addLevers();
        addWiring();
        addBought();
        addNotes();
        addSteps();
        plan_.sheet = sheet_.sheet;
    }

private:
    /// Where seams are in the way of levers, other seams are tried.
    void arrange() {
        std::vector<std::string> names;
        for (const WiringRow& row : plan_.wiring) names.push_back(row.actuator);
        arrangement_ = arrangeHousing(sheet_, names, options_, heights_, split_);
        for (const glm::dvec2& shift : kSeamShifts) {
            if (arrangement_.leverless == 0 || !split_.needed()) return;
            const BedSplit split(sheet_.housing, options_.bed, options_.tolerance, shift);
            HousingArrangement other = arrangeHousing(sheet_, names, options_, heights_, split);
            if (other.leverless >= arrangement_.leverless) continue;
            arrangement_ = std::move(other);
            split_ = split;
        }
    }

    [[nodiscard]] Region walls() const {
        Region region;
        region.add(sheet_.housing).cut(shrunk(sheet_.housing, HousingHeights::kWall));
        for (const glm::dvec2& post : arrangement_.posts) region.add(disc(post, HousingArrangement::kPost));
        region.keep(sheet_.housing);
        for (const glm::dvec2& post : arrangement_.posts) region.cut(disc(post, 0.5 * kPostPilot));
        return region;
    }

    [[nodiscard]] LayeredDrawing tray() const {
        Region floor;
        floor.add(sheet_.housing);
        for (const PlacedServo& servo : arrangement_.servos)
            for (const glm::dvec2& screw : seat_.screws())
                floor.cut(disc(servo.seat.page(screw), 0.5 * ServoSeat::kScrewHole));
        Region low = walls();
        if (arrangement_.board) {
            const PlanePolygon& inner = *arrangement_.board;
            low.add(
                {rectangle(inner[0] - HousingArrangement::kBoardRim, inner[2] + HousingArrangement::kBoardRim), inner});
        }
        Region high = walls();
        high.cut(arrangement_.cable);
        return {{{HousingHeights::kFloor, floor},
                 {HousingHeights::kFloor + kBoardHeight, low},
                 {heights_.tray - kCableHeight, walls()},
                 {heights_.tray, high}}};
    }

    [[nodiscard]] LayeredDrawing lid() const {
        Region plate;
        plate.add(sheet_.housing);
        Region pads;
        pads.add(sheet_.still);
        for (const glm::dvec2& post : arrangement_.posts) {
            plate.cut(disc(post, 0.5 * ServoSeat::kScrewHole));
            pads.cut(disc(post, 0.5 * kScrewHead));
        }
        for (const PlacedServo& servo : arrangement_.servos) {
            plate.cut(servo.slot);
            pads.cut(servo.slot);
        }
        return {{{HousingHeights::kLid, plate}, {HousingHeights::kLid + sheet_.underside - sheet_.ledge, pads}}};
    }

    [[nodiscard]] LayeredDrawing sheetDrawing() const {
        Region region;
        region.add(sheet_.sheet);
        return {{{sheet_.top - sheet_.underside, region}}};
    }

    void addPieces(const LayeredDrawing& drawing, const PrintPart& part) {
        const std::vector<LayeredDrawing> pieces = split_.needed() ? split_.pieces(drawing) : std::vector{drawing};
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            PrintPart piece = part;
            if (pieces.size() > 1) {
                piece.name += "-" + std::to_string(k + 1);
                piece.use += ", piece " + std::to_string(k + 1) + " of " + std::to_string(pieces.size());
            }
            addPart(plan_, options_, pieces[k], std::move(piece));
        }
    }

    void addSeats() {
        for (const bool mirrored : {false, true}) {
            int count = 0;
            for (const PlacedServo& servo : arrangement_.servos) count += servo.seat.mirrored() == mirrored ? 1 : 0;
            if (count == 0) continue;
            SeatPlace place;
            if (mirrored) place.side.x = -1.0;
            addPart(plan_, options_, seat_.drawing(place, heights_.plinth),
                    {seatName(mirrored), "holds a servo on its side", "PLA or PETG", count, {}});
        }
    }

    static std::string seatName(bool mirrored) { return mirrored ? "seat-mirrored" : "seat"; }
    /// Longer pulses turn a shaft anticlockwise, seen from the horn; a flap rises right-handed about `along`.
    [[nodiscard]] bool isReversed(const PlacedServo& servo) const {
        return glm::dot(servo.seat.out, sheet_.flaps[servo.flap].frame.along) < 0.0;
    }
    [[nodiscard]] std::string leverName(const PlacedServo& servo) const {
        return "lever-" + tenths(servo.lever->length) + (isReversed(servo) ? "mm" : "mm-mirrored");
    }

    void addLevers() {
        std::map<std::string, std::pair<const PlacedServo*, int>> kinds;
        for (const PlacedServo& servo : arrangement_.servos)
            if (servo.lever) ++kinds.try_emplace(leverName(servo), &servo, 0).first->second.second;
        for (const auto& [name, kind] : kinds)
            addPart(plan_, options_,
                    leverDrawing(*kind.first->lever, options_.servo, options_.tolerance, !isReversed(*kind.first)),
                    {name, "lifts a flap from below", "PLA or PETG", kind.second, {}});
    }

    void addWiring() {
        for (const PlacedServo& servo : arrangement_.servos) {
            const SheetFlap& flap = sheet_.flaps[servo.flap];
            WiringRow& row = plan_.wiring[flap.actuator];
            row.seat = seatName(servo.seat.mirrored());
            row.lever = servo.lever;
            if (!servo.lever) continue;
            row.reversed = isReversed(servo);
            const double span =
                std::min(row.pulseMax - row.pulseMin, servo.lever->turn().inDegrees() / options_.servo.degreesPerPulse);
            row.reversed ? row.pulseMin = row.pulseMax - span : row.pulseMax = row.pulseMin + span;
            if (!flap.captive) row.curve = pulseCurveOf(*servo.lever, flap, sheet_.top - sheet_.underside);
        }
    }

    void addBought() {
        const int servos = static_cast<int>(arrangement_.servos.size());
        const int posts = static_cast<int>(arrangement_.posts.size());
        if (servos > 0)
            plan_.bought.push_back(
                {std::string(options_.servo.name) + " servo, with its horn", "move the flaps", servos});
        plan_.bought.push_back({"self-tapping screw 2 x 6 mm", "lid onto the housing's posts", posts});
        if (servos > 0)
            plan_.bought.push_back({"self-tapping screw 2 x 8 mm", "seats onto the floor, from below", 2 * servos});
    }

    void addNotes() {
        if (split_.needed())
            plan_.notes.push_back(
                "Housing, lid and sheet are larger than the bed and come in pieces with dovetails; glue "
                "them together. The sheet is better cut in one piece: sheet.svg is its outline.");
        if (heights_.deeper > 0.05)
            plan_.notes.push_back("The printed housing is " + tenths(heights_.deeper) +
                                  " mm higher than in the rig, because a servo of this size needs it: the sheet lies "
                                  "that much higher above the table.");
        if (!arrangement_.board && !arrangement_.servos.empty())
            plan_.notes.push_back(
                "The housing has no room for the board; it stays outside, and the servos' cables leave "
                "through the opening.");
        for (const PlacedServo& servo : arrangement_.servos) addLiftNote(servo);
    }

    void addLiftNote(const PlacedServo& servo) {
        const SheetFlap& flap = sheet_.flaps[servo.flap];
        const std::string& name = plan_.wiring[flap.actuator].actuator;
        const double wanted = flap.angle.inDegrees();
        if (!servo.lever)
            plan_.notes.push_back("No lever fits under the flap of " + inQuotes(name) +
                                  "; link it to its servo by a wire, through the hole of the lid.");
        else if (!flap.captive && servo.lever->lifted.inDegrees() < wanted - 1.0)
            plan_.notes.push_back("The flap of " + inQuotes(name) + " is short: its lever lifts it by " +
                                  std::to_string(std::lround(servo.lever->lifted.inDegrees())) + " of its " +
                                  std::to_string(std::lround(wanted)) + " degrees.");
    }

    [[nodiscard]] std::string arrangementPicture() const {
        PlanPicture picture;
        picture.add(sheet_.housing, "wall");
        picture.add(shrunk(sheet_.housing, HousingHeights::kWall), "floor");
        if (arrangement_.board) picture.add(*arrangement_.board, "board");
        for (const PlacedServo& servo : arrangement_.servos) {
            picture.add(servo.seat.page(seat_.outline()), "seat");
            const ServoBody& b = options_.servo;
            picture.add(servo.seat.page(rectangle({-b.shaft, 0.0}, {b.length - b.shaft, b.height})), "servo");
            picture.add(servo.slot, "lever");
        }
        for (const glm::dvec2& post : arrangement_.posts) picture.add(disc(post, HousingArrangement::kPost), "screw");
        picture.add(arrangement_.cable, "floor");
        for (const PlacedServo& servo : arrangement_.servos)
            picture.text(
                servo.seat.page({0.5 * options_.servo.length - options_.servo.shaft, 0.45 * options_.servo.height}),
                plan_.wiring[sheet_.flaps[servo.flap].actuator].actuator);
        return picture.svg();
    }

    [[nodiscard]] std::string sheetPicture() const {
        PlanPicture picture;
        picture.add(sheet_.housing, "wall");
        picture.add(sheet_.sheet, "floor");
        picture.add(sheet_.still, "seat");
        return picture.svg();
    }

    /// A lever from the side: at rest, halfway and at the end, with the flap as it lies on it.
    [[nodiscard]] std::string leverPicture(const PlacedServo& servo) const {
        const Lever& lever = *servo.lever;
        PlanPicture picture;
        const double depth = lever.reach() + 8.0;
        picture.add(rectangle({-10.0, -lever.below - 0.5 * options_.servo.width},
                              {depth, -lever.below - 0.5 * options_.servo.width - HousingHeights::kFloor}),
                    "wall");
        for (const double share : kShares) {
            const double angle = lever.rest.inRadians() + share * lever.turn().inRadians();
            const glm::dvec2 shaft(lever.pivot, -lever.below);
            const glm::dvec2 way(std::cos(angle), std::sin(angle));
            for (PlanePolygon& shape : leverShapes(lever, options_.servo, options_.tolerance)) {
                for (glm::dvec2& p : shape) p = shaft + p.x * way + p.y * glm::dvec2(-way.y, way.x);
                picture.add(shape, "lever");
            }
        }
        const double thickness = sheet_.top - sheet_.underside;
        picture.add(rectangle({-10.0, 0.0}, {depth, thickness}), "seat");
        picture.add(bentStrip(sheet_.flaps[servo.flap].arc, lever.lifted.inRadians(), depth, thickness), "seat");
        return picture.svg();
    }

    static PlanePolygon bentStrip(double arc, double angle, double length, double thickness) {
        PlanePolygon strip;
        const auto at = [&](double s, double v) {
            const double turned = angle * std::min(1.0, s / arc);
            const double radius = arc / angle;
            const glm::dvec2 out(std::sin(turned), -std::cos(turned));
            return glm::dvec2(0.0, 0.5 * thickness + radius) + (radius - v) * out +
                   std::max(0.0, s - arc) * glm::dvec2(std::cos(turned), std::sin(turned));
        };
        for (int k = 0; k <= 20; ++k) strip.push_back(at(k < 20 ? arc * k / 19.0 : length, -0.5 * thickness));
        for (int k = 20; k >= 0; --k) strip.push_back(at(k < 20 ? arc * k / 19.0 : length, 0.5 * thickness));
        return strip;
    }

    void addSteps() {
        const bool servos = !arrangement_.servos.empty();
        if (split_.needed())
            plan_.steps.push_back({"Join the pieces",
                                   "Press the dovetails of housing, lid and sheet into one another from "
                                   "above, on a level table, and glue them.",
                                   {}});
        if (servos) {
            plan_.steps.push_back(
                {"Screw the seats into the housing",
                 "Each seat lies over two holes of the floor. Seats whose parts are called mirrored go "
                 "where the picture shows the shaft on the other side. Screw them from below.",
                 arrangementPicture()});
            plan_.steps.push_back(
                {"Lay the servos into their seats",
                 "On their side, the tabs in the slots, the cable out of the notch. Number the cables "
                 "as in the wiring table, and lead them to the board.",
                 {}});
            addLeverStep();
            plan_.steps.push_back({"Wire the board",
                                   "As in the wiring table: signal to the pin, red to 5 V, brown to "
                                   "ground. Lead the power cable out through the opening of the wall.",
                                   {}});
        }
        plan_.steps.push_back(
            {"Close the lid",
             "Its raised pads look up. " +
                 std::string(servos ? "The levers stand in its slots. It holds the servos down. " : "") +
                 "Screw it to the posts.",
             {}});
        plan_.steps.push_back({"Glue the sheet onto the pads",
                               "Only where it does not move (the darker part); the rest stays free of glue.",
                               sheetPicture()});
        if (std::ranges::any_of(sheet_.flaps, [](const SheetFlap& flap) { return flap.captive.has_value(); }))
            plan_.steps.push_back(
                {"Hold the sheet by its slots",
                 "Drill 1 mm through the nose of each lever. Lead a loop of wire from it up through the "
                 "slot and around a pin across the slot, above the sheet: so the lever holds the sheet "
                 "down as well as up, and slides in the slot as it turns. Lay the paper on top, loose.",
                 {}});
        if (servos)
            plan_.steps.push_back(
                {"Try it in the studio",
                 "Upload the sketch of this folder to the board, open profile.json "
                 "in Devices, and move one servo after the other in slow mode. One that goes the wrong "
                 "way is set to reversed there.",
                 {}});
    }

    void addLeverStep() {
        std::string text = "Send every servo to rest (in the studio, Devices, or by the sketch). Press the lever onto "
                           "the horn, then the horn onto the shaft, at the angle above level that stands here, so that "
                           "its nose touches the sheet from below:";
        std::string picture;
        for (const PlacedServo& servo : arrangement_.servos) {
            if (!servo.lever) continue;
            text += "\n" + plan_.wiring[sheet_.flaps[servo.flap].actuator].actuator + ": " + leverName(servo) +
                    ", rest " + tenths(servo.lever->rest.inDegrees()) + " degrees, end " +
                    tenths(servo.lever->end.inDegrees()) + " degrees";
            if (picture.empty() && !sheet_.flaps[servo.flap].captive) picture = leverPicture(servo);
        }
        plan_.steps.push_back({"Set the levers", text, picture});
    }

    BuildPlan& plan_;
    const SheetLayout& sheet_;
    const PartOptions& options_;
    ServoSeat seat_;
    HousingHeights heights_;
    BedSplit split_;
    HousingArrangement arrangement_;
};

} // namespace

void addSheetParts(BuildPlan& plan, const SheetLayout& sheet, const PartOptions& options, const Progress& progress) {
    SheetParts(plan, sheet, options).make(progress);
}

} // namespace lumorph

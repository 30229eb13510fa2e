#pragma once

#include "core/rig/parts/build_plan.h"
#include "core/rig/parts/sheet_layout.h"

namespace lumorph {

/// For the kinds of rigs: adds a part that lies on the bed as it is. Throws InvalidInput when it is larger than that.
void addPart(BuildPlan& plan, const PartOptions& options, const LayeredDrawing& drawing, PrintPart part);

/// Housing, lid, sheet, seats and levers. `plan` has its wiring, one row an actuator.
void addSheetParts(BuildPlan& plan, const SheetLayout& sheet, const PartOptions& options, const Progress& progress);

/// Whether all actuators are upright square pins that slide up.
[[nodiscard]] bool isPinDisplay(const Rig& rig);
void addPinParts(BuildPlan& plan, const Rig& rig, const PartOptions& options, const Progress& progress);

/// Seats that stand alone, with caps.
void addLoneSeats(BuildPlan& plan, const PartOptions& options);

/// A plan view as inline SVG: polygons with a class each (`floor`, `wall`, `seat`, `lever`, `board`, `screw`), and
/// texts.
class PlanPicture {
public:
    void add(const PlanePolygon& polygon, const char* kind);
    void add(const std::vector<PlanePolygon>& evenOdd, const char* kind);
    void text(const glm::dvec2& at, const std::string& words);
    [[nodiscard]] std::string svg() const;

private:
    void include(const glm::dvec2& p);
    glm::dvec2 low_{1e9};
    glm::dvec2 high_{-1e9};
    std::string body_;
};
/// The layers of a part, the higher the lighter.
[[nodiscard]] std::string pictureOf(const LayeredSolid& solid);
/// Text fit for HTML and SVG.
[[nodiscard]] std::string escaped(const std::string& text);

} // namespace lumorph

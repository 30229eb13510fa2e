#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <QImage>
#include <QSize>
#include <glm/vec3.hpp>

#include "core/loop/match_frame.h"
#include "core/scene/show_frame.h"

namespace lumorph::studio {

/// One way to look at a frame of the show.
struct ShowView {
    enum class Kind {
        eye,       ///< what the viewer should see
        projector, ///< what a projector sends out
        lab,       ///< the lit device and table, as somebody sees them
    };
    /// The device as it is, or, to compare: a half of BendComparison, both seen by the same camera.
    enum class Bend { asItIs, without, forViewer };

    Kind kind = Kind::eye;
    std::size_t projector = 0;
    std::optional<glm::vec3> observer; ///< of the lab, world metres; none: the viewer's own eye
    Bend bend = Bend::asItIs;
    bool lit = true;    ///< of the lab: in the projectors' light, else the bare device in a lit room
    double lower = 0.0; ///< of the lab: radians by which the eye is lower
    bool exact = false; ///< of a projector: all its pixels, none of them scaled
    bool operator==(const ShowView&) const = default;
    [[nodiscard]] bool needsProjectors() const { return kind == Kind::projector || (kind == Kind::lab && lit); }
};

/// A view and the room there is for it, pixels of the screen. A projector's picture keeps its shape within that room,
/// an exact one has its own size.
struct WantedView {
    int id = 0;
    ShowView view;
    QSize pixels;
};

/// One frame of the loop and how it is to be seen. All views of it share the two passes.
struct ShowRequest {
    std::shared_ptr<const MatchFrame> match; ///< with a scene and its assets
    std::vector<WantedView> views;
    bool refine = true;   ///< when nothing newer comes, draw it again in full quality
    bool measure = false; ///< wait for each pass, so that its time is its own
};

/// Milliseconds of the stages of one drawn frame.
struct ShowTimes {
    double latency = 0.0; ///< from the oldest pose used to the light, as it was predicted; 0: nothing is tracked
    double pose = 0.0, upload = 0.0, shadow = 0.0, eye = 0.0, projectors = 0.0, lab = 0.0, readBack = 0.0, total = 0.0;
};

/// A frame of the show as pictures.
struct DrawnShow {
    struct Picture {
        int id = 0;
        ShowView view;
        QImage image;
    };
    std::shared_ptr<const MatchFrame> match;
    std::shared_ptr<const ShowFrame> frame; ///< as posed, for picking
    std::vector<Picture> pictures;
    ShowTimes ms;
    bool still = false;      ///< in full quality
    double resolution = 1.0; ///< share of each side that it was drawn with
    /// What the renderer had to do without, with file and line.
    std::vector<std::string> warnings;
};

} // namespace lumorph::studio

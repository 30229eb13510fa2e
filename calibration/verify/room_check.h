#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/verify/check_pass.h"
#include "calibration/verify/moved_part.h"

namespace lumorph {

/// How far the light of one projector pixel lies from where it was meant to be.
struct LightError {
    std::size_t shot = 0, projector = 0;
    bool isOnDevice = false;
    glm::dvec3 place{0.0};  ///< of the surface, as it is believed to stand, where the light was seen; world metres
    glm::dvec3 beside{0.0}; ///< along the surface: from where it was meant to be to where it is, metres
};

/// Lengths of an error map, metres.
struct ErrorSummary {
    double median = 0.0;
    double most = 0.0; ///< of 95 in 100 places
    double worst = 0.0;
    std::size_t places = 0;
};
[[nodiscard]] ErrorSummary summaryOf(std::span<const LightError> map);

/// How far light lies beside, for each point that was seen: the room as it `is` (camera, device and strokes as found)
/// against what projectors and device were `believed` to be when the show was made. Places where the believed surface
/// is grazed, or that are more than `most` metres beside (the camera saw something else there), are left out.
/// `strokes`: where the actuators really stood, a list a shot.
[[nodiscard]] std::vector<LightError> lightErrors(const Rig& rig, const Installation& believed, const Installation& is,
                                                  std::span<const LitShot> shots,
                                                  std::span<const std::vector<double>> strokes, std::size_t camera = 0,
                                                  double most = 0.05);

/// What a check found.
struct RoomCheck {
    enum class Verdict { good, moved, none };
    Verdict verdict = Verdict::none;
    std::optional<NoVerdict> obstacle; ///< why there is none
    std::string sentence;              ///< all of it in one or two, for a host to read
    MovedParts found;
    std::vector<std::string> names;       ///< of `found.parts`
    std::vector<std::string> couldAlsoBe; ///< names of `found.couldAlsoBe`
    std::vector<LightError> map;          ///< as the show runs now
    ErrorSummary now, device, table;      ///< of the map, and of its two parts
    ErrorSummary corrected;               ///< of what would be left with `installation`
    /// With what moved put where it was found, its origin measured: the believed one where nothing moved, or it is not
    /// known what.
    Installation installation;
};
[[nodiscard]] const char* wordOf(RoomCheck::Verdict verdict);

/// A check of one minute: light that was read while the device stood in one or several bends, against the room as it is
/// believed to be. Throws as `movedParts`; Cancelled.
[[nodiscard]] RoomCheck checkRoom(const Rig& rig, const Installation& believed, std::span<const LitShot> shots,
                                  const MovedPartOptions& options = {}, const Progress& progress = {});
/// A check that could not be made.
[[nodiscard]] RoomCheck withoutVerdict(const Installation& believed, NoVerdict reason);

/// The installation with what moved put where it was found: poses of projectors, the camera, the device's place, curves
/// of servos, each measured now.
[[nodiscard]] Installation correctedBy(const Installation& believed, const Rig& rig, const MovedParts& found,
                                       std::size_t camera = 0);
/// Takes over what a check corrected, and nothing else: poses, the device's place and servos whose origin is a check
/// and that the room has not from a later measurement.
void takeCorrections(const Installation& corrected, Installation& room);

} // namespace lumorph

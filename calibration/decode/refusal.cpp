#include "calibration/decode/refusal.h"

#include <algorithm>
#include <array>
#include <utility>

namespace lumorph {

namespace {

constexpr std::array<std::string_view, kCauseCount> kCauseKeys = {"missing_image",
                                                                  "doubled_image",
                                                                  "late_frame",
                                                                  "wrong_order",
                                                                  "unreadable_image",
                                                                  "image_size",
                                                                  "black_white_swapped",
                                                                  "inverse_swapped",
                                                                  "mirrored",
                                                                  "rig_moved",
                                                                  "projector_size",
                                                                  "width_height_swapped",
                                                                  "frontal_views",
                                                                  "too_few_views",
                                                                  "clipped",
                                                                  "underexposed",
                                                                  "exposure_drifts",
                                                                  "board_not_found",
                                                                  "board_unlit",
                                                                  "too_few_points",
                                                                  "points_degenerate",
                                                                  "point_suspicious",
                                                                  "disconnected",
                                                                  "mirror_unknown",
                                                                  "model_does_not_fit",
                                                                  "undetermined",
                                                                  "keystone",
                                                                  "board_warped",
                                                                  "square_size",
                                                                  "strange_lens",
                                                                  "projector_gamma",
                                                                  "camera_refocused",
                                                                  "wrong_units",
                                                                  "doubled_rows",
                                                                  "clock_jumps",
                                                                  "clocks_unknown",
                                                                  "motion_degenerate",
                                                                  "body_swapped",
                                                                  "tip_slipped",
                                                                  "tip_wrong",
                                                                  "tracker_lost",
                                                                  "not_a_number",
                                                                  "fresh_points_far",
                                                                  "servo_dead",
                                                                  "servo_swapped",
                                                                  "servo_reversed",
                                                                  "servo_jammed",
                                                                  "camera_slow",
                                                                  "flash_not_seen",
                                                                  "nothing_moves",
                                                                  "motion_periodic",
                                                                  "camera_saturates",
                                                                  "light_too_dark",
                                                                  "ambient_changes",
                                                                  "camera_adjusts",
                                                                  "response_not_rising",
                                                                  "surface_unseen",
                                                                  "camera_moved",
                                                                  "repeated_poses",
                                                                  "passed_over",
                                                                  "noisy",
                                                                  "bit_order",
                                                                  "period_count",
                                                                  "phase_order",
                                                                  "out_of_focus",
                                                                  "board_size",
                                                                  "board_kind",
                                                                  "hand_in_view",
                                                                  "foreign_image",
                                                                  "unlikely_length",
                                                                  "quaternion_order",
                                                                  "inverted",
                                                                  "time_unit",
                                                                  "turns_in_place",
                                                                  "rows_out_of_order",
                                                                  "lens_model"};

std::string placeOf(const Finding& finding) {
    if (finding.view.empty() && finding.file.empty()) return "capture";
    if (finding.view.empty() || finding.file.empty()) return finding.view + finding.file;
    return finding.view + ", " + finding.file;
}

} // namespace

std::string_view keyOf(Cause cause) { return kCauseKeys.at(static_cast<std::size_t>(cause)); }

std::optional<Cause> causeOf(std::string_view key) {
    const auto found = std::ranges::find(kCauseKeys, key);
    if (found == kCauseKeys.end()) return std::nullopt;
    return static_cast<Cause>(found - kCauseKeys.begin());
}

std::string sentenceOf(const Finding& finding) { return placeOf(finding) + ": " + finding.why + "; " + finding.remedy; }

CaptureRefused::CaptureRefused(Finding finding)
    : DataError(placeOf(finding), finding.why, finding.remedy), finding_(std::move(finding)) {}

} // namespace lumorph

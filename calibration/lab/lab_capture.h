#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/decode/refusal.h"
#include "calibration/lab/board_lab.h"
#include "calibration/lab/lab_folder.h"
#include "calibration/patterns/capture_order.h"
#include "core/base/progress.h"

namespace lumorph {

/// A capture of boards in the virtual lab, to be made.
struct LabCapture {
    Installation room; ///< its first projector and camera; without a camera that of `defaultLabCamera`
    std::string board = "chess:9x7:25";
    std::string pattern = "graycode"; ///< as `parsePattern` reads it
    int poses = 6;
    std::uint32_t seed = 1;
    std::optional<Cause> fault; ///< one of `labFaults`
    BoardLabOptions options;
};

/// Faults that a capture in the lab can have: each is named as the doctor should name it.
[[nodiscard]] std::span<const Cause> labFaults();

/// What was made wrong on purpose.
struct LabFault {
    Cause cause = Cause::lateFrame;
    std::string view, file; ///< empty where it is of no single one
    std::string what;
};

/// Takes a capture, pose by pose.
class LabCapturer {
public:
    /// Throws InvalidInput: a board, pattern or fault that is none, or a board that does not fit into what camera and
    /// projector see.
    explicit LabCapturer(LabCapture capture);
    ~LabCapturer();
    LabCapturer(const LabCapturer&) = delete;
    LabCapturer& operator=(const LabCapturer&) = delete;

    /// The images of the next pose, in the order of the patterns; what is missing is left out. Throws Cancelled, and
    /// InvalidInput after the last.
    [[nodiscard]] std::vector<LabShot> takeNext(const Progress& progress = {});

    [[nodiscard]] const LabCapture& capture() const noexcept; ///< with what its fault makes of its options
    [[nodiscard]] const BoardLab& lab() const noexcept;
    /// Where the board is laid, pose by pose: the world from its frame, metres.
    [[nodiscard]] const std::vector<glm::dmat4>& poses() const noexcept;
    /// What is wrong, as far as it has been photographed.
    [[nodiscard]] const std::vector<LabFault>& faults() const noexcept;
    /// `truth.json` of what has been taken: see resources/guide/formats.md, "A capture of the lab".
    [[nodiscard]] std::string truthText() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Writes a whole capture into a folder, which must be empty or not there: a folder a pose, and `truth.json`. All of it
/// appears at once, at the end, or nothing. Throws InvalidInput for a folder that holds something, DeviceError where
/// the disk refuses, Cancelled.
void writeLabCapture(LabCapturer& capturer, const std::filesystem::path& folder, const Progress& progress = {});

} // namespace lumorph

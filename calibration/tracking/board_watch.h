#pragma once

#include <memory>
#include <optional>
#include <string>

#include "calibration/tracking/board_address.h"
#include "calibration/tracking/board_finder.h"
#include "core/base/image.h"

namespace cv {
class Mat;
}

namespace lumorph {

/// What one picture told.
struct BoardView {
    std::optional<BoardSighting> sighting;
    std::optional<Pose> world; ///< of the body; empty also while the camera's place is not known yet
    std::string advice;        ///< what is wrong with the picture; empty while all is well
};

/// Looks for one board in picture after picture of one camera, whatever their size; knows where the camera stands, or
/// takes it from where the board is seen first. One thread at a time.
class BoardWatch {
public:
    /// Throws as checkBoard.
    explicit BoardWatch(const BoardAddress& address);
    ~BoardWatch();

    /// `picture`: grey or BGR, 8 bits. Throws InvalidInput for a picture without an extent.
    [[nodiscard]] BoardView look(const cv::Mat& picture);
    /// The last picture, at most so many pixels wide, with the board's outline and axes drawn in where it was seen.
    [[nodiscard]] Image preview(int width) const;
    /// What lens and place are taken for, where they are not known; a sentence or two.
    [[nodiscard]] std::string assumptions() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph

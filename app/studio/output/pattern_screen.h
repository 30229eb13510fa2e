#pragma once

#include <cstddef>
#include <memory>

#include <QSize>

#include "app/studio/output/projector_outputs.h"
#include "calibration/capture/pattern_display.h"

namespace lumorph::studio {

/// A projector's window as where a calibration shows its pictures: one after the other in place of the scene, each
/// acknowledged once it is on the screen. Made and deleted in the window's thread; `show` is called in another, such as
/// a job's, and waits there. The scene comes back with `clear`, when this is deleted, and when the window is closed.
class PatternScreen final : public PatternDisplay {
public:
    /// The window must be open, and `outputs` outlive this. Throws DeviceError with what to do where the picture would
    /// not be there pixel by pixel.
    PatternScreen(ProjectorOutputs& outputs, std::size_t projector);
    ~PatternScreen() override;

    [[nodiscard]] cv::Size size() const override;
    /// Throws DeviceError when the window is closed, or shows nothing for five seconds.
    void show(const cv::Mat& picture, const Progress& progress) override;
    void clear() override;

private:
    class Receiver;
    struct Shared;
    std::shared_ptr<Shared> shared_;
    std::unique_ptr<Receiver> receiver_;
};

} // namespace lumorph::studio

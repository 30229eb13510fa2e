#pragma once

#include <memory>

#include "app/studio/calibration/calibration_service.h"
#include "app/studio/calibration/chain_service.h"
#include "app/studio/calibration/crosshair_service.h"
#include "app/studio/calibration/drift_service.h"
#include "app/studio/shell/studio.h"
#include "app/studio/shell/workspace.h"
#include "app/workspaces/calibrate/calibrate_selection.h"

namespace lumorph::studio {

struct CalibrateParts;

/// The workspace "Calibrate": projector and camera, measured step by step, and the whole chain after them.
class CalibrateWorkspace : public Workspace {
    Q_OBJECT
public:
    explicit CalibrateWorkspace(Studio& studio);

    [[nodiscard]] QString id() const override;
    [[nodiscard]] QString title() const override;
    [[nodiscard]] QWidget* makeCentralView() override;
    [[nodiscard]] std::vector<WorkspaceDock> makeDocks() override;
    void setActive(bool active) override;
    void setSeen(bool seen) override;
    /// A folder of images.
    bool takeDrop(const std::vector<std::filesystem::path>& files) override;

    [[nodiscard]] CalibrationService& service() noexcept { return service_; }
    [[nodiscard]] CrosshairService& crosshairs() noexcept { return crosshairs_; }

    [[nodiscard]] ChainService& chain() noexcept { return chain_; }

private:
    [[nodiscard]] CalibrateParts parts();
    void look();
    void addWatchCommand();
    [[nodiscard]] std::unique_ptr<DriftService> makeWatch();
    [[nodiscard]] QString watchObstacle() const;
    void followWatch();
    void tellWatch();
    void checkRoom();
    [[nodiscard]] QWidget* makeSwitched(QWidget* single, QWidget* whole);
    Studio& studio_;
    CalibrationService service_;
    CrosshairService crosshairs_;
    LiveService live_;
    ChainService chain_;
    QAction* watchAction_ = nullptr;
    std::unique_ptr<DriftService> watch_; ///< of the running show; made when it is wanted first
    bool active_ = false, seen_ = false;
    bool looks_ = false; ///< seen with the camera's picture
    CalibrateSelection selection_;
};

} // namespace lumorph::studio

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <QImage>
#include <QObject>
#include <QPointF>
#include <QString>

#include "app/studio/base/step_tone.h"
#include "app/studio/document/studio_document.h"
#include "calibration/solve/crosshair_calibration.h"
#include "core/scene/installation_store.h"

namespace lumorph::studio {

/// Where a calibration by crosshairs stands: a plain value.
struct CrosshairState {
    std::optional<CrosshairSession> session; ///< nothing while there is no device to aim at
    std::vector<bool> leftOut;               ///< one a crosshair: it cannot be seen, or aimed at
    std::size_t current = 0;                 ///< the crosshair that moves
    std::vector<double> strokes;             ///< how the device is to stand meanwhile, one an actuator
    bool isLab = true;                       ///< the light falls in the virtual lab, no window is needed
    std::optional<double> millimetres;       ///< 95 % of light lands within, at the worst place of the device
    QString trouble;                         ///< why there is nothing to aim at or the projector shows nothing
    std::string usedDate;                    ///< of the result as the room uses it; empty: it does not
    [[nodiscard]] std::size_t aimed() const;
    [[nodiscard]] std::optional<std::size_t> open() const; ///< the next that is neither aimed nor left out
};

/// What is to be done next: a sentence, why, and the one button.
struct CrosshairNext {
    enum class Do { nothing, begin, confirm, showSuspicious, use };
    using Tone = StepTone;
    Do what = Do::nothing;
    Tone tone = Tone::quiet;
    QString title, text;
    QString button; ///< empty: there is nothing to press
};
[[nodiscard]] CrosshairNext nextOf(const CrosshairState& state);

/// How it stands about one point, in a few words.
[[nodiscard]] QString wordsOfPoint(const CrosshairState& state, std::size_t index);

/// One projector of the room, calibrated without a camera: a person moves a crosshair that it shows onto named points
/// of the device. Without widgets; lives in the window's thread.
class CrosshairService : public QObject {
    Q_OBJECT
public:
    /// Shows a picture on the room's projector of this number; a null one brings the scene back. Throws DeviceError
    /// with what to do.
    using Shower = std::function<void(std::size_t projector, const QImage& picture)>;
    /// Puts the installation of a version into the document and keeps it; false where that failed.
    using VersionTaker = std::function<bool(const InstallationVersion& version)>;

    CrosshairService(StudioDocument& document, Shower show, VersionTaker take, QObject* parent = nullptr);

    [[nodiscard]] const CrosshairState& state() const noexcept { return state_; }

    /// In sight or not: only then the projector shows the crosshair.
    void setActive(bool active);
    void setLab(bool isLab);
    /// Number of the projector in the room; what was aimed with another one is forgotten.
    void setProjector(std::size_t projector);
    /// Proposes points of the device that is open, and forgets what was aimed.
    void begin();
    void doNext();
    void select(std::size_t index);
    /// Projector pixels; the current crosshair stays within the picture.
    void moveBy(const QPointF& by);
    void moveTo(const QPointF& pixel);
    /// The current crosshair lies right; the next one that is open follows.
    void confirm();
    void setLeftOut(std::size_t index, bool leftOut);
    /// Puts the result into the room: a step of undo, and a version.
    void use();

    /// What the projector shows, its pixels; null without a session.
    [[nodiscard]] QImage picture() const;
    /// The device as the projector sees it, its pixels: in the lab as it truly stands, else as the room has it; null
    /// without a session.
    [[nodiscard]] const QImage& sight() const noexcept { return sight_; }
    /// The point that is meant, in `sight`.
    [[nodiscard]] QPointF target() const;

signals:
    void changed();

private:
    void place(std::size_t index);
    void follow();
    void showPicture();
    void renderSight();
    void followDocument();
    /// Null where the room has none.
    [[nodiscard]] const InstalledProjector* projector() const;

    StudioDocument& document_;
    Shower show_;
    VersionTaker take_;
    CrosshairState state_;
    std::shared_ptr<const Rig> rig_;  ///< that the points are of
    std::vector<cv::Point3d> places_; ///< of the device, where the error is told; device frame
    QImage sight_;
    CalibratedCamera sightCamera_;
    std::string resultDate_;
    std::size_t chosen_ = 0;
    bool active_ = false;
    bool shown_ = false; ///< the projector shows the crosshair
};

} // namespace lumorph::studio

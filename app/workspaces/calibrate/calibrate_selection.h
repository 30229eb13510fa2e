#pragma once

#include <string>

#include <QObject>

namespace lumorph::studio {

/// What of a calibration is looked at; no part of the document.
class CalibrateSelection : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;
    enum class Show { live, white, columns, rows, confidence, errors, map };

    [[nodiscard]] Show show() const noexcept { return show_; }
    [[nodiscard]] const std::string& pose() const noexcept { return pose_; } ///< empty: none
    void set(Show show, const std::string& pose) {
        if (show == show_ && pose == pose_) return;
        show_ = show;
        pose_ = pose;
        emit changed();
    }
    void setShow(Show show) { set(show, pose_); }
    void setPose(const std::string& pose) {
        set(show_ == Show::live || show_ == Show::map ? Show::white : show_, pose);
    }

signals:
    void changed();

private:
    Show show_ = Show::live;
    std::string pose_;
};

} // namespace lumorph::studio

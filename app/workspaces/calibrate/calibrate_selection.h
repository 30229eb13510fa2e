#pragma once

#include <string>
#include <utility>

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

    /// The whole chain is seen, in place of the sequence of projector and camera.
    [[nodiscard]] bool whole() const noexcept { return whole_; }
    void setWhole(bool whole) {
        if (std::exchange(whole_, whole) != whole) emit wholeChanged();
    }

    /// Of the chain the budget is seen, in place of the chosen link.
    [[nodiscard]] bool budget() const noexcept { return budget_; }
    void setBudget(bool budget) {
        if (std::exchange(budget_, budget) != budget) emit budgetChanged();
    }

signals:
    void budgetChanged();
    void wholeChanged();
    void changed();

private:
    Show show_ = Show::live;
    std::string pose_;
    bool whole_ = false;
    bool budget_ = false;
};

} // namespace lumorph::studio

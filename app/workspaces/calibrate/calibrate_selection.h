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

    /// What the whole chain shows: the chosen link, what is connected, or the error budget.
    enum class Page { link, connected, budget };
    [[nodiscard]] Page page() const noexcept { return page_; }
    void setPage(Page page) {
        if (std::exchange(page_, page) != page) emit pageChanged();
    }

signals:
    void pageChanged();
    void wholeChanged();
    void changed();

private:
    Show show_ = Show::live;
    std::string pose_;
    bool whole_ = false;
    Page page_ = Page::link;
};

} // namespace lumorph::studio

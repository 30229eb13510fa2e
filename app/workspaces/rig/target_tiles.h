#pragma once

#include <optional>
#include <vector>

#include <QAbstractButton>
#include <QWidget>

#include "app/workspaces/rig/device_fit.h"

namespace lumorph::studio {

/// One target on the device: its picture, its name and how well it fits, as a bar and in percent.
class TargetTile : public QAbstractButton {
    Q_OBJECT
public:
    TargetTile(const QString& name, QWidget* parent);

    void setFit(const TargetFit& fit, FitRelief relief);
    /// What is shown is of the rig before an edit.
    void setStale(bool stale);
    [[nodiscard]] int percent() const noexcept { return percent_; }
    [[nodiscard]] QSize sizeHint() const override;

protected:
    void paintEvent(QPaintEvent* event) override;
    void changeEvent(QEvent* event) override;
    void enterEvent(QEnterEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    void makePicture(const QSize& pixels);

    FitRelief relief_;
    QImage picture_; ///< of `relief_`, in the size and the theme of the last painting
    int percent_ = 0;
    bool stale_ = false;
};

/// All targets, as many beside one another as fit.
class TargetTiles : public QWidget {
    Q_OBJECT
public:
    explicit TargetTiles(QWidget* parent = nullptr);

    void setFit(const DeviceFit& fit);
    void setStale(bool stale);
    void choose(std::optional<std::size_t> target);
    [[nodiscard]] std::optional<std::size_t> chosen() const noexcept { return chosen_; }

signals:
    void chosenChanged(); ///< by the user

protected:
    void resizeEvent(QResizeEvent* event) override;

private:
    void makeTiles(const LibraryFit& fit);
    void arrange();
    void toggle(std::size_t target);

    std::vector<TargetTile*> tiles_;
    std::vector<std::string> names_;
    std::optional<std::size_t> chosen_;
    int columns_ = 0;
};

} // namespace lumorph::studio

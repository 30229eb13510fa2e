#pragma once

#include <filesystem>
#include <vector>

#include <QMimeData>

#include "app/studio/shell/overlay.h"

namespace lumorph::studio {

/// Files and folders of this computer in what is dragged; empty when there are none.
[[nodiscard]] std::vector<std::filesystem::path> localFiles(const QMimeData& dragged);

/// Says over the whole window what will happen to what is dragged. The pointer passes through it.
class DropOverlay : public Overlay {
    Q_OBJECT
public:
    DropOverlay(QWidget& window, const QMimeData& dragged);

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    QString text_;
};

} // namespace lumorph::studio

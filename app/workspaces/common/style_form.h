#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QTimer>
#include <QWidget>

#include "app/studio/widgets/value_field.h"
#include "app/workspaces/common/export_dialogs.h"

namespace lumorph::studio {

/// The part of a dialog that says how a picture looks: a preview, a size (one of the usual ones or two numbers), the
/// theme and the grid.
class StyleForm : public QWidget {
    Q_OBJECT
public:
    /// A size that is offered by name.
    struct Size {
        QString text;
        QSize pixels;
    };
    StyleForm(const QString& id, const PictureStyle& start, const std::vector<Size>& sizes, PreviewPainter preview,
              QWidget* parent = nullptr);

    [[nodiscard]] PictureStyle style() const;

protected:
    void showEvent(QShowEvent* event) override;

private:
    void showSize();
    void drawPreview();

    PreviewPainter preview_;
    QLabel* picture_;
    QComboBox* sizes_;
    ValueField* width_;
    ValueField* height_;
    QComboBox* theme_;
    QCheckBox* grid_;
    QCheckBox* label_;
    QTimer delay_;
    int asked_ = 0; ///< previews asked for; only the answer to the last one counts
};

} // namespace lumorph::studio

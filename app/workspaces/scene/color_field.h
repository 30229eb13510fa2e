#pragma once

#include <QColor>
#include <QPushButton>

namespace lumorph::studio {

/// A colour as a patch with its name; a click opens a dialog in which it is seen at once.
class ColorField : public QPushButton {
    Q_OBJECT
public:
    explicit ColorField(QWidget* parent = nullptr);

    [[nodiscard]] const QColor& color() const noexcept { return color_; }
    void setColor(const QColor& color);

signals:
    void previewed(const QColor& color);
    void committed(const QColor& color);
    void reverted();

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    void choose();

    QColor color_;
};

} // namespace lumorph::studio

#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <QString>
#include <QWidget>

#include "app/workspaces/rig/page_view.h"
#include "app/workspaces/rig/sheet_painter.h"
#include "core/render/viewport/theme.h"

namespace lumorph::studio {

enum class SheetTool { select, line, rectangle, ellipse, polygon };

/// A page, seen from above, on which a sheet device is drawn. It shows a drawing and says what the mouse and the keys
/// would make of it; whoever owns the drawing gives it back by `show`.
///
/// With the tool `select` a left drag moves what lies under the pointer, or the page; a double click on an edge adds a
/// corner, Delete takes the chosen line or corner away. With `line`, `rectangle` and `ellipse` press, drag and release
/// draw one; with `polygon` each click is a corner. Shift: steps of 15 degrees, square, circle. Ctrl: nothing snaps.
/// The wheel zooms at the pointer, a middle or right drag moves the page, Home shows all of it. Keys V, B, R, E, P
/// choose the tool; Esc leaves what was begun, then what is chosen, then the tool.
class SheetCanvas : public QWidget {
    Q_OBJECT
public:
    explicit SheetCanvas(QWidget* parent = nullptr);

    /// Another drawing. What is being dragged right now goes on from it only when it is what was previewed.
    void show(const SheetDevice& device);
    [[nodiscard]] const SheetDevice& device() const noexcept { return device_; } ///< as it is seen
    void setPlan(std::shared_ptr<const SheetPlan> plan);
    void setTool(SheetTool tool);
    [[nodiscard]] SheetTool tool() const noexcept { return tool_; }
    void choose(const SheetPart& part);
    [[nodiscard]] const SheetPart& chosen() const noexcept { return chosen_; }
    [[nodiscard]] std::optional<std::size_t> chosenLine() const;
    void setSnapping(bool on);
    [[nodiscard]] const PageView& view() const noexcept { return view_; }
    void showAll();
    /// What to do next, in a sentence.
    [[nodiscard]] QString hint() const;

signals:
    void previewed(const lumorph::SheetDevice& device);                   ///< during a drag
    void edited(const lumorph::SheetDevice& device, const QString& step); ///< done; `step` names it for undo
    void reverted();                                                      ///< a drag was left
    void chosenChanged();
    void toolChanged();
    void hintChanged();

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    struct Drag { ///< of a part of the drawing
        SheetPart part;
        glm::dvec2 held{0.0};   ///< where it was taken
        glm::dvec2 anchor{0.0}; ///< the point of it that is snapped
        SheetDevice before;
        bool moved = false;
    };
    struct Begun { ///< a shape between two points
        glm::dvec2 from{0.0};
        glm::dvec2 to{0.0};
    };

    [[nodiscard]] SnappedPoint snap(const QPointF& pixel, Qt::KeyboardModifiers modifiers, const SheetPart& without,
                                    std::optional<glm::dvec2> from = {}) const;
    [[nodiscard]] SnapRules rules(const SheetPart& without) const;
    [[nodiscard]] double reach() const { return kReach / view_.scale; }
    void beginSelect(QMouseEvent* event);
    void pressPolygon(const SnappedPoint& point);
    void closePolygon();
    void dragTo(QMouseEvent* event);
    void hover(QMouseEvent* event);
    void endDrag();
    void endShape();
    bool leave(); ///< what was begun, chosen or picked up; false where there is nothing to leave
    void removeChosen();
    [[nodiscard]] bool chosenRefused() const;
    [[nodiscard]] std::vector<glm::dvec2> shapeBegun() const;
    [[nodiscard]] QString readout() const;
    [[nodiscard]] const QPixmap& page(); ///< painted anew where the view has changed
    void changed();

    static constexpr double kReach = 9.0; ///< pixels

    SheetDevice device_;
    std::shared_ptr<const SheetPlan> plan_;
    PageView view_;
    QPixmap page_;
    PageView pageView_; ///< of `page_`
    Theme pageTheme_ = Theme::dark;
    bool fitted_ = false; ///< the view was chosen by the user, or shows all already
    SheetTool tool_ = SheetTool::select;
    SheetPart chosen_, hovered_;
    bool snapping_ = true;
    std::optional<SnappedPoint> pointer_;
    std::optional<Drag> drag_;
    std::optional<Begun> begun_;
    std::vector<glm::dvec2> polygon_;
    std::optional<QPointF> panned_; ///< the last pixel of a drag of the page
};

} // namespace lumorph::studio

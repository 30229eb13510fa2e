#pragma once

#include <functional>
#include <optional>

#include <QImage>
#include <QPointF>
#include <QWidget>

#include "app/studio/rendering/show_feed.h"
#include "app/studio/viewport/pane_overlay.h"

namespace lumorph::studio {

/// What a view is and how it stands, in its upper left corner; the pointer goes through it.
class PaneCaption : public QWidget {
    Q_OBJECT
public:
    PaneCaption(const QString& title, QWidget* parent);
    /// `live`: the state is worth the accent, such as a view that is not the viewer's own.
    void setText(const QString& title, const QString& state, bool live = false);

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    QString title_;
    QString state_;
    bool live_ = false;
};

/// One picture of the show, as large as the pane, with its caption. It asks for pictures while it is in sight, and says
/// what the pointer does on it.
class ViewPane : public QWidget {
    Q_OBJECT
public:
    /// `feed` outlives it.
    ViewPane(ShowFeed& feed, const ShowView& view, const QString& title, QWidget* parent);
    ~ViewPane() override;

    void setView(const ShowView& view);
    [[nodiscard]] const ShowView& view() const noexcept { return view_; }
    [[nodiscard]] PaneCaption& caption() noexcept { return *caption_; }
    /// The overlay outlives the pane, or is taken away before; null: none.
    void setOverlay(PaneOverlay* overlay) { overlay_ = overlay; }
    /// A sentence instead of a picture, while there is none.
    void setWaiting(const QString& text);
    /// A picture within another.
    void setFramed(bool on) { framed_ = on; }
    /// A few large words near the lower edge of the picture, for visitors; empty: none.
    void setLabel(const QString& text);
    [[nodiscard]] const QString& label() const noexcept { return label_; }
    /// How much of the light is there, 0 to 1: without it one sees the bare device, from the same place.
    void setLight(double share);
    [[nodiscard]] double light() const noexcept { return light_; }
    [[nodiscard]] QImage picture() const { return feed_.picture(id_); }
    [[nodiscard]] QSize pixels() const; ///< of the screen
    /// A stage that is not seen asks for nothing. Seen again, its last picture stays until there is a new one.
    void setActive(bool active);

signals:
    void dragBegan(Qt::MouseButton button, Qt::KeyboardModifiers modifiers);
    void dragged(const QPointF& by);
    void dragEnded(bool taken); ///< not taken: Esc, or the view has gone
    void wheeled(double notches);
    void clicked(const QPointF& at);
    void enlarged(); ///< a double click
    void viewKey(int key);

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

private:
    enum class Drag { none, undecided, view, overlay };
    void ask();
    void endDrag(bool taken);
    void paintLabel(QPainter& painter) const;
    void take();
    [[nodiscard]] QRect pictureBox(const QSize& picture) const;

    ShowFeed& feed_;
    const int id_, bareId_;
    ShowView view_;
    PaneCaption* caption_;
    PaneOverlay* overlay_ = nullptr;
    QString waiting_, label_;
    double light_ = 1.0;
    QSize asked_;
    QImage before_; ///< while there is none of the feed
    bool active_ = false;
    bool framed_ = false;
    bool ringed_ = false; ///< the focus came by key
    Drag drag_ = Drag::none;
    Qt::MouseButton button_ = Qt::NoButton;
    Qt::KeyboardModifiers modifiers_;
    QPointF pressedAt_;
    QPointF last_;
};

} // namespace lumorph::studio

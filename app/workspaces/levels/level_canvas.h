#pragma once

#include <optional>

#include <QWidget>

#include "app/workspaces/levels/level_draft.h"
#include "app/workspaces/levels/level_painter.h"

namespace lumorph::studio {

/// A level seen from above, on which pieces are put by mouse and keys. A left drag puts the chosen piece, a right drag
/// floor. The arrow keys move the frame, Space and Enter put the piece there (Shift and arrow: at each step), Delete
/// floor; the signs of the level's text choose the piece, digits the height, [ and ] lower and raise it.
class LevelCanvas : public QWidget {
    Q_OBJECT
public:
    /// The draft outlives it.
    explicit LevelCanvas(LevelDraft& draft, QWidget* parent = nullptr);

    [[nodiscard]] const LevelPiece& piece() const noexcept { return piece_; }
    void setPiece(const LevelPiece& piece);
    [[nodiscard]] int pieceHeight() const noexcept { return height_; }
    void setPieceHeight(int steps);
    [[nodiscard]] LevelView view() const;
    [[nodiscard]] glm::ivec2 cursor() const noexcept { return cursor_; }
    /// The cell under the frame, in words.
    [[nodiscard]] QString cursorText() const;
    /// The draft is another one now.
    void refresh();

signals:
    void edited();
    void pieceChanged();
    void heightChanged();
    void cursorChanged();

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void leaveEvent(QEvent* event) override;
    void focusInEvent(QFocusEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

private:
    void begin(const LevelPiece& piece);
    void drawTo(glm::ivec2 cell);
    void moveCursor(glm::ivec2 cell);
    bool step(int key, Qt::KeyboardModifiers modifiers);
    bool choose(const QString& text);

    LevelDraft& draft_;
    LevelPiece piece_;
    int height_ = 0;
    glm::ivec2 cursor_{1};
    std::optional<LevelPiece> drawn_; ///< during a drag
    glm::ivec2 last_{0};              ///< the newest cell of it
    bool over_ = false;               ///< the pointer is over it
};

} // namespace lumorph::studio

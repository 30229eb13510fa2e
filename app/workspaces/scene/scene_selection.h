#pragma once

#include <QObject>

namespace lumorph::studio {

/// What the Scene workspace points at: an item, or one of what is always there.
struct SceneChoice {
    enum class Kind { nothing, item, device, table, projector, viewer, room };
    Kind kind = Kind::nothing;
    int index = 0; ///< an item's id, or which projector
    bool operator==(const SceneChoice&) const = default;
};

/// Not part of the document, no undo.
class SceneSelection : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;
    [[nodiscard]] const SceneChoice& choice() const noexcept { return choice_; }
    /// The chosen item's id; 0: something else is chosen.
    [[nodiscard]] int item() const noexcept { return choice_.kind == SceneChoice::Kind::item ? choice_.index : 0; }
    void choose(const SceneChoice& choice) {
        if (choice == choice_) return;
        choice_ = choice;
        emit changed();
    }
    void chooseItem(int id) { choose(id == 0 ? SceneChoice{} : SceneChoice{SceneChoice::Kind::item, id}); }

signals:
    void changed();

private:
    SceneChoice choice_;
};

} // namespace lumorph::studio

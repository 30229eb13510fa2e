#pragma once

#include <vector>

#include <QToolButton>

#include "app/studio/shell/studio.h"
#include "app/studio/widgets/floating_card.h"

namespace lumorph::studio {

/// The keys that all applications share, as buttons for fingers and mice, over the view in which visitors play: all
/// applications, restart, next, with and without, help, language. Those that do nothing now are not there.
class VisitorBar : public FloatingCard {
    Q_OBJECT
public:
    /// `studio` outlives it.
    VisitorBar(Studio& studio, QWidget* parent);

    /// By the demonstration that is open and the program that shows; `rests`: there is nothing to choose either.
    void follow(bool rests);

signals:
    void cardsWanted();
    void helpWanted();

private:
    QToolButton* add(const char* name, const char* iconName, const Words& words, std::function<void()> run);
    void say();

    struct Button {
        QToolButton* button;
        Words words;
    };
    Studio& studio_;
    std::vector<Button> buttons_;
    QToolButton *cards_, *restart_, *next_, *off_, *help_, *language_;
};

} // namespace lumorph::studio

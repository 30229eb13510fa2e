#pragma once

#include <QBoxLayout>
#include <QElapsedTimer>
#include <QFrame>
#include <QLabel>
#include <QPushButton>

#include "app/studio/base/step_tone.h"
#include "app/studio/widgets/icon_label.h"

namespace lumorph::studio {

/// How things are, in a sentence, why, and the one sensible next step as an accent button.
struct StepCardText {
    using Tone = StepTone;
    Tone tone = Tone::quiet;
    QString title, text;
    QString button;             ///< empty: there is nothing to press
    bool isButtonQuiet = false; ///< such as Cancel, which is no next step
    bool operator==(const StepCardText&) const = default;
};

/// The card over the view of a workspace that leads through steps. Its parts are called `name`.title, `name`.text and
/// `name`.next.
class StepCard : public QFrame {
    Q_OBJECT
public:
    StepCard(const QString& name, const QString& icon, QWidget* parent);
    void show(const StepCardText& text);
    void setButtonHint(const QString& hint) { next_->setToolTip(hint); }

signals:
    void nextWanted();

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    QString quietIcon_;
    StepCardText shown_;
    QElapsedTimer sinceClick_;
    IconLabel* icon_;
    QLabel* title_;
    QLabel* text_;
    QPushButton* next_;
    QBoxLayout* row_ = nullptr; ///< icon, texts, button; one under the other where there is no room
};

} // namespace lumorph::studio

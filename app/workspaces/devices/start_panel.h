#pragma once

#include <QLabel>
#include <QListWidget>
#include <QTimer>
#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/studio/viewport/viewport_widget.h"
#include "app/studio/widgets/hold_button.h"
#include "app/workspaces/common/field_scene.h"
#include "app/workspaces/devices/start_words.h"

namespace lumorph::studio {

/// The question before servos move: the device where its servos are, over it as a ghost the pose to come, what each
/// servo will do, and a button that must be held for a second. It follows device and show while it is seen.
class StartPanel : public QWidget {
    Q_OBJECT
public:
    StartPanel(Studio& studio, DeviceService::StartBy by, QWidget* parent);
    [[nodiscard]] const StartQuestion& question() const noexcept { return question_; }
    void focusButton();

signals:
    void started();
    void questionChanged();

protected:
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;

private:
    void refresh();
    void draw(const std::vector<StartMove>& moves);
    void start();

    Studio& studio_;
    DeviceService::StartBy by_;
    StartQuestion question_;
    std::vector<StartMove> drawn_;
    FieldSceneBuilder builder_;
    ViewportWidget* view_;
    QLabel* title_;
    QLabel* text_;
    QListWidget* servos_;
    HoldButton* hold_;
    QTimer refresh_;
};

/// The same as a dialog that does not block, over the whole program's window; one at a time, a second asking raises it.
void openStartDialog(Studio& studio, DeviceService::StartBy by);

} // namespace lumorph::studio

#pragma once

#include <filesystem>

#include <QAbstractButton>
#include <QFileDialog>
#include <QLineEdit>
#include <QPointer>

#include "tests/ui/studio_window.h"

namespace lumorph::test {

/// Types a name into a file dialog and presses the button that is called so. The dialog looks folders up while one
/// types, so it is pressed when it has caught up.
inline void answerFileDialog(StudioWindow& window, const QString& dialog, const std::filesystem::path& file,
                             const QString& accept = "Save") {
    using namespace std::chrono_literals;
    QPointer<QFileDialog> found = window.find<QFileDialog>(dialog);
    ASSERT_TRUE(found);
    found->setDirectory(QString::fromStdString(file.parent_path().string()));
    auto* name = found->findChild<QLineEdit*>("fileNameEdit");
    ASSERT_NE(name, nullptr);
    pass(300ms);
    name->setFocus();
    name->selectAll();
    QTest::keyClicks(name, QString::fromStdString(file.filename().string()));
    window.screenshot("file-dialog");
    EXPECT_TRUE(eventually(
        [&] {
            if (!found || !found->isVisible()) return true;
            for (auto* button : found->findChildren<QAbstractButton*>())
                if (button->isVisible() && button->isEnabled() && button->text().contains(accept))
                    QTest::mouseClick(button, Qt::LeftButton);
            return !found || !found->isVisible();
        },
        10s));
}

} // namespace lumorph::test

#pragma once

#include <filesystem>
#include <vector>

#include <QListWidget>
#include <QWidget>

#include "app/studio/base/notices.h"
#include "app/studio/base/settings.h"

namespace lumorph::studio {

/// The shapes that count: those that come with the program, and what is added from files and folders, each with a tick.
class SuggestTargets : public QWidget {
    Q_OBJECT
public:
    /// What cannot be added is told at `place`.
    SuggestTargets(Settings& settings, Notices& notices, QString place, QWidget* parent = nullptr);

    [[nodiscard]] std::vector<std::filesystem::path> ticked() const;
    /// Adds what is not there yet, ticked.
    void add(const std::vector<std::filesystem::path>& files);

signals:
    void changed();

private:
    QListWidgetItem* addItem(const QString& title, const std::filesystem::path& file);
    void tickAll(bool on);
    void askFiles();
    void addFolder(const QString& folder);

    Settings& settings_;
    Notices& notices_;
    QString place_;
    QListWidget* list_;
};

} // namespace lumorph::studio

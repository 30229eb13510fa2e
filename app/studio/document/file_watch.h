#pragma once

#include <filesystem>
#include <map>

#include <QFileSystemWatcher>
#include <QObject>
#include <QString>
#include <QTimer>

#include "app/studio/document/assets.h"

namespace lumorph::studio {

/// Watches the files that are open. Editors replace files in several steps, so it looks once they have come to rest.
class FileWatch : public QObject {
    Q_OBJECT
public:
    struct Watched {
        std::filesystem::path path;
        FileStamp stamp; ///< as it was read
    };
    explicit FileWatch(QObject* parent = nullptr);

    /// Watches these instead of the ones before, by place.
    void watch(const std::map<QString, Watched>& files);

signals:
    /// Once for each new state of the file.
    void changed(const QString& place, const QString& path);
    void vanished(const QString& place, const QString& path);
    /// It is as it was read, after it was not.
    void restored(const QString& place, const QString& path);

private:
    struct Entry {
        Watched file;
        FileStamp seen; ///< the last look
        FileStamp told; ///< what was told of
    };
    void look();
    void follow();

    std::map<QString, Entry> files_;
    QFileSystemWatcher watcher_;
    QTimer rest_;
};

} // namespace lumorph::studio

#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <unistd.h>

#include <QComboBox>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QProcess>
#include <gtest/gtest.h>

#include "core/scene/installation_store.h"
#include "tests/core/temporary_folder.h"
#include "tests/ui/studio_window.h"

namespace lumorph::test {

/// `lumorph-table` in a process of its own, and of another user where that may be: its lines are the hands, its truth
/// is for who judges.
class TableProgram {
public:
    void start(const QStringList& arguments = {"--seed", "5", "--camera-size", "640x512"}) {
        const QString truthFile = QString::fromStdString(folder / "truth.json");
        program.setProcessChannelMode(QProcess::ForwardedErrorChannel);
        const auto begin = [&] {
            program.start(LUMORPH_BIN_DIR "/lumorph-table", QStringList{"--truth", truthFile} + arguments);
            ready = program.waitForStarted() ? readLine() : QJsonObject();
        };
        constexpr unsigned kNobody = 65534;
        isOtherUser = geteuid() == 0 && chown(folder.path().c_str(), kNobody, kNobody) == 0;
        if (isOtherUser)
            program.setChildProcessModifier([] {
                if (setgid(kNobody) != 0 || setuid(kNobody) != 0) _exit(1);
            });
        begin();
        if (isOtherUser && ready.isEmpty()) { // the program may lie in a home that no other user can enter
            program.waitForFinished();
            program.setChildProcessModifier({});
            isOtherUser = false;
            begin();
        }
        ASSERT_TRUE(ready.contains("cameras")) << "it did not start";
        std::ifstream file(folder / "truth.json");
        std::stringstream text;
        text << file.rdbuf();
        const auto json = QJsonDocument::fromJson(QByteArray::fromStdString(text.str())).object();
        truth = parseInstallation(QJsonDocument(json["room"].toObject()).toJson().toStdString(), "truth");
    }
    ~TableProgram() {
        if (program.state() != QProcess::Running) return;
        program.write("quit\n");
        EXPECT_TRUE(program.waitForFinished(10'000));
        EXPECT_EQ(program.exitCode(), 0);
    }
    [[nodiscard]] QJsonObject readLine() {
        if (!eventually([&] { return program.canReadLine() || program.state() == QProcess::NotRunning; })) return {};
        return QJsonDocument::fromJson(program.readLine()).object();
    }
    QJsonObject tell(const QString& line) {
        program.write((line + "\n").toUtf8());
        return readLine();
    }
    void does(const QString& line) {
        const QJsonObject said = tell(line);
        EXPECT_TRUE(said["ok"].toBool()) << line.toStdString() << ": " << said["error"].toString().toStdString();
    }
    /// Files of the table's that this process, in which the studio is, has open or in its memory.
    [[nodiscard]] std::string filesInCommon() const {
        std::string common;
        const std::string own = folder.path().string();
        for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
            std::error_code gone;
            const std::string file = std::filesystem::read_symlink(entry.path(), gone).string();
            if (file.starts_with(own)) common += file + "\n";
        }
        std::ifstream maps("/proc/self/maps");
        for (std::string line; std::getline(maps, line);)
            if (line.find(own) != std::string::npos) common += line + "\n";
        return common;
    }
    [[nodiscard]] std::string address(const char* kind) const {
        return ready["cameras"].toArray().first().toObject()[kind].toString().toStdString();
    }

    TemporaryFolder folder;
    QProcess program;
    bool isOtherUser = false;
    QJsonObject ready;
    Installation truth;
};

/// By the mouse, in the set-up of projector and camera: the screen that the table watches, and its camera.
inline void chooseScreenAndCamera(StudioWindow& window) {
    const auto choose = [&](const char* list, int index) {
        auto* box = window.find<QComboBox>(list);
        ASSERT_NE(box, nullptr);
        box->setCurrentIndex(index);
        emit box->activated(index);
    };
    window.click("calibrate.way.camera");
    choose("calibrate.screen", 1); // the only one: the studio is on it, and asks
    ASSERT_FALSE(window.studio().notices.at("output").empty());
    window.studio().notices.at("output").front().actions.front().run();
    const auto shown = [&] { return window.studio().outputs.window(0); };
    ASSERT_TRUE(
        eventually([&] { return shown() && shown()->calibrationProblem().isEmpty(); }, std::chrono::seconds(20)))
        << "the projector has its screen's pixels";
    window.click("calibrate.camera.search");
    ASSERT_TRUE(
        eventually([&] { return window.find<QComboBox>("calibrate.camera")->count() > 1; }, std::chrono::seconds(20)));
    choose("calibrate.camera", 1);
}

} // namespace lumorph::test

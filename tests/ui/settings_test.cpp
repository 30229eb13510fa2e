#include "app/studio/base/settings.h"

#include <QDir>
#include <QSignalSpy>
#include <QTemporaryDir>
#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

class SettingsTest : public ::testing::Test {
protected:
    void SetUp() override { QSettings(QSettings::IniFormat, QSettings::UserScope, "lumorph", "studio").clear(); }

    QString makeFile(const QString& name) {
        const QString path = folder.filePath(name);
        QFile file(path);
        EXPECT_TRUE(file.open(QIODevice::WriteOnly));
        return path;
    }

    QTemporaryDir folder;
};

TEST_F(SettingsTest, AreKeptFromOneStartToTheNext) {
    {
        studio::Settings settings;
        EXPECT_EQ(settings.theme(), Theme::dark);
        EXPECT_FALSE(settings.tourSeen());
        settings.setTheme(Theme::light);
        settings.setLoopRate(30.0);
        settings.setStillQuality(false);
        EXPECT_TRUE(settings.placesNewTargets());
        settings.setPlacesNewTargets(false);
        settings.setTourSeen(true);
        EXPECT_EQ(settings.nextMinutes(true), 2.0) << "in the kiosk";
        EXPECT_EQ(settings.nextMinutes(false), 0.0);
        settings.setNextMinutes(false, 5.0);
        EXPECT_EQ(settings.say({"Ice", "Eis"}), "Ice") << "the test's system is no German one";
        settings.setLanguage(Language::german);
        settings.setLayout("field", QByteArray("\0\1\2", 3));
    }
    const studio::Settings settings;
    EXPECT_EQ(settings.theme(), Theme::light);
    EXPECT_DOUBLE_EQ(settings.loopRate(), 30.0);
    EXPECT_FALSE(settings.stillQuality());
    EXPECT_FALSE(settings.placesNewTargets());
    EXPECT_TRUE(settings.tourSeen());
    EXPECT_EQ(settings.nextMinutes(true), 2.0);
    EXPECT_EQ(settings.nextMinutes(false), 5.0);
    EXPECT_EQ(settings.say({"Ice", "Eis"}), "Eis");
    EXPECT_EQ(settings.layout("field"), QByteArray("\0\1\2", 3));
    EXPECT_TRUE(settings.layout("rig").isEmpty());
}

TEST_F(SettingsTest, ReadOnlyTheyCountHereAndAreWrittenOnceTheyMayBe) {
    studio::Settings settings, other;
    other.setLoopRate(30.0);
    other.setSound(false);
    other.reload();
    settings.reload();
    settings.setReadOnly(true);
    settings.setTheme(Theme::light);
    settings.setLoopRate(40.0);
    settings.remove("sound/on");
    EXPECT_EQ(settings.theme(), Theme::light);
    EXPECT_TRUE(settings.sound());
    other.reload();
    EXPECT_EQ(other.theme(), Theme::dark);
    EXPECT_EQ(other.loopRate(), 30.0);
    EXPECT_FALSE(other.sound());
    settings.setReadOnly(false);
    settings.reload();
    other.reload();
    EXPECT_EQ(other.theme(), Theme::light);
    EXPECT_EQ(other.loopRate(), 40.0);
    EXPECT_TRUE(other.sound());
}

TEST_F(SettingsTest, TellAChangeOnce) {
    studio::Settings settings;
    QSignalSpy told(&settings, &studio::Settings::themeChanged);
    settings.setTheme(Theme::light);
    settings.setTheme(Theme::light);
    EXPECT_EQ(told.count(), 1);
}

TEST_F(SettingsTest, TheLoopRateStaysInItsRangeWhateverTheFileSays) {
    studio::Settings settings;
    settings.setLoopRate(5000.0);
    EXPECT_DOUBLE_EQ(settings.loopRate(), 120.0);
    settings.setValue("loop/rate", "often");
    EXPECT_DOUBLE_EQ(settings.loopRate(), 60.0);
}

TEST_F(SettingsTest, RecentFilesAreTheNewestTenThatAreStillThere) {
    studio::Settings settings;
    QStringList paths;
    for (int i = 0; i < 12; ++i) {
        paths << makeFile(QString("f%1.lumorph").arg(i));
        settings.addRecentFile(paths.last());
    }
    ASSERT_EQ(settings.recentFiles().size(), 10);
    EXPECT_EQ(settings.recentFiles().first(), paths[11]);
    settings.addRecentFile(paths[5]);
    EXPECT_EQ(settings.recentFiles().first(), paths[5]);
    EXPECT_EQ(settings.recentFiles().count(paths[5]), 1);
    QFile::remove(paths[11]);
    EXPECT_FALSE(settings.recentFiles().contains(paths[11]));
    settings.clearRecentFiles();
    EXPECT_TRUE(settings.recentFiles().isEmpty());
}

} // namespace
} // namespace lumorph::studio

#include "app/studio/look/icons.h"

#include <QDir>
#include <QSvgRenderer>
#include <gtest/gtest.h>

#include "app/studio/look/palette.h"
#include "core/base/error.h"
#include "core/base/resources.h"

namespace lumorph::studio {
namespace {

/// Those of the set; the program's own icon and that of its files have colours of their own.
QStringList iconNames() {
    const QDir folder(QString::fromStdString((resourcesFolder() / "icons").string()));
    QStringList names;
    for (const QString& file : folder.entryList({"*.svg"}))
        if (!file.contains("lumorph")) names << file.chopped(4);
    return names;
}

/// How many pixels have any ink, and whether all ink has one colour.
struct Ink {
    int pixels = 0;
    bool plain = true;
};

Ink inkOf(const QImage& picture, const QColor& color) {
    Ink ink;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x) {
            const QColor pixel = picture.pixelColor(x, y);
            if (pixel.alpha() < 128) continue;
            ++ink.pixels;
            const int off = std::abs(pixel.red() - color.red()) + std::abs(pixel.green() - color.green()) +
                            std::abs(pixel.blue() - color.blue());
            if (off > 12) ink.plain = false;
        }
    return ink;
}

class Icons : public ::testing::Test {
protected:
    void TearDown() override { applyTheme(*qApp, Theme::dark); }
};

TEST_F(Icons, EveryDrawingParsesAndTakesTheThemesColour) {
    ASSERT_FALSE(iconNames().isEmpty()) << "resources/icons";
    for (const QString& name : iconNames()) {
        const QByteArray source = iconSource(name);
        EXPECT_TRUE(QSvgRenderer(source).isValid()) << name.toStdString();
        EXPECT_TRUE(source.contains("currentColor")) << name.toStdString();
        const Ink ink =
            inkOf(icon(name, IconRole::accent).pixmap(QSize(32, 32), 1.0).toImage(), currentPalette().accentText);
        EXPECT_GT(ink.pixels, 20) << name.toStdString();
        EXPECT_TRUE(ink.plain) << name.toStdString();
    }
}

TEST_F(Icons, AreDrawnAnewForEveryDesktopScale) {
    for (const double scale : {1.0, 1.5, 2.0}) {
        const QPixmap drawn = icon("stop").pixmap(QSize(16, 16), scale);
        EXPECT_EQ(drawn.width(), static_cast<int>(16 * scale));
        EXPECT_DOUBLE_EQ(drawn.devicePixelRatio(), scale);
    }
}

TEST_F(Icons, FollowTheTheme) {
    const QIcon kept = icon("stop", IconRole::accent);
    applyTheme(*qApp, Theme::light);
    EXPECT_TRUE(inkOf(kept.pixmap(QSize(32, 32), 1.0).toImage(), paletteOf(Theme::light).accentText).plain);
    applyTheme(*qApp, Theme::dark);
    EXPECT_TRUE(inkOf(kept.pixmap(QSize(32, 32), 1.0).toImage(), paletteOf(Theme::dark).accentText).plain);
}

TEST_F(Icons, AMissingOneIsAnErrorToReadAndAnEmptySquareToDraw) {
    EXPECT_THROW(static_cast<void>(iconSource("no-such-icon")), DataError);
    EXPECT_GT(inkOf(icon("no-such-icon", IconRole::accent).pixmap(QSize(32, 32), 1.0).toImage(), Qt::black).pixels, 10);
}

} // namespace
} // namespace lumorph::studio

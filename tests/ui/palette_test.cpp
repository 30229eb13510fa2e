#include "app/studio/look/palette.h"

#include <set>

#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

constexpr double kText = 4.5, kControl = 3.0;

// Pairs worked out by hand from the definition of relative luminance (WCAG 2.1).
TEST(Palette, ContrastIsThatOfTheStandard) {
    EXPECT_NEAR(contrast(Qt::black, Qt::white), 21.0, 1e-6);
    EXPECT_NEAR(contrast(Qt::white, Qt::white), 1.0, 1e-6);
    EXPECT_NEAR(contrast(QColor(0x77, 0x77, 0x77), Qt::white), 4.478, 2e-3);
    EXPECT_NEAR(contrast(QColor(0xFF, 0, 0), Qt::white), 3.998, 2e-3);
    EXPECT_DOUBLE_EQ(contrast(Qt::red, Qt::blue), contrast(Qt::blue, Qt::red));
}

TEST(Palette, EveryTextCanBeReadInBothThemes) {
    for (const Theme theme : {Theme::dark, Theme::light})
        for (const TextPair& pair : textPairs(paletteOf(theme)))
            EXPECT_GE(contrast(pair.text, pair.background), kText)
                << (theme == Theme::dark ? "dark: " : "light: ") << pair.name.toStdString();
}

TEST(Palette, TheListOfPairsNamesEveryTextColourAndGround) {
    for (const Theme theme : {Theme::dark, Theme::light}) {
        const Palette& colors = paletteOf(theme);
        std::set<QRgb> texts, grounds;
        for (const TextPair& pair : textPairs(colors)) {
            texts.insert(pair.text.rgb());
            grounds.insert(pair.background.rgb());
        }
        for (const QColor& text : {colors.text, colors.textMuted, colors.onAccent, colors.accentText, colors.onDanger,
                                   colors.warning, colors.success})
            EXPECT_TRUE(texts.contains(text.rgb())) << text.name().toStdString();
        for (const QColor& ground :
             {colors.window, colors.panel, colors.raised, colors.hovered, colors.sunken, colors.accent, colors.danger})
            EXPECT_TRUE(grounds.contains(ground.rgb())) << ground.name().toStdString();
    }
}

TEST(Palette, BordersAndMarksOfControlsCanBeSeen) {
    for (const Theme theme : {Theme::dark, Theme::light}) {
        const Palette& colors = paletteOf(theme);
        for (const QColor& mark : {colors.border, colors.accent, colors.danger})
            EXPECT_GE(contrast(mark, colors.panel), kControl) << mark.name().toStdString();
    }
}

TEST(Palette, ADarkerGreenIsAHigherLevel) {
    for (const Theme theme : {Theme::dark, Theme::light})
        EXPECT_GT(paletteOf(theme).levelLow.lightnessF(), paletteOf(theme).levelHigh.lightnessF());
}

} // namespace
} // namespace lumorph::studio

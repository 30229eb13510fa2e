#include "app/studio/look/palette.h"

#include <algorithm>
#include <cmath>

#include "core/base/srgb.h"

namespace lumorph::studio {
namespace {

Palette darkPalette() {
    Palette colors;
    colors.window = QColor(0x14, 0x17, 0x1C);
    colors.panel = QColor(0x1B, 0x1F, 0x26);
    colors.raised = QColor(0x27, 0x2D, 0x36);
    colors.hovered = QColor(0x32, 0x3A, 0x45);
    colors.sunken = QColor(0x10, 0x13, 0x17);
    colors.line = QColor(0x2C, 0x32, 0x3C);
    colors.border = QColor(0x68, 0x72, 0x80);
    colors.text = QColor(0xE6, 0xEA, 0xF0);
    colors.textMuted = QColor(0xA3, 0xAD, 0xBA);
    colors.accent = QColor(0x29, 0xB8, 0xCC);
    colors.onAccent = QColor(0x03, 0x20, 0x26);
    colors.accentText = QColor(0x4F, 0xCD, 0xDE);
    colors.danger = QColor(0xCB, 0x3B, 0x36);
    colors.onDanger = QColor(0xFF, 0xFF, 0xFF);
    colors.warning = QColor(0xF0, 0xB2, 0x4A);
    colors.success = QColor(0x5C, 0xC9, 0x8A);
    colors.unmatched = QColor(0xFF, 0x8A, 0x5B);
    colors.overfilled = QColor(0x7C, 0x8C, 0xFF);
    colors.levelLow = QColor(0xB9, 0xE8, 0xB0);
    colors.levelHigh = QColor(0x17, 0x6B, 0x37);
    return colors;
}

Palette lightPalette() {
    Palette colors;
    colors.window = QColor(0xE6, 0xE9, 0xEE);
    colors.panel = QColor(0xF6, 0xF7, 0xF9);
    colors.raised = QColor(0xFF, 0xFF, 0xFF);
    colors.hovered = QColor(0xE9, 0xEE, 0xF3);
    colors.sunken = QColor(0xFF, 0xFF, 0xFF);
    colors.line = QColor(0xD3, 0xD9, 0xE0);
    colors.border = QColor(0x83, 0x8C, 0x97);
    colors.text = QColor(0x1A, 0x1E, 0x24);
    colors.textMuted = QColor(0x55, 0x5F, 0x6C);
    colors.accent = QColor(0x0B, 0x7A, 0x8C);
    colors.onAccent = QColor(0xFF, 0xFF, 0xFF);
    colors.accentText = QColor(0x07, 0x62, 0x6F);
    colors.danger = QColor(0xC6, 0x2F, 0x2A);
    colors.onDanger = QColor(0xFF, 0xFF, 0xFF);
    colors.warning = QColor(0x83, 0x55, 0x00);
    colors.success = QColor(0x17, 0x6B, 0x3E);
    colors.unmatched = QColor(0xE0, 0x5A, 0x26);
    colors.overfilled = QColor(0x4C, 0x5C, 0xE6);
    colors.levelLow = QColor(0xA5, 0xDB, 0x9B);
    colors.levelHigh = QColor(0x12, 0x57, 0x2C);
    return colors;
}

double luminance(const QColor& color) {
    return 0.2126 * linearFromSrgb(color.redF()) + 0.7152 * linearFromSrgb(color.greenF()) +
           0.0722 * linearFromSrgb(color.blueF());
}

} // namespace

const Palette& paletteOf(Theme theme) {
    static const Palette dark = darkPalette();
    static const Palette light = lightPalette();
    return theme == Theme::dark ? dark : light;
}

QColor selectedColor(const Palette& palette) { return blend(palette.panel, palette.accent, 0.22); }

QColor disabledText(const Palette& palette) { return blend(palette.panel, palette.textMuted, 0.55); }

QColor blend(const QColor& from, const QColor& to, double share) {
    const auto mix = [share](int a, int b) { return static_cast<int>(std::lround(a + (b - a) * share)); };
    return {mix(from.red(), to.red()), mix(from.green(), to.green()), mix(from.blue(), to.blue())};
}

std::vector<TextPair> textPairs(const Palette& palette) {
    std::vector<TextPair> pairs;
    const std::vector<std::pair<QString, QColor>> grounds{
        {"window", palette.window},   {"panel", palette.panel},   {"raised", palette.raised},
        {"hovered", palette.hovered}, {"sunken", palette.sunken}, {"selected", selectedColor(palette)}};
    for (const auto& [name, ground] : grounds) {
        pairs.push_back({"text on " + name, palette.text, ground});
        pairs.push_back({"muted text on " + name, palette.textMuted, ground});
        pairs.push_back({"accent text on " + name, palette.accentText, ground});
    }
    for (const auto& [name, ground] : {grounds[0], grounds[1], grounds[2], grounds[4]}) {
        pairs.push_back({"warning on " + name, palette.warning, ground});
        pairs.push_back({"success on " + name, palette.success, ground});
    }
    pairs.push_back({"text on accent", palette.onAccent, palette.accent});
    pairs.push_back({"text on hovered accent", palette.onAccent, hoveredAccent(palette)});
    pairs.push_back({"text on danger", palette.onDanger, palette.danger});
    pairs.push_back({"text on hovered danger", palette.onDanger, hoveredDanger(palette)});
    return pairs;
}

QColor hoveredAccent(const Palette& palette) { return blend(palette.accent, palette.text, 0.12); }

QColor hoveredDanger(const Palette& palette) { return blend(palette.danger, palette.window, 0.12); }

double contrast(const QColor& a, const QColor& b) {
    const double first = luminance(a), second = luminance(b);
    return (std::max(first, second) + 0.05) / (std::min(first, second) + 0.05);
}

} // namespace lumorph::studio

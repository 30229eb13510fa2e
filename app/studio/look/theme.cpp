#include <filesystem>

#include <QFontDatabase>
#include <QIcon>
#include <QPalette>
#include <QVariant>

#include "app/studio/look/focus_ring.h"
#include "app/studio/look/palette.h"
#include "app/studio/look/studio_style.h"
#include "app/studio/look/style_sheet.h"
#include "core/base/resources.h"

namespace lumorph::studio {
namespace {

constexpr auto kThemeProperty = "lumorphTheme";

void loadTypeface() {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(resourcesFolder() / "fonts", error))
        if (const auto name = entry.path().filename().string(); name.starts_with("Inter-") && name.ends_with(".otf"))
            QFontDatabase::addApplicationFont(QString::fromStdString(entry.path().string()));
}

QFont typeface() {
    QFont font("Inter");
    font.setPixelSize(13);
    font.setHintingPreference(QFont::PreferNoHinting);
    return font;
}

/// Fusion draws from this what the style sheet leaves to it.
QPalette qtPalette(const Palette& colors) {
    QPalette qt;
    qt.setColor(QPalette::Window, colors.panel);
    qt.setColor(QPalette::WindowText, colors.text);
    qt.setColor(QPalette::Base, colors.sunken);
    qt.setColor(QPalette::AlternateBase, colors.panel);
    qt.setColor(QPalette::Text, colors.text);
    qt.setColor(QPalette::PlaceholderText, colors.textMuted);
    qt.setColor(QPalette::Button, colors.raised);
    qt.setColor(QPalette::ButtonText, colors.text);
    qt.setColor(QPalette::BrightText, colors.onDanger);
    qt.setColor(QPalette::Highlight, selectedColor(colors));
    qt.setColor(QPalette::HighlightedText, colors.text);
    qt.setColor(QPalette::Link, colors.accentText);
    qt.setColor(QPalette::LinkVisited, colors.accentText);
    qt.setColor(QPalette::ToolTipBase, colors.raised);
    qt.setColor(QPalette::ToolTipText, colors.text);
    qt.setColor(QPalette::Light, colors.hovered);
    qt.setColor(QPalette::Mid, colors.line);
    qt.setColor(QPalette::Dark, colors.line);
    qt.setColor(QPalette::Shadow, colors.window);
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText, QPalette::HighlightedText})
        qt.setColor(QPalette::Disabled, role, disabledText(colors));
    return qt;
}

} // namespace

void applyTheme(QApplication& application, Theme theme) {
    const bool first = !application.property(kThemeProperty).isValid();
    application.setProperty(kThemeProperty, static_cast<int>(theme));
    if (first) {
        loadTypeface();
        application.setFont(typeface());
        QApplication::setStyle(new StudioStyle);
        new FocusRing(&application);
        QApplication::setWindowIcon(QIcon(QString::fromStdString((resourcesFolder() / "icons/lumorph.svg").string())));
    }
    const Palette& colors = paletteOf(theme);
    QApplication::setPalette(qtPalette(colors));
    application.setStyleSheet(styleSheet(colors));
}

Theme currentTheme() {
    const QVariant theme = qApp == nullptr ? QVariant() : qApp->property(kThemeProperty);
    return theme.toInt() == static_cast<int>(Theme::light) ? Theme::light : Theme::dark;
}

const Palette& currentPalette() { return paletteOf(currentTheme()); }

} // namespace lumorph::studio

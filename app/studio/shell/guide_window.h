#pragma once

#include <filesystem>
#include <vector>

#include <QPushButton>
#include <QString>
#include <QWidget>

namespace lumorph::studio {

/// A page of the guide: a Markdown file of the resources folder `guide`.
struct GuidePage {
    std::filesystem::path file;
    QString title; ///< its first heading
};

/// All pages: "index" first, then in the order in which it links to them, then what it does not name. Empty where the
/// guide is missing.
[[nodiscard]] std::vector<GuidePage> guidePages();

/// Shows a page of the guide by its file's name without ending ("calibrate"; unknown or empty: the first) in a window
/// beside the studio's, "dialog.guide"; one that is open already turns to that page.
void openGuide(QWidget& window, const QString& page = {});

/// A line of text in a dock that opens a page of the guide.
[[nodiscard]] QPushButton* makeGuideLink(const QString& text, const QString& page);

} // namespace lumorph::studio

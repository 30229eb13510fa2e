#include "app/studio/shell/guide_window.h"

#include <algorithm>

#include <QDialog>
#include <QFile>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QImage>
#include <QLineEdit>
#include <QListWidget>
#include <QRegularExpression>
#include <QResizeEvent>
#include <QScrollBar>
#include <QTextBlock>
#include <QTextBrowser>
#include <QTextCursor>
#include <QTextList>
#include <QTextTable>
#include <QUrl>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"
#include "core/base/error.h"
#include "core/base/resources.h"

namespace lumorph::studio {

namespace {

constexpr const char* kFirstPage = "index";
constexpr int kListWidth = 280;
constexpr int kTextMargin = 24;

QString pageText(const std::filesystem::path& file) {
    QFile opened(QString::fromStdString(file.string()));
    return opened.open(QIODevice::ReadOnly) ? QString::fromUtf8(opened.readAll()) : QString();
}

QString pageTitle(const std::filesystem::path& file) {
    static const QRegularExpression heading("^# +(.+)$", QRegularExpression::MultilineOption);
    const auto match = heading.match(pageText(file));
    return match.hasMatch() ? match.captured(1).trimmed() : QString::fromStdString(file.stem().string());
}

/// Names of the pages that a page links to, in its order.
QStringList pageLinks(const std::filesystem::path& file) {
    static const QRegularExpression link(R"(\]\(([\w-]+)\.md\))");
    QStringList names;
    auto matches = link.globalMatch(pageText(file));
    while (matches.hasNext()) names.push_back(matches.next().captured(1));
    return names;
}

/// Shows Markdown with its pictures, none wider than the page.
class PageBrowser : public QTextBrowser {
public:
    using QTextBrowser::QTextBrowser;

    [[nodiscard]] QVariant loadResource(int type, const QUrl& name) override {
        if (name.fileName().endsWith(".md")) return htmlOf(name);
        const QVariant loaded = QTextBrowser::loadResource(type, name);
        if (type != QTextDocument::ImageResource) return loaded;
        QImage picture = loaded.metaType().id() == QMetaType::QByteArray ? QImage::fromData(loaded.toByteArray())
                                                                         : qvariant_cast<QImage>(loaded);
        const int most = std::max(100, viewport()->width() - 2 * kTextMargin - 8);
        return picture.width() > most ? picture.scaledToWidth(most, Qt::SmoothTransformation) : picture;
    }

protected:
    void resizeEvent(QResizeEvent* event) override {
        QTextBrowser::resizeEvent(event);
        if (event->oldSize().width() == event->size().width() || source().isEmpty()) return;
        const int place = verticalScrollBar()->value();
        reload(); // pictures follow the width
        verticalScrollBar()->setValue(place);
    }
    void doSetSource(const QUrl& name, QTextDocument::ResourceType /*type*/) override {
        QTextBrowser::doSetSource(name, QTextDocument::HtmlResource);
        space();
    }

private:
    /// Read in a document of its own: Qt 6.4 begins a page in the font in which the page before it was.
    static QString htmlOf(const QUrl& page) {
        QTextDocument document;
        document.setMarkdown(pageText(page.toLocalFile().toStdString()));
        return document.toHtml();
    }

    /// Markdown brings no space between lines and paragraphs, and tables of double lines.
    void space() {
        document()->setDocumentMargin(kTextMargin);
        for (QTextFrame* frame : document()->rootFrame()->childFrames())
            if (auto* table = qobject_cast<QTextTable*>(frame)) {
                QTextTableFormat format = table->format();
                format.setBorderCollapse(true);
                format.setBorderBrush(currentPalette().line);
                format.setCellPadding(6);
                format.setTopMargin(8);
                format.setBottomMargin(8);
                table->setFormat(format);
            }
        for (QTextBlock block = document()->begin(); block.isValid(); block = block.next()) {
            QTextBlockFormat format = block.blockFormat();
            const bool isHeading = format.headingLevel() > 0;
            const bool isPicture = block.text().trimmed() == QString(QChar::ObjectReplacementCharacter);
            if (!isPicture) format.setLineHeight(130, QTextBlockFormat::ProportionalHeight);
            if (!block.textList()) format.setTopMargin(isHeading ? 20 : 6);
            format.setBottomMargin(isHeading || !block.textList() ? 6 : 2);
            QTextCursor(block).setBlockFormat(format);
        }
    }
};

class GuideWindow : public QDialog {
public:
    explicit GuideWindow(QWidget& window);
    void turnTo(const QString& page);

private:
    void list(const QString& words); ///< the pages that hold all of them
    void markPage();                 ///< the one that is open, in the list

    std::vector<GuidePage> pages_ = guidePages();
    QLineEdit* search_ = new QLineEdit;
    QListWidget* list_ = new QListWidget;
    PageBrowser* text_ = new PageBrowser;
};

GuideWindow::GuideWindow(QWidget& window) : QDialog(&window) {
    setObjectName("dialog.guide");
    setWindowTitle("Guide");
    setAttribute(Qt::WA_DeleteOnClose);
    search_->setObjectName("guide.search");
    search_->setPlaceholderText("Find in the guide");
    search_->setClearButtonEnabled(true);
    search_->setAccessibleName("Find in the guide");
    list_->setObjectName("guide.pages");
    list_->setAccessibleName("Pages of the guide");
    list_->setWordWrap(true);
    list_->setTextElideMode(Qt::ElideNone);
    list_->setSpacing(3);
    list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    text_->setObjectName("guide.text");
    text_->setAccessibleName("Page");
    text_->setOpenExternalLinks(true);
    text_->setFrameShape(QFrame::NoFrame);
    auto* left = new QVBoxLayout;
    left->setSpacing(8);
    left->addWidget(search_);
    left->addWidget(list_, 1);
    auto* side = new QWidget;
    side->setLayout(left);
    side->setFixedWidth(kListWidth);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(8, 8, 8, 8);
    row->addWidget(side);
    row->addWidget(text_, 1);
    connect(search_, &QLineEdit::textChanged, this, &GuideWindow::list);
    connect(list_, &QListWidget::currentItemChanged, this, [this](QListWidgetItem* item) {
        if (item) turnTo(item->data(Qt::UserRole).toString());
    });
    connect(text_, &QTextBrowser::sourceChanged, this, &GuideWindow::markPage);
    list({});
    resize(QSize(980, 760).boundedTo(window.size() * 0.95));
    text_->setFocus();
}

void GuideWindow::turnTo(const QString& page) {
    const auto found = std::ranges::find_if(
        pages_, [&](const GuidePage& one) { return QString::fromStdString(one.file.stem().string()) == page; });
    if (pages_.empty()) {
        text_->setMarkdown("# The guide is missing\n\nIt is a part of the program: install Lumorph again.");
        return;
    }
    const GuidePage& shown = found == pages_.end() ? pages_.front() : *found;
    const QUrl url = QUrl::fromLocalFile(QString::fromStdString(shown.file.string()));
    if (text_->source() != url) text_->setSource(url);
    markPage();
}

void GuideWindow::list(const QString& words) {
    const QSignalBlocker quiet(list_);
    list_->clear();
    const QStringList wanted = words.split(' ', Qt::SkipEmptyParts);
    for (const GuidePage& page : pages_) {
        const QString text = wanted.empty() ? QString() : pageText(page.file);
        const auto holds = [&](const QString& word) { return text.contains(word, Qt::CaseInsensitive); };
        if (!std::ranges::all_of(wanted, holds)) continue;
        auto* item = new QListWidgetItem(page.title, list_);
        item->setData(Qt::UserRole, QString::fromStdString(page.file.stem().string()));
    }
    markPage();
}

void GuideWindow::markPage() {
    const QSignalBlocker quiet(list_);
    const QString open = QFileInfo(text_->source().toLocalFile()).completeBaseName();
    list_->setCurrentItem(nullptr);
    for (int k = 0; k < list_->count(); ++k)
        if (list_->item(k)->data(Qt::UserRole).toString() == open) list_->setCurrentRow(k);
}

} // namespace

std::vector<GuidePage> guidePages() {
    std::vector<GuidePage> pages;
    try {
        for (const auto& entry : std::filesystem::directory_iterator(resourcesFolder() / "guide"))
            if (entry.path().extension() == ".md") pages.push_back({entry.path(), pageTitle(entry.path())});
    } catch (const Error&) { // what is missing is told where a page would stand
    } catch (const std::filesystem::filesystem_error&) {
    }
    const auto first =
        std::ranges::find_if(pages, [](const GuidePage& page) { return page.file.stem() == kFirstPage; });
    const QStringList order = QStringList(kFirstPage) + (first == pages.end() ? QStringList() : pageLinks(first->file));
    const auto placeOf = [&](const GuidePage& page) {
        const auto at = order.indexOf(QString::fromStdString(page.file.stem().string()));
        return at < 0 ? order.size() : at;
    };
    std::ranges::sort(pages, {}, &GuidePage::title);
    std::ranges::stable_sort(pages, {}, placeOf);
    return pages;
}

void openGuide(QWidget& window, const QString& page) {
    auto* open = static_cast<GuideWindow*>(window.findChild<QDialog*>("dialog.guide"));
    if (open == nullptr) open = new GuideWindow(window);
    open->turnTo(page);
    open->show();
    open->raise();
    open->activateWindow();
}

QPushButton* makeGuideLink(const QString& text, const QString& page) {
    auto* link = new QPushButton(text);
    link->setObjectName("guide.link." + page);
    link->setProperty("look", "link");
    link->setCursor(Qt::PointingHandCursor);
    QObject::connect(link, &QPushButton::clicked, link, [link, page] { openGuide(*link->window(), page); });
    return link;
}

} // namespace lumorph::studio

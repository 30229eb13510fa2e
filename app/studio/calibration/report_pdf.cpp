#include "app/studio/calibration/report_pdf.h"

#include <span>

#include <QAbstractTextDocumentLayout>
#include <QBuffer>
#include <QPainter>
#include <QPdfWriter>
#include <QTextDocument>

#include "core/base/atomic_file.h"

namespace lumorph::studio {
namespace {

constexpr int kDotsPerInch = 96; // of the page, in whose pixels its pictures are
constexpr double kMarginMillimetres = 16.0;
constexpr double kFooter = 24.0; // pixels of the page

/// One page of the document, and its number.
void drawPage(QPainter& painter, const QTextDocument& document, QSizeF room, int page) {
    painter.save();
    painter.translate(0.0, -page * room.height());
    QAbstractTextDocumentLayout::PaintContext context;
    context.palette.setColor(QPalette::Text, Qt::black); // whatever the window looks like
    context.clip = QRectF(0.0, page * room.height(), room.width(), room.height());
    painter.setClipRect(context.clip);
    document.documentLayout()->draw(&painter, context);
    painter.restore();
    painter.setFont(document.defaultFont());
    painter.drawText(QRectF(0.0, room.height(), room.width(), kFooter), Qt::AlignRight | Qt::AlignBottom,
                     QString::number(page + 1));
}

} // namespace

void writeReportPdf(const std::string& page, const std::filesystem::path& file) {
    QByteArray bytes;
    QBuffer buffer(&bytes);
    buffer.open(QIODevice::WriteOnly);
    {
        QPdfWriter writer(&buffer);
        writer.setPageSize(QPageSize(QPageSize::A4));
        writer.setPageMargins(QMarginsF(kMarginMillimetres, kMarginMillimetres, kMarginMillimetres, kMarginMillimetres),
                              QPageLayout::Millimeter);
        writer.setTitle("Calibration by Lumorph");
        writer.setCreator("Lumorph");
        QTextDocument document;
        document.setDefaultFont(QFont("sans-serif", 9));
        const QSizeF paper = writer.pageLayout().paintRect(QPageLayout::Inch).size() * kDotsPerInch;
        const QSizeF room(paper.width(), paper.height() - kFooter);
        document.setHtml(QString::fromStdString(page));
        document.setPageSize(room);
        QPainter painter(&writer);
        const double scale = static_cast<double>(writer.resolution()) / kDotsPerInch;
        painter.scale(scale, scale);
        for (int number = 0; number < document.pageCount(); ++number) {
            if (number > 0) writer.newPage();
            drawPage(painter, document, room, number);
        }
    }
    writeFileAtomically(file, std::as_bytes(std::span(bytes.constData(), static_cast<std::size_t>(bytes.size()))));
}

} // namespace lumorph::studio

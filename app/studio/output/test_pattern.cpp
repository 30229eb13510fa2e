#include "app/studio/output/test_pattern.h"

#include <algorithm>

#include <QCoreApplication>
#include <QPainter>

namespace lumorph::studio {
namespace {

constexpr int kGridStep = 40;

void fillCheckerboard(QImage& image) {
    for (int y = 0; y < image.height(); ++y) {
        auto* row = reinterpret_cast<QRgb*>(image.scanLine(y));
        for (int x = 0; x < image.width(); ++x) row[x] = (x + y) % 2 == 0 ? qRgb(255, 255, 255) : qRgb(0, 0, 0);
    }
}

void fillRamp(QImage& image) {
    for (int y = 0; y < image.height(); ++y) {
        auto* row = reinterpret_cast<QRgb*>(image.scanLine(y));
        for (int x = 0; x < image.width(); ++x) {
            const int grey = 256 * x / image.width();
            row[x] = qRgb(grey, grey, grey);
        }
    }
}

void drawGrid(QImage& image) {
    image.fill(Qt::black);
    QPainter painter(&image);
    painter.setPen(QColor(150, 150, 150));
    const int right = image.width() - 1, bottom = image.height() - 1;
    for (int x = image.width() / 2 % kGridStep; x <= right; x += kGridStep) painter.drawLine(x, 0, x, bottom);
    for (int y = image.height() / 2 % kGridStep; y <= bottom; y += kGridStep) painter.drawLine(0, y, right, y);
    painter.setPen(QColor(90, 160, 230));
    painter.drawLine(0, 0, right, bottom);
    painter.drawLine(0, bottom, right, 0);
    painter.setPen(Qt::white);
    painter.drawRect(0, 0, right, bottom);
    painter.drawLine(image.width() / 2, 0, image.width() / 2, bottom);
    painter.drawLine(0, image.height() / 2, right, image.height() / 2);
}

} // namespace

QString nameOf(TestPattern pattern) {
    const auto words = [](const char* text) { return QCoreApplication::translate("TestPattern", text); };
    switch (pattern) {
    case TestPattern::none:
        return words("The scene");
    case TestPattern::checkerboard:
        return words("Checkerboard of single pixels");
    case TestPattern::grid:
        return words("Grid with borders");
    case TestPattern::ramp:
        return words("Grey ramp");
    case TestPattern::white:
        return words("White");
    case TestPattern::black:
        break;
    }
    return words("Black");
}

QImage testPattern(TestPattern pattern, QSize size) {
    QImage image(size.expandedTo({1, 1}), QImage::Format_RGB32);
    image.fill(pattern == TestPattern::white ? Qt::white : Qt::black);
    if (pattern == TestPattern::checkerboard) fillCheckerboard(image);
    if (pattern == TestPattern::grid) drawGrid(image);
    if (pattern == TestPattern::ramp) fillRamp(image);
    return image;
}

QImage numberPicture(int number, QSize size) {
    QImage image = testPattern(TestPattern::black, size);
    QPainter painter(&image);
    painter.setPen(Qt::white);
    painter.drawRect(0, 0, image.width() - 1, image.height() - 1);
    QFont font;
    font.setPixelSize(std::max(8, std::min(image.width(), image.height()) * 6 / 10));
    font.setWeight(QFont::Bold);
    painter.setFont(font);
    painter.drawText(image.rect(), Qt::AlignCenter, QString::number(number));
    return image;
}

} // namespace lumorph::studio

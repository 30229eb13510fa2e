#include "app/studio/look/icons.h"

#include <QFile>
#include <QHash>
#include <QIconEngine>
#include <QPainter>
#include <QPixmapCache>
#include <QSvgRenderer>

#include "app/studio/look/palette.h"
#include "core/base/error.h"
#include "core/base/resources.h"

namespace lumorph::studio {
namespace {

constexpr auto kMissing = R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24" fill="none">
<rect x="5" y="5" width="14" height="14" rx="3" stroke="currentColor" stroke-width="1.5"/></svg>)";

/// The drawings read so far belong to the application, so that they go with it.
class Drawings : public QObject {
public:
    explicit Drawings(QObject* parent) : QObject(parent) { setObjectName("drawings"); }

    const QByteArray& of(const QString& name) {
        const auto found = sources_.constFind(name);
        if (found != sources_.constEnd()) return *found;
        try {
            return *sources_.insert(name, iconSource(name));
        } catch (const Error& error) {
            qWarning("%s", error.what());
            return *sources_.insert(name, QByteArray(kMissing));
        }
    }

private:
    QHash<QString, QByteArray> sources_;
};

const QByteArray& drawing(const QString& name) {
    auto* drawings = static_cast<Drawings*>(qApp->findChild<QObject*>("drawings", Qt::FindDirectChildrenOnly));
    if (drawings == nullptr) drawings = new Drawings(qApp);
    return drawings->of(name);
}

QColor colorOf(IconRole role, QIcon::Mode mode, QIcon::State state) {
    const Palette& colors = currentPalette();
    if (mode == QIcon::Disabled) return disabledText(colors);
    switch (role) {
    case IconRole::onAccent:
        return colors.onAccent;
    case IconRole::onDanger:
        return colors.onDanger;
    case IconRole::accent:
        return colors.accentText;
    case IconRole::warning:
        return colors.warning;
    case IconRole::danger:
        return colors.danger;
    case IconRole::muted:
        return mode == QIcon::Active ? colors.text : colors.textMuted;
    case IconRole::control:
        break;
    }
    if (state == QIcon::On) return colors.accentText;
    return mode == QIcon::Normal ? blend(colors.text, colors.textMuted, 0.35) : colors.text;
}

/// Draws the SVG anew for each size and colour; the pixmaps are kept by Qt's pixmap cache.
class ThemedIconEngine : public QIconEngine {
public:
    ThemedIconEngine(QString name, IconRole role, double degrees)
        : name_(std::move(name)), role_(role), degrees_(degrees) {}

    void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override {
        paintIcon(*painter, rect, name_, colorOf(role_, mode, state), degrees_);
    }

    QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
        const QColor color = colorOf(role_, mode, state);
        const QString key = QString("lumorph/%1/%2/%3x%4/%5")
                                .arg(name_, color.name())
                                .arg(size.width())
                                .arg(size.height())
                                .arg(degrees_);
        QPixmap found;
        if (QPixmapCache::find(key, &found)) return found;
        QPixmap drawn(size);
        drawn.fill(Qt::transparent);
        QPainter painter(&drawn);
        paintIcon(painter, QRect(QPoint(), size), name_, color, degrees_);
        painter.end();
        QPixmapCache::insert(key, drawn);
        return drawn;
    }

    QPixmap scaledPixmap(const QSize& size, QIcon::Mode mode, QIcon::State state, qreal /*scale*/) override {
        return pixmap(size, mode, state);
    }
    QSize actualSize(const QSize& size, QIcon::Mode, QIcon::State) override { return size; }
    bool isNull() override { return false; }
    QString iconName() override { return name_; }
    QString key() const override { return "lumorph"; }
    QIconEngine* clone() const override { return new ThemedIconEngine(name_, role_, degrees_); }

private:
    QString name_;
    IconRole role_;
    double degrees_;
};

} // namespace

QByteArray iconSource(const QString& name) {
    const auto path = resourceFile("icons/" + name.toStdString() + ".svg");
    QFile file(QString::fromStdString(path.string()));
    if (!file.open(QIODevice::ReadOnly))
        throw DataError(path.string(), "the icon cannot be read", "install Lumorph again");
    return file.readAll();
}

QIcon icon(const QString& name, IconRole role, double degrees) {
    return QIcon(new ThemedIconEngine(name, role, degrees));
}

void paintIcon(QPainter& painter, const QRectF& box, const QString& name, const QColor& color, double degrees) {
    QByteArray source = drawing(name);
    source.replace("currentColor", color.name().toLatin1());
    QSvgRenderer renderer(source);
    renderer.setAspectRatioMode(Qt::KeepAspectRatio);
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.translate(box.center());
    painter.rotate(degrees);
    renderer.render(&painter, QRectF(-box.width() / 2, -box.height() / 2, box.width(), box.height()));
    painter.restore();
}

} // namespace lumorph::studio

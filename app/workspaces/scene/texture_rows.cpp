#include "app/workspaces/scene/texture_rows.h"

#include <numbers>

#include <QFileDialog>
#include <QFileInfo>
#include <QToolButton>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"
#include "app/workspaces/scene/picture_cache.h"

namespace lumorph::studio {

namespace {

constexpr const char* kFolderKey = "folders/scene";
constexpr int kThumbnail = 36;
constexpr double kTextureTurn = 2.0 * std::numbers::pi;

QString shortName(const std::string& asset) {
    if (asset.empty()) return QObject::tr("None");
    return QString::fromStdString(std::filesystem::path(asset).filename().string());
}

QToolButton* makeTool(const QString& name, const QString& iconName, const QString& text, QWidget* parent) {
    auto* button = new QToolButton(parent);
    button->setObjectName(name);
    button->setIcon(icon(iconName));
    button->setIconSize({18, 18});
    button->setToolTip(text);
    button->setAccessibleName(text);
    button->setFocusPolicy(Qt::StrongFocus);
    return button;
}

/// The picture as it is, small; a mark where it is broken or there is none.
class Thumbnail : public QWidget {
public:
    explicit Thumbnail(QWidget* parent) : QWidget(parent) { setFixedSize(kThumbnail, kThumbnail); }
    void show(const QPixmap& picture, bool broken) {
        picture_ = picture;
        broken_ = broken;
        update();
    }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        const Palette& colors = currentPalette();
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        painter.setPen(colors.line);
        painter.setBrush(colors.sunken);
        painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 3, 3);
        const QRect inside = rect().adjusted(2, 2, -2, -2);
        if (!picture_.isNull() && !broken_)
            painter.drawPixmap(inside, picture_);
        else
            paintIcon(painter, QRectF(inside).adjusted(7, 7, -7, -7), broken_ ? "warning" : "picture",
                      broken_ ? colors.warning : colors.textMuted);
    }

private:
    QPixmap picture_;
    bool broken_ = false;
};

class SlotRow : public QWidget {
public:
    SlotRow(SceneForm& form, Studio& studio, FileSlot slot)
        : QWidget(&form), form_(form), studio_(studio), slot_(std::move(slot)), picture_(new Thumbnail(this)),
          label_(new QLabel(slot_.label, this)), file_(new QLabel(this)),
          choose_(makeTool(slot_.name + ".choose", "open", tr("Choose a file for: %1").arg(slot_.label), this)),
          clear_(makeTool(slot_.name + ".clear", "close", tr("Take away: %1").arg(slot_.label), this)) {
        setObjectName(slot_.name);
        file_->setObjectName(slot_.name + ".file");
        file_->setProperty("look", "muted");
        file_->setTextFormat(Qt::PlainText);
        for (QLabel* text : {label_, file_}) text->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
        auto* words = new QVBoxLayout;
        words->setSpacing(0);
        words->addWidget(label_);
        words->addWidget(file_);
        auto* row = new QHBoxLayout(this);
        row->setContentsMargins(0, 0, 0, 0);
        row->setSpacing(8);
        row->addWidget(picture_);
        row->addLayout(words, 1);
        row->addWidget(choose_);
        row->addWidget(clear_);
        connect(choose_, &QToolButton::clicked, this, [this] {
            askForFile(studio_, this, tr("Choose a file"), slot_.filter,
                       [this](const std::filesystem::path& file) { put(file.string()); });
        });
        connect(clear_, &QToolButton::clicked, this, [this] { put({}); });
    }

    void refresh(const StudioState& state) {
        const std::string asset = slot_.read(state);
        const auto& assets = studio_.document.state().assets;
        const bool broken = assets && assets->problems.contains(asset);
        file_->setText(fontMetrics().elidedText(broken ? tr("%1: relink it").arg(shortName(asset)) : shortName(asset),
                                                Qt::ElideMiddle, std::max(80, file_->width())));
        file_->setToolTip(broken ? QString::fromStdString(assets->problems.at(asset)) : QString::fromStdString(asset));
        file_->setProperty("look", broken ? "warning" : "muted");
        file_->style()->unpolish(file_);
        file_->style()->polish(file_);
        clear_->setEnabled(!asset.empty());
        picture_->show(pictures_.of(assets.get(), asset, kThumbnail), broken);
    }

private:
    void put(const std::string& asset) {
        form_.edit(asset.empty() ? tr("Take a file away") : tr("Choose %1").arg(shortName(asset)),
                   [&](StudioState& state) { slot_.write(state, asset); });
    }

    SceneForm& form_;
    Studio& studio_;
    FileSlot slot_;
    Thumbnail* picture_;
    QLabel* label_;
    QLabel* file_;
    QToolButton* choose_;
    QToolButton* clear_;
    PictureCache pictures_;
};

} // namespace

QString pictureFilter() { return QObject::tr("Pictures (*.png *.jpg *.jpeg);;All files (*)"); }
QString modelFilter() { return QObject::tr("Models (*.glb *.gltf);;All files (*)"); }

void askForFile(Studio& studio, QWidget* parent, const QString& title, const QString& filter,
                const std::function<void(const std::filesystem::path&)>& chosen) {
    auto* dialog = new QFileDialog(parent->window(), title, studio.settings.value(kFolderKey).toString());
    dialog->setObjectName("dialog.sceneFile");
    dialog->setOption(QFileDialog::DontUseNativeDialog);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setFileMode(QFileDialog::ExistingFile);
    dialog->setNameFilters(filter.split(";;"));
    QObject::connect(dialog, &QFileDialog::fileSelected, parent, [&studio, chosen](const QString& file) {
        studio.settings.setValue(kFolderKey, QFileInfo(file).absolutePath());
        chosen(std::filesystem::path(file.toStdU16String()));
    });
    dialog->open();
}

void addFileSlot(SceneForm& form, Studio& studio, const FileSlot& slot) {
    auto* row = new SlotRow(form, studio, slot);
    form.add(row);
    form.onRefresh([row](const StudioState& state) { row->refresh(state); });
}

void addTextureRows(SceneForm& form, Studio& studio, const QString& prefix, const QString& label,
                    const Part<SceneTexture>& part, const std::function<bool(const StudioState&)>& metres) {
    addFileSlot(form, studio,
                {prefix, label, pictureFilter(),
                 [part](const StudioState& state) {
                     const SceneTexture* texture = part.read(state);
                     return texture ? texture->image : std::string();
                 },
                 [part](StudioState& state, const std::string& asset) {
                     if (SceneTexture* texture = part.write(state)) texture->image = asset;
                 }});
    const auto named = [part](const StudioState& state) {
        const SceneTexture* texture = part.read(state);
        return texture && !texture->image.empty();
    };
    const auto tile = [](auto& texture) -> auto& { return texture.tile; };
    const auto speed = [](auto& texture) -> auto& { return texture.velocity; };
    // The same numbers, in metres on what is known in metres.
    for (const bool inMetres : {true, false}) {
        const Quantity quantity = inMetres ? Quantity::length : Quantity::plain;
        const QString ends = inMetres ? "xz" : "uv";
        const auto here = [named, metres, inMetres](const StudioState& state) {
            return named(state) && metres(state) == inMetres;
        };
        form.showWhile(form.vector({prefix + ".tile" + (inMetres ? "" : ".own"), QObject::tr("Repeats after"),
                                    QObject::tr("How much of the surface one copy of the picture covers")},
                                   {quantity, 1e-4, 100.0, inMetres ? 0.1 : 1.0, inMetres ? 0.001 : 0.01}, ends, part,
                                   tile),
                       here);
        form.showWhile(form.vector({prefix + ".velocity" + (inMetres ? "" : ".own"), QObject::tr("Moves a second"),
                                    QObject::tr("How far the picture travels over the surface in a second")},
                                   {quantity, -100.0, 100.0, 0.0, inMetres ? 0.001 : 0.01}, ends, part, speed),
                       here);
    }
    form.showWhile(form.number(
                       {prefix + ".turn", QObject::tr("Turned by"), {}}, {Quantity::angle, -kTextureTurn, kTextureTurn},
                       part, [](auto& texture) -> auto& { return texture.turn; }),
                   named);
    const auto whole = FormRange{Quantity::level, 1.0, 64.0, 1.0, 1.0};
    QWidget* columns = form.number(
        {prefix + ".columns", QObject::tr("Flip-book columns"),
         QObject::tr("How many pictures stand side by side on the sheet; 1: no flip-book")},
        whole, part, [](auto& texture) -> auto& { return texture.columns; });
    QWidget* rows = form.number(
        {prefix + ".rows", QObject::tr("Flip-book rows"), {}}, whole, part,
        [](auto& texture) -> auto& { return texture.rows; });
    form.showWhile(columns, named);
    form.showWhile(rows, named);
    form.showWhile(form.number(
                       {prefix + ".framesPerSecond", QObject::tr("Pictures a second"), {}},
                       {Quantity::plain, 0.0, 120.0, 0.0, 1.0}, part,
                       [](auto& texture) -> auto& { return texture.framesPerSecond; }),
                   [part, named](const StudioState& state) {
                       const SceneTexture* texture = part.read(state);
                       return named(state) && texture->columns * texture->rows > 1;
                   });
}

} // namespace lumorph::studio

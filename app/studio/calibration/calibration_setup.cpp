#include "app/studio/calibration/calibration_setup.h"

#include <QDateTime>
#include <QDir>
#include <QLocale>
#include <QObject>
#include <QStandardPaths>

#include "calibration/capture/capture_camera.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr auto kWayKey = "calibrate/way";
constexpr auto kSavedKey = "calibrate/saved";           // of all ways
constexpr auto kInstalledKey = "calibrate/installed";   // of all ways
constexpr auto kUnfinishedKey = "calibrate/unfinished"; // of the camera
constexpr int kMostPoses = 30;

QString keyOf(CaptureWay way, const char* what) {
    static constexpr const char* kNames[] = {"lab", "folder", "camera", "crosshairs"};
    return QString("calibrate/%1/%2").arg(kNames[static_cast<int>(way)], what);
}

QString sideText(double millimetres) { return QString::number(millimetres, 'g', 6); }

} // namespace

std::filesystem::path usualSaved() {
    const QString data = QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation);
    return std::filesystem::path(data.toStdString()) / "lumorph" / "captures";
}

bool isSimulatedWay(const CalibrationSetup& setup) {
    return setup.way == CaptureWay::lab || (setup.way == CaptureWay::camera && isSimulatedCamera(setup.camera));
}

CaptureWay keptWay(const Settings& settings) {
    const int way = settings.value(kWayKey, 0).toInt();
    return way >= 0 && way < kCaptureWays ? static_cast<CaptureWay>(way) : CaptureWay::lab;
}

CalibrationSetup keptSetup(const Settings& settings, CaptureWay way) {
    CalibrationSetup setup;
    setup.way = way;
    const auto kept = [&](const char* what) { return settings.value(keyOf(way, what)).toString().toStdString(); };
    try {
        if (const std::string board = kept("board"); !board.empty()) setup.board = parseCalibrationBoard(board);
        if (const std::string size = kept("projector"); !size.empty()) setup.projector = parseProjectorSize(size);
        if (const std::string pattern = kept("pattern"); !pattern.empty()) {
            (void)parsePattern(pattern, setup.projector);
            setup.pattern = pattern;
        }
    } catch (const Error&) { // a settings file that somebody edited: what is usual is in use
    }
    setup.folder = kept("folder");
    setup.order = kept("order");
    setup.camera = kept("camera");
    setup.installed = settings.value(kInstalledKey, 0).toUInt();
    const std::string saved = settings.value(kSavedKey).toString().toStdString();
    setup.saved = saved.empty() ? usualSaved() : std::filesystem::path(saved);
    setup.poses = std::clamp(settings.value(keyOf(way, "poses"), setup.poses).toInt(), 3, kMostPoses);
    return setup;
}

void keepSetup(Settings& settings, const CalibrationSetup& setup) {
    const auto keep = [&](const char* what, const std::string& value) {
        settings.setValue(keyOf(setup.way, what), QString::fromStdString(value));
    };
    settings.setValue(kWayKey, static_cast<int>(setup.way));
    keep("board", boardText(setup.board));
    keep("projector", std::to_string(setup.projector.width) + "x" + std::to_string(setup.projector.height));
    keep("pattern", setup.pattern);
    keep("folder", setup.folder.string());
    keep("order", setup.order.string());
    keep("camera", setup.camera);
    settings.setValue(kInstalledKey, static_cast<uint>(setup.installed));
    settings.setValue(keyOf(setup.way, "poses"), setup.poses);
    settings.setValue(kSavedKey, QString::fromStdString(setup.saved.string()));
}

std::filesystem::path unfinishedFolder(const Settings& settings) {
    return settings.value(kUnfinishedKey).toString().toStdString();
}

void keepUnfinished(Settings& settings, const std::filesystem::path& folder) {
    settings.setValue(kUnfinishedKey, QString::fromStdString(folder.string()));
}

std::optional<EarlierPoses> earlierPoses(const Settings& settings) {
    const std::filesystem::path folder = unfinishedFolder(settings);
    if (folder.empty()) return std::nullopt;
    // Poses are moved in whole; a name that begins with a dot is one that was being written.
    const QFileInfoList poses =
        QDir(QString::fromStdString(folder.string())).entryInfoList(QDir::Dirs | QDir::NoDotAndDotDot, QDir::Time);
    if (poses.empty()) return std::nullopt;
    const QDateTime last = poses.front().lastModified();
    const qint64 days = last.date().daysTo(QDate::currentDate());
    const QString day = days == 0   ? QObject::tr("today")
                        : days == 1 ? QObject::tr("yesterday")
                                    : QLocale().toString(last.date(), QLocale::LongFormat);
    return EarlierPoses{folder, static_cast<int>(poses.size()), day + last.toString(", HH:mm")};
}

CaptureOrder orderOf(const CalibrationSetup& setup) {
    return setup.order.empty() ? parsePattern(setup.pattern, setup.projector)
                               : readCaptureOrder(setup.order, setup.projector);
}

std::string nameOfPose(int number) { return "pose_" + std::to_string(number + 1); }

QString boardWords(const CalibrationBoard& board) {
    switch (board.kind) {
    case CalibrationBoard::Kind::circles:
        return QObject::tr("circles, %1 a row in %2 rows, %3 mm")
            .arg(board.columns)
            .arg(board.rows)
            .arg(sideText(board.spacing));
    case CalibrationBoard::Kind::charuco:
        return QObject::tr("ChArUco board, %1 × %2 squares of %3 mm%4")
            .arg(board.columns)
            .arg(board.rows)
            .arg(sideText(board.spacing))
            .arg(board.dictionary.empty() ? QString()
                                          : QObject::tr(", markers %1").arg(QString::fromStdString(board.dictionary)));
    case CalibrationBoard::Kind::chess:
        break;
    }
    return QObject::tr("chessboard, %1 × %2 inner corners, squares of %3 mm")
        .arg(board.columns)
        .arg(board.rows)
        .arg(sideText(board.spacing));
}

QString problemOf(const CalibrationSetup& setup) {
    try {
        (void)parseCalibrationBoard(boardText(setup.board));
        (void)parsePattern(setup.pattern, setup.projector);
    } catch (const Error& error) {
        return QString::fromStdString(error.what());
    }
    return {};
}

} // namespace lumorph::studio
